/**
 * Turns a tap into the message it means now: for the guide's step, a floor guess, or Locate.
 *
 * @typedef {import("../view/picture.js").PicturePoint} PicturePoint
 */
export class Aim {
  /**
   * @param {{socket: import("../net/control_socket.js").ControlSocket, guide: import("../ui/guide.js").Guide,
   *   purpose: import("../ui/purpose.js").Purpose, overlay: import("../view/overlay.js").Overlay,
   *   playback: import("../view/playback.js").Playback, toast: import("../ui/toast.js").Toast}} parts
   */
  constructor(parts) {
    this.parts = parts;
  }

  /** @param {PicturePoint} point */
  async at(point) {
    const { socket, overlay, playback, toast } = this.parts;
    const message = this.message(point);
    this.mark(point);
    const ack = await socket.send(message);
    if (overlay.pendingTap === point) this.mark(null);
    if (!ack.ok) toast.tell(ack.reason, "bad");
    // The robot moves now: its operator must see where.
    else if (message.type === "tap" && message.purpose === "locate") playback.live();
  }

  /** @param {PicturePoint} point @returns {import("../net/control_socket.js").Unnumbered} */
  message({ frameId, u, v }) {
    const { guide, purpose } = this.parts;
    if (guide.wantsTap) return { type: "guide_tap", frame_id: frameId, u, v };
    return { type: "tap", frame_id: frameId, u, v, purpose: purpose.chosen };
  }

  /** @param {PicturePoint | null} point */
  mark(point) {
    this.parts.overlay.pendingTap = point;
    this.parts.playback.picture.repaint();
  }
}
