/**
 * The picture: decodes frames, paints the newest at the screen's pace, tells which frame is painted and
 * which of its pixels lies under a point of the screen.
 *
 * Event "painted" (detail Frame): this frame is on the canvas now, for the first time.
 *
 * @typedef {import("../net/video_message.js").Frame} Frame
 * @typedef {import("./letterbox.js").Placement} Placement
 * @typedef {(ctx: CanvasRenderingContext2D, placement: Placement, frame: Frame) => void} Painter
 * @typedef {{frameId: number, u: number, v: number}} PicturePoint
 */
import { pictureFromBox, placePicture } from "./letterbox.js";

export class Picture extends EventTarget {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    super();
    this.canvas = canvas;
    this.ctx = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d", { alpha: false }));
    /** @type {Painter[]} */
    this.painters = [];
    /** @type {{width: number, height: number} | null} what pixels are counted in: a narrow link sends fewer */
    this.cameraSize = null;
    /** @type {Frame | null} the newest that waits for the decoder */
    this.awaiting = null;
    this.isDecoding = false;
    this.isDecodingUnwanted = false;
    /** @type {{frame: Frame, bitmap: ImageBitmap} | null} decoded, not painted yet */
    this.decoded = null;
    /** @type {{frame: Frame, bitmap: ImageBitmap} | null} */
    this.painted = null;
    this.paintRequest = 0;
    new ResizeObserver(() => this.resize()).observe(canvas);
  }

  /** @param {Frame} frame replaces any other that has not been painted */
  show(frame) {
    this.awaiting = frame;
    void this.decodeNewest();
  }

  /** What is on the canvas stays there: nothing that is on its way gets painted any more. */
  keepPainted() {
    this.awaiting = null;
    this.isDecodingUnwanted = this.isDecoding;
    this.decoded?.bitmap.close();
    this.decoded = null;
  }

  async decodeNewest() {
    if (this.isDecoding || !this.awaiting) return;
    const frame = this.awaiting;
    this.awaiting = null;
    this.isDecoding = true;
    try {
      this.present(frame, await createImageBitmap(frame.jpeg));
    } catch {
      this.dispatchEvent(new CustomEvent("undecodable", { detail: frame }));
    } finally {
      this.isDecoding = false;
      this.isDecodingUnwanted = false;
      void this.decodeNewest();
    }
  }

  /**
   * @param {Frame} frame
   * @param {ImageBitmap} bitmap
   */
  present(frame, bitmap) {
    if (this.isDecodingUnwanted) {
      bitmap.close();
      return;
    }
    this.decoded?.bitmap.close();
    this.decoded = { frame, bitmap };
    this.repaint();
  }

  /** Ask for a new painting, because of a new frame or because the overlay has changed. */
  repaint() {
    if (!this.paintRequest) this.paintRequest = requestAnimationFrame(() => this.paint());
  }

  paint() {
    this.paintRequest = 0;
    const fresh = this.decoded;
    if (fresh) {
      this.painted?.bitmap.close();
      this.painted = fresh;
      this.decoded = null;
    }
    this.draw();
    if (!fresh) return;
    this.canvas.dataset.frameId = String(fresh.frame.frameId);
    this.dispatchEvent(new CustomEvent("painted", { detail: fresh.frame }));
  }

  draw() {
    const { ctx, painted } = this;
    const box = this.canvas.getBoundingClientRect();
    ctx.setTransform(1, 0, 0, 1, 0, 0);
    ctx.fillStyle = "#0b0d10";
    ctx.fillRect(0, 0, this.canvas.width, this.canvas.height);
    const placement = this.placement();
    if (!painted || !placement) return;
    ctx.setTransform(this.canvas.width / box.width, 0, 0, this.canvas.height / box.height, 0, 0);
    ctx.drawImage(painted.bitmap, placement.left, placement.top, placement.width, placement.height);
    for (const paintOver of this.painters) paintOver(ctx, placement, painted.frame);
  }

  /** Canvas pixels follow the screen's own; painted at once, since resizing clears the canvas. */
  resize() {
    const box = this.canvas.getBoundingClientRect();
    this.canvas.width = Math.max(1, Math.round(box.width * devicePixelRatio));
    this.canvas.height = Math.max(1, Math.round(box.height * devicePixelRatio));
    this.draw();
  }

  /** @returns {Placement | null} null while nothing is painted */
  placement() {
    if (!this.painted) return null;
    const { width, height } = this.cameraSize ?? this.painted.bitmap;
    // Not clientWidth, which is rounded: taps are exact to a fraction of a pixel.
    const box = this.canvas.getBoundingClientRect();
    return placePicture(box.width, box.height, width, height);
  }

  /** @returns {[number, number, number] | null} where the robot was in the painted frame: x, y [m], heading [rad] */
  get base() {
    return this.painted?.frame.meta?.base ?? null;
  }

  /**
   * @param {number} clientX
   * @param {number} clientY
   * @returns {PicturePoint | null} the pixel there and the frame that is painted; null beside the picture
   */
  pointAt(clientX, clientY) {
    const placement = this.placement();
    if (!placement || !this.painted) return null;
    const box = this.canvas.getBoundingClientRect();
    const point = pictureFromBox(placement, clientX - box.left, clientY - box.top);
    return point && { frameId: this.painted.frame.frameId, ...point };
  }
}
