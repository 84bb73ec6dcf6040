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
import { shortSize } from "./words.js";

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
    for (const marker of frame.meta?.markers ?? []) {
      const target = this.targets.byId.get(marker.target_id);
      if (target && marker.box?.length === 4) drawSized(ctx, placement, { ...marker, box: marker.box }, target);
    }
    if (this.pending) drawPending(ctx, placement, this.pending);
    ctx.restore();
  }
}

/**
 * Corners only: the thing itself stays visible, and the outline of the region keeps its meaning.
 * @param {CanvasRenderingContext2D} ctx @param {Placement} placement
 * @param {{u: number, v: number, box: [number, number][]}} marker @param {import("../net/messages.js").TargetView} target
 */
function drawSized(ctx, placement, { u: atU, v: atV, box }, target) {
  const points = box.map(([u, v]) => boxFromPicture(placement, u, v));
  const isGuess = target.source === "floor";
  ctx.setLineDash(isGuess ? [5, 4] : []);
  stroke(ctx, isGuess ? GUESS : ACCENT, () => {
    points.forEach((point, index) => {
      for (const other of [points[(index + 1) % 4], points[(index + 3) % 4]]) if (other) arm(ctx, point, other);
    });
  });
  ctx.setLineDash([]);
  if (!target.extent) return;
  const xs = points.map(({ x }) => x);
  // Below the thing, and below the ring and the distance beside it.
  const below = Math.max(...points.map(({ y }) => y), boxFromPicture(placement, atU, atV).y + 14) + 8;
  const middle = (Math.min(...xs) + Math.max(...xs)) / 2;
  drawChip(ctx, placement, shortSize(target.extent), middle, below, 600);
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
  if (box.isSent) return;
  const above = from.y - 34;
  drawChip(ctx, placement, NOTE, (from.x + to.x) / 2, above > placement.top ? above : to.y + 8, 500);
}

/**
 * A word on the picture, kept inside it.
 * @param {CanvasRenderingContext2D} ctx @param {Placement} placement
 * @param {string} text @param {number} middle @param {number} wantedTop @param {number} weight
 */
function drawChip(ctx, placement, text, middle, wantedTop, weight) {
  if (!text) return;
  ctx.font = `${weight} 13px ${FONT}`;
  const width = ctx.measureText(text).width + 16;
  const left = Math.max(placement.left + 6, Math.min(middle - width / 2, placement.left + placement.width - width - 6));
  const top = Math.min(wantedTop, placement.top + placement.height - 32);
  ctx.fillStyle = SHADE;
  ctx.beginPath();
  ctx.roundRect(left, top, width, 26, 8);
  ctx.fill();
  ctx.fillStyle = INK;
  ctx.textBaseline = "middle";
  ctx.fillText(text, left + 8, top + 14);
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
