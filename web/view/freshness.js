/**
 * How old the picture on the screen is, by the server's clock; by the page's own since it was painted while
 * the offset is unknown. Tells the situation, which refuses driving on a frozen picture.
 *
 * @typedef {import("../net/video_message.js").Frame} Frame
 */
const TELL_MS = 250;
const FRESH_MS = 150;
const DEFAULT_FROZEN_MS = 500;

export class Freshness {
  /**
   * @param {import("../net/situation.js").Situation} situation
   * @param {import("../net/clock_offset.js").ClockOffset} clock
   */
  constructor(situation, clock) {
    this.situation = situation;
    this.clock = clock;
    /** @type {Frame | null} */
    this.frame = null;
    this.paintedMs = 0;
    this.ageAtPaintMs = 0;
    this.toldMs = 0;
  }

  /** @param {Frame} frame that was painted at this moment */
  painted(frame) {
    this.frame = frame;
    this.paintedMs = performance.now();
    this.ageAtPaintMs = this.ageMs(this.paintedMs);
    this.situation.facts.frameId = frame.frameId;
    this.check();
  }

  /** @param {number} nowMs @returns {number} */
  ageMs(nowMs) {
    if (!this.frame) return 0;
    return this.clock.ageMs(this.frame.capturedMs, nowMs) ?? nowMs - this.frame.receivedMs;
  }

  /** Called again and again: notices a picture that has stopped, and one that moves again. */
  check() {
    if (!this.frame) return;
    const { facts } = this.situation;
    const nowMs = performance.now();
    const ageMs = this.ageMs(nowMs);
    const isFrozen = ageMs > (facts.welcome?.frozen_after_ms ?? DEFAULT_FROZEN_MS);
    if (isFrozen === facts.isFrozen && facts.pictureAgeMs !== null && nowMs - this.toldMs < TELL_MS) return;
    this.toldMs = nowMs;
    // Between two frames of a live picture its age just saws up and down: the age when painted says more.
    const pictureAgeMs = !isFrozen && nowMs - this.paintedMs < FRESH_MS ? this.ageAtPaintMs : ageMs;
    this.situation.learn({ isFrozen, pictureAgeMs });
  }
}
