/**
 * Pointing at a thing on the picture. A tap is the point where the finger came down, in the frame that was
 * painted at that moment. A drag that goes both across and down draws a box around a thing, in the frame that
 * is painted when the finger lifts: its edges were held against that one. A slide along one line is neither.
 *
 * A box is dropped by dragging back to where it began, by a second finger or mouse button, and by Escape
 * (which stops the robot, too).
 *
 * Events "tap" (detail PicturePoint), "drawing" (detail PictureBox, or null when none is drawn any more), "box"
 * (detail BoxedPart), "refused" (detail reason).
 *
 * @typedef {import("../view/picture.js").PicturePoint} PicturePoint
 * @typedef {import("../view/boxes.js").PictureBox} PictureBox
 * @typedef {{frameId: number, left: number, top: number, right: number, bottom: number}} BoxedPart
 * @typedef {{pointerId: number, x: number, y: number, point: PicturePoint, base: number[] | null,
 *   hasSlid: boolean, isBox: boolean}} Begun
 */
import { nearestInPicture } from "../view/letterbox.js";

const SLACK_PX = 12;
const LEAST_BOX_PX = 16;
const STILL_M = 0.01;
const STILL_RAD = 0.01;

export class Tap extends EventTarget {
  /** @param {import("../view/picture.js").Picture} picture */
  constructor(picture) {
    super();
    this.picture = picture;
    /** Whether a box means something now. */
    this.allowsBox = () => true;
    /** @type {Begun | null} */
    this.begun = null;
    const { canvas } = picture;
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.up(event));
    for (const name of ["pointercancel", "lostpointercapture"]) canvas.addEventListener(name, () => this.drop());
    window.addEventListener("keydown", (event) => event.code === "Escape" && this.drop());
  }

  /** @param {PointerEvent} event */
  down(event) {
    this.drop();
    if (event.button !== 0 || !event.isPrimary) return;
    const point = this.picture.pointAt(event.clientX, event.clientY);
    if (!point) return;
    const { pointerId, clientX: x, clientY: y } = event;
    this.begun = { pointerId, x, y, point, base: this.picture.base, hasSlid: false, isBox: false };
  }

  /** @param {PointerEvent} event */
  move(event) {
    const { begun } = this;
    if (begun?.pointerId !== event.pointerId) return;
    if (event.buttons & ~1) {
      this.drop();
      return;
    }
    begun.hasSlid ||= Math.hypot(event.clientX - begun.x, event.clientY - begun.y) > SLACK_PX;
    if (!begun.isBox && this.allowsBox() && isLargeEnough(begun, event)) {
      begun.isBox = true;
      // The edge of the canvas must not end it: things do reach out of the picture.
      if (event.isTrusted) this.picture.canvas.setPointerCapture(event.pointerId);
    }
    if (begun.isBox) this.tell("drawing", this.boxTo(begun, event));
  }

  /** @param {PointerEvent} event */
  up(event) {
    const { begun } = this;
    if (begun?.pointerId !== event.pointerId) return;
    this.move(event);
    this.drop();
    if (begun.isBox) this.finish(begun, event);
    // A finger that slid away has changed its mind.
    else if (!begun.hasSlid) this.tell("tap", begun.point);
  }

  /** @param {Begun} begun @param {PointerEvent} event */
  finish(begun, event) {
    const frameId = this.picture.painted?.frame.frameId;
    if (!isLargeEnough(begun, event) || frameId === undefined) return;
    const { left, top, right, bottom } = this.boxTo(begun, event);
    if (hasMoved(begun.base, this.picture.base)) {
      this.tell("refused", "The robot moved while you drew. Let it stand, or pause the picture.");
    } else this.tell("box", { frameId, left, top, right, bottom });
  }

  drop() {
    const wasBox = this.begun?.isBox;
    this.begun = null;
    if (wasBox) this.tell("drawing", null);
  }

  /** @param {Begun} begun @param {PointerEvent} event */
  boxTo(begun, event) {
    const { u, v } = begun.point;
    const end = nearestInPicture(this.picture, event.clientX, event.clientY) ?? begun.point;
    return {
      left: Math.min(u, end.u),
      top: Math.min(v, end.v),
      right: Math.max(u, end.u),
      bottom: Math.max(v, end.v),
      isEnough: isLargeEnough(begun, event),
    };
  }

  /** @param {string} name @param {unknown} detail */
  tell(name, detail) {
    this.dispatchEvent(new CustomEvent(name, { detail }));
  }
}

/** @param {Begun} begun @param {PointerEvent} event */
function isLargeEnough(begun, event) {
  return Math.abs(event.clientX - begun.x) > LEAST_BOX_PX && Math.abs(event.clientY - begun.y) > LEAST_BOX_PX;
}

/** @param {number[] | null} before @param {number[] | null} now x, y [m], heading [rad] */
function hasMoved(before, now) {
  if (!before || !now) return false;
  const [dx, dy, turn] = now.map((value, index) => Math.abs(value - Number(before[index])));
  return Math.hypot(Number(dx), Number(dy)) > STILL_M || Number(turn) > STILL_RAD;
}
