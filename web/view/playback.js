/**
 * Live, or paused on one of the last seconds' frames. Feeds the picture, and keeps the video flowing while
 * paused: a frame that is kept but not shown is acknowledged at once.
 *
 * Event "change" (detail {isPaused, backMs, spanMs}).
 *
 * @typedef {import("../net/video_message.js").Frame} Frame
 */
import { FrameRing, frameAt } from "./frame_ring.js";

export class Playback extends EventTarget {
  /**
   * @param {import("./picture.js").Picture} picture
   * @param {(frameId: number) => void} acknowledge
   */
  constructor(picture, acknowledge) {
    super();
    this.picture = picture;
    this.acknowledge = acknowledge;
    this.ring = new FrameRing();
    /** @type {Frame[] | null} what can be scrubbed over; null: live */
    this.still = null;
    this.backMs = 0;
    /** @type {number[]} frames received and not acknowledged, oldest first */
    this.owed = [];
    for (const name of ["painted", "undecodable"]) {
      picture.addEventListener(name, (event) => this.settle(/** @type {CustomEvent<Frame>} */ (event).detail.frameId));
    }
  }

  get isPaused() {
    return this.still !== null;
  }

  /** How far back one can scrub [ms]. */
  get spanMs() {
    const oldest = this.still?.at(0);
    const newest = this.still?.at(-1);
    return oldest && newest ? newest.capturedMs - oldest.capturedMs : 0;
  }

  /** @param {Frame} frame */
  receive(frame) {
    this.ring.push(frame);
    this.owed.push(frame.frameId);
    if (this.still) this.settle(frame.frameId);
    else this.picture.show(frame);
  }

  /** @param {number} frameId that is done with: so are those it has overtaken */
  settle(frameId) {
    const count = this.owed.indexOf(frameId) + 1;
    for (const id of this.owed.splice(0, count)) this.acknowledge(id);
  }

  /** A new connection owes nothing to the old one. */
  forgetOwed() {
    this.owed = [];
  }

  pause() {
    const painted = this.picture.painted?.frame;
    if (this.still || !painted) return;
    this.still = this.ring.snapshot().filter((frame) => frame.capturedMs <= painted.capturedMs);
    this.backMs = 0;
    this.picture.keepPainted();
    this.settle(this.owed.at(-1) ?? 0);
    this.announce();
  }

  /** @param {number} backMs before the moment of the pause */
  scrub(backMs) {
    if (!this.still) return;
    this.backMs = Math.min(this.spanMs, Math.max(0, backMs));
    const frame = frameAt(this.still, this.backMs);
    if (frame) this.picture.show(frame);
    this.announce();
  }

  live() {
    if (!this.still) return;
    this.still = null;
    this.backMs = 0;
    const newest = this.ring.frames.at(-1);
    if (newest) this.picture.show(newest);
    this.announce();
  }

  toggle() {
    if (this.still) this.live();
    else this.pause();
  }

  announce() {
    const { isPaused, backMs, spanMs } = this;
    this.dispatchEvent(new CustomEvent("change", { detail: { isPaused, backMs, spanMs } }));
  }
}
