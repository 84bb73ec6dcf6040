/**
 * The video socket. Events: "frame" (detail Frame), "link" (detail LinkState), "broken" (detail: reason).
 * Every frame is acknowledged by whoever has drawn it; until then the server sends no other.
 */
import { Link } from "./link.js";
import { parseVideoMessage } from "./video_message.js";

export class VideoSocket extends EventTarget {
  /** @param {string} url @param {string} probeUrl */
  constructor(url, probeUrl) {
    super();
    this.link = new Link(url, probeUrl, 0);
    this.link.addEventListener("data", (event) => this.receive(/** @type {CustomEvent} */ (event).detail));
    this.link.addEventListener("state", (event) => {
      this.dispatchEvent(new CustomEvent("link", { detail: /** @type {CustomEvent} */ (event).detail }));
    });
  }

  open() {
    this.link.open();
  }

  retryNow() {
    this.link.retryNow();
  }

  /** @param {number} frameId that has been drawn */
  acknowledge(frameId) {
    this.link.send(JSON.stringify({ ack: frameId }));
  }

  /**
   * A probe comes back at once: so the server knows the round trip of a link that carries nothing.
   * @param {{probe?: number, refused?: string}} text
   */
  answer({ probe, refused }) {
    if (probe !== undefined) this.link.send(JSON.stringify({ probe }));
    if (refused !== undefined) this.dispatchEvent(new CustomEvent("broken", { detail: refused }));
  }

  /** @param {ArrayBuffer | string} message */
  receive(message) {
    if (typeof message === "string") {
      this.answer(JSON.parse(message));
      return;
    }
    try {
      this.dispatchEvent(new CustomEvent("frame", { detail: parseVideoMessage(message, performance.now()) }));
    } catch (error) {
      this.dispatchEvent(new CustomEvent("broken", { detail: String(error) }));
    }
  }
}
