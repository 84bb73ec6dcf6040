/**
 * Decides whether a heartbeat may go out. The page feeds tokens; a frozen page feeds none, so that the
 * robot stops although the worker still runs.
 *
 * @typedef {{atMs: number, frameId: number | null}} Token `atMs`: the page's clock [ms]
 */
export const TOKEN_LIFE_MS = 100;

export class Heartbeat {
  constructor() {
    /** @type {Token | null} */
    this.token = null;
  }

  /** @param {Token | null} token null: the page holds no lease, or is hidden */
  feed(token) {
    this.token = token;
  }

  /**
   * @param {number} nowMs on the page's clock
   * @returns {import("./control_socket.js").Unnumbered | null} the heartbeat to send, or null to keep still
   */
  beat(nowMs) {
    const { token } = this;
    if (!token || nowMs - token.atMs > TOKEN_LIFE_MS) return null;
    return { type: "heartbeat", client_ms: token.atMs, frame_id: token.frameId };
  }
}
