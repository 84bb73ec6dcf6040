/**
 * Boxes on the picture: the one a person draws, and around each target whose size is known the rectangle of
 * that size, at the corners the frame's own meta names. So it sticks to its thing.
 *
 * @typedef {import("./letterbox.js").Placement} Placement
 * @typedef {import("../net/video_message.js").Frame} Frame
 * @typedef {{left: number, top: number, right: number, bottom: number, isEnough?: boolean, isSent?: boolean}} PictureBox
 *   in pixels of the picture; `isEnough`: letting go now means this box; `isSent`: it waits for its answer
 */
import { boxFromPicture } from "./letterbox.js";
import { ACCENT, FONT, GUESS, INK, SHADE, SOFT } from "./palette.js";

const CORNER = 14;
const NOTE = "Drag back to cancel";

export class Boxes {
  /** @param {import("./targets.js").Targets} targets */
  constructor(targets) {
    this.targets = targets;
    /** @type {PictureBox | null} */
    this.pending = null;
  }

  /** @param {CanvasRenderingContext2D} ctx @param {Placement} placement @param {Frame} frame */
  paint(ctx, placement, frame) {
    ctx.save();
    ctx.beginPath();
    ctx.rect(placement.left, placement.top, placement.width, placement.height);
    ctx.clip();
    for (const { target_id: id, box } of frame.meta?.markers ?? []) {
      const target = this.targets.byId.get(id);
      if (target && box && box.length === 4) drawSized(ctx, placement, box, target);
    }
    if (this.pending) drawPending(ctx, placement, this.pending);
    ctx.restore();
  }
}

/**
 * Corners only: the thing itself stays visible, and the outline of the region keeps its meaning.
 * @param {CanvasRenderingContext2D} ctx @param {Placement} placement
 * @param {[number, number][]} corners @param {import("../net/messages.js").TargetView} target
 */
function drawSized(ctx, placement, corners, target) {
  const points = corners.map(([u, v]) => boxFromPicture(placement, u, v));
  const isGuess = target.source === "floor" || target.extent?.source === "outline";
  ctx.setLineDash(isGuess ? [5, 4] : []);
  stroke(ctx, target.source === "floor" ? GUESS : ACCENT, () => {
    points.forEach((point, index) => {
      for (const other of [points[(index + 1) % 4], points[(index + 3) % 4]]) if (other) arm(ctx, point, other);
    });
  });
  ctx.setLineDash([]);
}

/** @param {CanvasRenderingContext2D} ctx @param {{x: number, y: number}} from @param {{x: number, y: number}} to */
function arm(ctx, from, to) {
  const length = Math.hypot(to.x - from.x, to.y - from.y);
  const share = Math.min(0.5, (CORNER / Math.max(length, 1)));
  ctx.moveTo(from.x, from.y);
  ctx.lineTo(from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share);
}

/** @param {CanvasRenderingContext2D} ctx @param {Placement} placement @param {PictureBox} box */
function drawPending(ctx, placement, box) {
  const from = boxFromPicture(placement, box.left, box.top);
  const to = boxFromPicture(placement, box.right, box.bottom);
  /** @type {[number, number, number, number]} */
  const rect = [from.x, from.y, to.x - from.x, to.y - from.y];
  ctx.setLineDash(box.isEnough ? [] : [4, 5]);
  stroke(ctx, box.isEnough ? INK : SOFT, () => ctx.rect(...rect));
  ctx.setLineDash([]);
  if (!box.isEnough) return;
  ctx.fillStyle = "rgb(242 245 247 / 8%)";
  ctx.fillRect(...rect);
  if (!box.isSent) drawNote(ctx, placement, from, to);
}

/** @param {CanvasRenderingContext2D} ctx @param {Placement} placement @param {{x: number, y: number}} from @param {{x: number, y: number}} to */
function drawNote(ctx, placement, from, to) {
  ctx.font = `500 13px ${FONT}`;
  const width = ctx.measureText(NOTE).width + 16;
  const left = Math.max(placement.left + 6, Math.min((from.x + to.x - width) / 2, placement.left + placement.width - width - 6));
  const top = from.y - 34 > placement.top ? from.y - 34 : Math.min(to.y + 8, placement.top + placement.height - 32);
  ctx.fillStyle = SHADE;
  ctx.beginPath();
  ctx.roundRect(left, top, width, 26, 8);
  ctx.fill();
  ctx.fillStyle = INK;
  ctx.textBaseline = "middle";
  ctx.fillText(NOTE, left + 8, top + 14);
}

/**
 * Twice, dark and wide below, so that the line reads on any picture.
 * @param {CanvasRenderingContext2D} ctx @param {string} style @param {() => void} trace
 */
function stroke(ctx, style, trace) {
  ctx.lineCap = "round";
  ctx.lineJoin = "round";
  for (const [width, colour] of /** @type {[number, string][]} */ ([[5, "rgb(0 0 0 / 45%)"], [2, style]])) {
    ctx.lineWidth = width;
    ctx.strokeStyle = colour;
    ctx.beginPath();
    trace();
    ctx.stroke();
  }
}
