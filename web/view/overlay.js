/**
 * What is drawn over a frame: the paper's vertical centre line, and for each target its 95 % region, a
 * marker and its distance, at the place the frame's own meta names. So a marker sticks to its object.
 *
 * @typedef {import("./letterbox.js").Placement} Placement
 * @typedef {import("../net/video_message.js").Frame} Frame
 * @typedef {import("../net/video_message.js").Marker} Marker
 * @typedef {import("../net/messages.js").TargetView} TargetView
 */
import { boxFromPicture } from "./letterbox.js";
import { ACCENT, FONT, GUESS, INK, PATH, SHADE, SOFT } from "./palette.js";
import { length } from "./words.js";

const RADIUS = 13;
const EDGE_MARGIN = 26;

export class Overlay {
  /** @param {import("./targets.js").Targets} targets */
  constructor(targets) {
    this.targets = targets;
    /** @type {{frameId: number, u: number, v: number} | null} a tap that waits for its answer */
    this.pendingTap = null;
  }

  /** @param {CanvasRenderingContext2D} ctx @param {Placement} placement @param {Frame} frame */
  paint(ctx, placement, frame) {
    ctx.save();
    ctx.beginPath();
    ctx.rect(placement.left, placement.top, placement.width, placement.height);
    ctx.clip();
    drawCentreLine(ctx, placement);
    drawPath(ctx, placement, frame.meta?.path ?? []);
    for (const line of frame.meta?.plan ?? []) drawPlanned(ctx, placement, line);
    const markers = frame.meta?.markers ?? [];
    for (const marker of markers) this.drawMarker(ctx, placement, marker);
    for (const target of this.unmarked(frame, markers)) {
      drawTarget(ctx, placement, { ...target, inside: true, region: [], state: "predicted" }, target);
    }
    const { pendingTap } = this;
    if (pendingTap?.frameId === frame.frameId) drawTap(ctx, placement, pendingTap.u, pendingTap.v);
    ctx.restore();
  }

  /**
   * A frame sent before its target was known carries no marker: the tap itself is one.
   * @param {Frame} frame @param {Marker[]} markers @returns {TargetView[]}
   */
  unmarked(frame, markers) {
    const known = new Set(markers.map((marker) => marker.target_id));
    return this.targets.all().filter((target) => target.frame_id === frame.frameId && !known.has(target.target_id));
  }

  /** @param {CanvasRenderingContext2D} ctx @param {Placement} placement @param {Marker} marker */
  drawMarker(ctx, placement, marker) {
    const target = this.targets.byId.get(marker.target_id) ?? null;
    if (!target) return;
    if (marker.inside) drawTarget(ctx, placement, marker, target);
    else drawEdgeArrow(ctx, placement, marker, colour(target));
  }
}

/** @param {TargetView} target */
const colour = (target) => (target.source === "floor" ? GUESS : ACCENT);

/** @param {CanvasRenderingContext2D} ctx @param {Placement} placement */
function drawCentreLine(ctx, placement) {
  const x = placement.left + placement.width / 2;
  for (const [lineWidth, style] of /** @type {[number, string][]} */ ([[3, "rgb(0 0 0 / 25%)"], [1, SOFT]])) {
    ctx.lineWidth = lineWidth;
    ctx.strokeStyle = style;
    ctx.beginPath();
    ctx.moveTo(x, placement.top);
    ctx.lineTo(x, placement.top + placement.height);
    ctx.stroke();
  }
}

/** @param {CanvasRenderingContext2D} ctx @param {Placement} placement @param {Marker} marker @param {TargetView} target */
function drawTarget(ctx, placement, marker, target) {
  const { x, y } = boxFromPicture(placement, marker.u, marker.v);
  const isGuess = target.source === "floor";
  drawRegion(ctx, placement, marker.region, colour(target), isGuess);
  ctx.setLineDash(isGuess || marker.state === "predicted" ? [4, 4] : []);
  outlined(ctx, colour(target), () => {
    ctx.beginPath();
    ctx.arc(x, y, RADIUS, 0, 2 * Math.PI);
    ctx.stroke();
  });
  ctx.setLineDash([]);
  outlined(ctx, colour(target), () => drawTicks(ctx, x, y));
  drawLabel(ctx, placement, x, y, target);
}

/**
 * The way the robot is about to drive, on the floor: between its two sides, and where it will stand.
 * @param {CanvasRenderingContext2D} ctx @param {Placement} placement @param {[number, number][][]} path
 */
function drawPath(ctx, placement, path) {
  const [left = [], right = [], body = []] = path;
  const sides = [...left, ...[...right].reverse()];
  if (left.length > 1 && right.length > 1) {
    trace(ctx, placement, sides);
    ctx.globalAlpha = 0.2;
    ctx.fillStyle = PATH;
    ctx.fill();
    ctx.globalAlpha = 1;
  }
  for (const side of [left, right]) outlined(ctx, PATH, () => (trace(ctx, placement, side), ctx.stroke()), 2);
  outlined(ctx, PATH, () => (trace(ctx, placement, body), ctx.stroke()), 2.5);
}

