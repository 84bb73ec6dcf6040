/**
 * Turns a tap or a drawn box into the message it means now: for the guide's step, a floor guess, Locate, or Fetch.
 *
 * @typedef {import("../view/picture.js").PicturePoint} PicturePoint
 * @typedef {import("./tap.js").BoxedPart} BoxedPart
 */
export class Aim {
  /**
   * @param {{socket: import("../net/control_socket.js").ControlSocket, guide: import("../ui/guide.js").Guide,
   *   purpose: import("../ui/purpose.js").Purpose, fetchMode: import("../ui/fetch_mode.js").FetchMode, overlay: import("../view/overlay.js").Overlay,
   *   boxes: import("../view/boxes.js").Boxes, playback: import("../view/playback.js").Playback,
   *   toast: import("../ui/toast.js").Toast}} parts
   */
  constructor(parts) {
    this.parts = parts;
  }

  /** @param {PicturePoint} point */
  async at(point) {
    const { overlay } = this.parts;
    this.mark(point);
    await this.send(this.message(point));
    if (overlay.pendingTap === point) this.mark(null);
  }

  /** @param {BoxedPart} box */
  async around(box) {
    const { boxes } = this.parts;
    const { frameId, left, top, right, bottom } = box;
    this.draw({ ...box, isEnough: true, isSent: true });
    const { pending } = boxes;
    const middle = { u: (left + right) / 2, v: (top + bottom) / 2 };
    await this.send(this.pointed({ frame_id: frameId, ...middle, box: [left, top, right, bottom] }));
    if (boxes.pending === pending) this.draw(null);
  }

  /** @param {import("../net/control_socket.js").Unnumbered} message */
  async send(message) {
    const { socket, playback, toast } = this.parts;
    const ack = await socket.send(message);
    if (!ack.ok) toast.tell(ack.reason, "bad");
    // The robot moves now: its operator must see where.
    else if (message.type === "fetch" || (message.type === "tap" && message.purpose === "locate")) playback.live();
  }

  /** @param {PicturePoint} point @returns {import("../net/control_socket.js").Unnumbered} */
  message({ frameId, u, v }) {
    if (this.parts.guide.wantsTap) return { type: "guide_tap", frame_id: frameId, u, v };
    return this.pointed({ frame_id: frameId, u, v });
  }

  /**
   * @param {{frame_id: number, u: number, v: number, box?: [number, number, number, number]}} place
   * @returns {import("../net/control_socket.js").Unnumbered}
   */
  pointed(place) {
    const { purpose, fetchMode } = this.parts;
    if (purpose.chosen === "fetch") return { type: "fetch", mode: fetchMode.chosen, ...place };
    return { type: "tap", purpose: purpose.chosen, ...place };
  }

  /** @param {PicturePoint | null} point */
  mark(point) {
    this.parts.overlay.pendingTap = point;
    this.parts.playback.picture.repaint();
  }

  /** @param {import("../view/boxes.js").PictureBox | null} box that is being drawn, or waits for its answer */
  draw(box) {
    this.parts.boxes.pending = box;
    this.parts.playback.picture.repaint();
  }
}
