/**
 * A tap on the picture: the point where the finger came down, in the frame that was painted at that moment.
 *
 * Event "tap" (detail PicturePoint).
 *
 * @typedef {import("../view/picture.js").PicturePoint} PicturePoint
 */
const SLACK_PX = 12;

export class Tap extends EventTarget {
  /** @param {import("../view/picture.js").Picture} picture */
  constructor(picture) {
    super();
    this.picture = picture;
    /** @type {{pointerId: number, x: number, y: number, point: PicturePoint} | null} */
    this.begun = null;
    const { canvas } = picture;
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointerup", (event) => this.up(event));
    canvas.addEventListener("pointercancel", () => (this.begun = null));
  }

  /** @param {PointerEvent} event */
  down(event) {
    if (event.button !== 0 || !event.isPrimary) return;
    const point = this.picture.pointAt(event.clientX, event.clientY);
    this.begun = point && { pointerId: event.pointerId, x: event.clientX, y: event.clientY, point };
  }

  /** @param {PointerEvent} event */
  up(event) {
    const { begun } = this;
    this.begun = null;
    if (begun?.pointerId !== event.pointerId) return;
    // A finger that slid away has changed its mind.
    if (Math.hypot(event.clientX - begun.x, event.clientY - begun.y) > SLACK_PX) return;
    this.dispatchEvent(new CustomEvent("tap", { detail: begun.point }));
  }
}