/** A line of the plan to fetch. @param {CanvasRenderingContext2D} ctx @param {Placement} placement @param {[number, number][]} line */
function drawPlanned(ctx, placement, line) {
  ctx.setLineDash([8, 5]);
  outlined(ctx, PATH, () => (trace(ctx, placement, line), ctx.stroke()), 2.5);
  ctx.setLineDash([]);
}

/** @param {CanvasRenderingContext2D} ctx @param {Placement} placement @param {[number, number][]} points */
function trace(ctx, placement, points) {
  ctx.beginPath();
  for (const [u, v] of points) {
    const { x, y } = boxFromPicture(placement, u, v);
    ctx.lineTo(x, y);
  }
}

/**
 * @param {CanvasRenderingContext2D} ctx @param {Placement} placement
 * @param {[number, number][]} region @param {string} style @param {boolean} isGuess
 */
function drawRegion(ctx, placement, region, style, isGuess) {
  if (region.length < 3) return;
  ctx.beginPath();
  for (const [u, v] of region) {
    const { x, y } = boxFromPicture(placement, u, v);
    ctx.lineTo(x, y);
  }
  ctx.closePath();
  ctx.globalAlpha = 0.16;
  ctx.fillStyle = style;
  ctx.fill();
  ctx.globalAlpha = 1;
  ctx.setLineDash(isGuess ? [6, 5] : []);
  outlined(ctx, style, () => ctx.stroke(), 1.5);
  ctx.setLineDash([]);
}

/** @param {CanvasRenderingContext2D} ctx @param {number} x @param {number} y */
function drawTicks(ctx, x, y) {
  ctx.beginPath();
  for (const [dx, dy] of /** @type {[number, number][]} */ ([[1, 0], [-1, 0], [0, 1], [0, -1]])) {
    ctx.moveTo(x + dx * 3, y + dy * 3);
    ctx.lineTo(x + dx * 7, y + dy * 7);
  }
  ctx.stroke();
}

/** @param {CanvasRenderingContext2D} ctx @param {Placement} placement @param {number} x @param {number} y @param {TargetView} target */
function drawLabel(ctx, placement, x, y, target) {
  const text = target.range === null ? target.status.replaceAll("_", " ") : length(target.range);
  const note = target.source === "floor" ? "guess" : "";
  ctx.font = `600 15px ${FONT}`;
  const width = ctx.measureText(note ? `${text}  ${note}` : text).width + 18;
  const left = Math.min(x + RADIUS + 8, placement.left + placement.width - width - 6);
  const top = Math.max(placement.top + 6, y - 14);
  ctx.fillStyle = SHADE;
  ctx.beginPath();
  ctx.roundRect(left, top, width, 28, 8);
  ctx.fill();
  ctx.textBaseline = "middle";
  ctx.fillStyle = INK;
  ctx.fillText(text, left + 9, top + 15);
  ctx.fillStyle = GUESS;
  if (note) ctx.fillText(note, left + 9 + ctx.measureText(`${text}  `).width, top + 15);
}

/** @param {CanvasRenderingContext2D} ctx @param {Placement} placement @param {Marker} marker @param {string} style */
function drawEdgeArrow(ctx, placement, marker, style) {
  const wanted = boxFromPicture(placement, marker.u, marker.v);
  const { left, top, width, height } = placement;
  const x = Math.min(left + width - EDGE_MARGIN, Math.max(left + EDGE_MARGIN, wanted.x));
  const y = Math.min(top + height - EDGE_MARGIN, Math.max(top + EDGE_MARGIN, wanted.y));
  ctx.save();
  ctx.translate(x, y);
  ctx.rotate(Math.atan2(wanted.y - y, wanted.x - x));
  outlined(ctx, style, () => {
    ctx.beginPath();
    ctx.moveTo(-7, -9);
    ctx.lineTo(5, 0);
    ctx.lineTo(-7, 9);
    ctx.stroke();
  }, 3);
  ctx.restore();
}

/** @param {CanvasRenderingContext2D} ctx @param {Placement} placement @param {number} u @param {number} v */
function drawTap(ctx, placement, u, v) {
  const { x, y } = boxFromPicture(placement, u, v);
  outlined(ctx, INK, () => {
    ctx.beginPath();
    ctx.arc(x, y, 20, 0, 2 * Math.PI);
    ctx.stroke();
  });
}

/**
 * Strokes twice, dark and wide below, so that the line reads on any picture.
 * @param {CanvasRenderingContext2D} ctx @param {string} style @param {() => void} stroke @param {number} [width]
 */
function outlined(ctx, style, stroke, width = 2) {
  ctx.lineCap = "round";
  ctx.lineWidth = width + 3;
  ctx.strokeStyle = "rgb(0 0 0 / 45%)";
  stroke();
  ctx.lineWidth = width;
  ctx.strokeStyle = style;
  stroke();
}
