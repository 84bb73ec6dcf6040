/**
 * The last seconds of video as JPEG, to scrub back over.
 *
 * @typedef {import("../net/video_message.js").Frame} Frame
 */
export const RING_MS = 10_000;

export class FrameRing {
  /** @param {number} spanMs how far back it reaches */
  constructor(spanMs = RING_MS) {
    this.spanMs = spanMs;
    /** @type {Frame[]} oldest first */
    this.frames = [];
  }

  /** @param {Frame} frame a newer one; after a restart of the server its clock may run anew */
  push(frame) {
    const newest = this.frames.at(-1);
    if (newest && frame.capturedMs < newest.capturedMs) this.frames = [];
    this.frames.push(frame);
    const oldest = frame.capturedMs - this.spanMs;
    while (this.frames[0] && this.frames[0].capturedMs < oldest) this.frames.shift();
  }

  /** @returns {Frame[]} a still copy, for scrubbing while new frames come in */
  snapshot() {
    return [...this.frames];
  }
}

/**
 * @param {readonly Frame[]} frames oldest first
 * @param {number} backMs before the newest
 * @returns {Frame | null} the one captured nearest to that; null when there is none
 */
export function frameAt(frames, backMs) {
  const newest = frames.at(-1);
  if (!newest) return null;
  const wanted = newest.capturedMs - backMs;
  return frames.reduce((best, frame) =>
    Math.abs(frame.capturedMs - wanted) < Math.abs(best.capturedMs - wanted) ? frame : best,
  );
}
