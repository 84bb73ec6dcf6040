/**
 * A small plan view from above: the robot in the middle below, heading up; its field of view, the way it is
 * about to drive, the rays of sight, each target with the outline of its 95 % region, and a scale bar.
 *
 * @typedef {import("../net/messages.js").TargetView} TargetView
 * @typedef {import("../net/messages.js").OdometryView} OdometryView
 * @typedef {import("../net/messages.js").FetchView} FetchView
 * @typedef {import("../net/messages.js").MoveView} MoveView
 * @typedef {{x: number, y: number}} Point in base: x ahead, y left [m]
 */
import { ACCENT, FAINT, FONT, GUESS, INK, PATH, SHADE, SOFT } from "./palette.js";
import { expectation, length } from "./words.js";

const LEAST_REACH = 0.6;
const ROBOT_AT = 0.82;

export class Plan {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.ctx = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    this.width = 0;
    this.height = 0;
    this.pixelsPerMetre = 1;
  }

  /**
   * @param {OdometryView} odometry
   * @param {TargetView[]} targets
   * @param {number} halfView half the horizontal field of view [rad]
   * @param {MoveView | null} move that is being made
   * @param {FetchView | null} fetch what is being fetched
   */
  draw(odometry, targets, halfView, move = null, fetch = null) {
    this.fit(odometry, targets, move);
    if (this.width === 0) return;
    this.drawView(halfView);
    for (const target of targets) this.drawTarget(odometry, target);
    this.drawRobot();
    if (move) this.drawMove(odometry, move);
    if (fetch) this.drawFetch(odometry, fetch);
    this.drawScale();
  }

  /** @param {OdometryView} odometry @param {TargetView[]} targets @param {MoveView | null} move */
  fit(odometry, targets, move) {
    const { canvas } = this;
    this.width = canvas.clientWidth;
    this.height = canvas.clientHeight;
    if (this.width === 0) return; // hidden: a size of 0 would stay
    canvas.width = Math.round(this.width * devicePixelRatio);
    canvas.height = Math.round(this.height * devicePixelRatio);
    this.ctx.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    const points = targets.filter((target) => target.point_in_world).map((target) => pointOf(odometry, target));
    for (const [x, y] of move?.body_in_world ?? []) points.push(baseFromWorld(odometry, x, y));
    const ahead = Math.max(LEAST_REACH, ...points.map((point) => point.x * 1.25));
    const aside = Math.max(LEAST_REACH / 2, ...points.map((point) => Math.abs(point.y) * 1.3));
    this.pixelsPerMetre = Math.min((this.height * (ROBOT_AT - 0.04)) / ahead, (this.width * 0.48) / aside);
  }

  /** @param {Point} point @returns {[number, number]} */
  place({ x, y }) {
    return [this.width / 2 - y * this.pixelsPerMetre, this.height * ROBOT_AT - x * this.pixelsPerMetre];
  }

  /** @param {number} halfView */
  drawView(halfView) {
    const { ctx } = this;
    const far = (this.width + this.height) / this.pixelsPerMetre;
    ctx.fillStyle = FAINT;
    ctx.beginPath();
    ctx.moveTo(...this.place({ x: 0, y: 0 }));
    ctx.lineTo(...this.place({ x: far, y: far * Math.tan(halfView) }));
    ctx.lineTo(...this.place({ x: far, y: -far * Math.tan(halfView) }));
    ctx.fill();
  }

  /** @param {OdometryView} odometry @param {MoveView} move */
  drawMove(odometry, move) {
    const { ctx } = this;
    const [left, right] = move.tracks_in_world;
    if (!left || !right) return;
    ctx.fillStyle = ctx.strokeStyle = PATH;
    ctx.globalAlpha = 0.25;
    this.trace(odometry, [...left, ...[...right].reverse()]);
    ctx.fill();
    ctx.globalAlpha = 1;
    ctx.lineWidth = 1.5;
    this.trace(odometry, move.body_in_world);
    ctx.closePath();
    ctx.stroke();
    this.drawExpectation(expectation(move));
  }

  /** In the corner beside the scale bar. @param {string} words */
  drawExpectation(words) {
    const { ctx } = this;
    ctx.font = `600 12px ${FONT}`;
    const width = ctx.measureText(words).width + 12;
    const left = this.width - width - 6;
    ctx.fillStyle = SHADE;
    ctx.beginPath();
    ctx.roundRect(left, this.height - 25, width, 20, 6);
    ctx.fill();
    ctx.fillStyle = PATH;
    ctx.fillText(words, left + 6, this.height - 11);
  }

  /** The way to the thing and the claw there. @param {OdometryView} odometry @param {FetchView} fetch */
  drawFetch(odometry, fetch) {
    const { ctx } = this;
    ctx.strokeStyle = PATH;
    ctx.lineWidth = 2;
    ctx.setLineDash([6, 4]);
    this.drawLine(odometry, fetch.path.map(([x, y]) => [x, y]));
    ctx.setLineDash([]);
    for (const line of fetch.grasp) this.drawLine(odometry, line);
  }

  drawRobot() {
    const { ctx } = this;
    const [x, y] = this.place({ x: 0, y: 0 });
    ctx.fillStyle = INK;
    ctx.beginPath();
    ctx.moveTo(x, y - 11);
    ctx.lineTo(x + 8, y + 8);
    ctx.lineTo(x, y + 4);
    ctx.lineTo(x - 8, y + 8);
    ctx.fill();
  }

  /** @param {OdometryView} odometry @param {TargetView} target */
  drawTarget(odometry, target) {
    const { ctx } = this;
    const isGuess = target.source === "floor";
    ctx.strokeStyle = ctx.fillStyle = isGuess ? GUESS : ACCENT;
    ctx.lineWidth = 1;
    for (const [x, y, dx, dy] of target.rays_in_world) {
      ctx.globalAlpha = 0.6;
      this.drawLine(odometry, [[x, y], [x + dx * 50, y + dy * 50]]);
    }
    ctx.lineWidth = 1.5;
    ctx.setLineDash(isGuess ? [4, 3] : []);
    if (target.region_in_world.length > 2) {
      ctx.globalAlpha = 0.22;
      this.trace(odometry, target.region_in_world);
      ctx.closePath();
      ctx.fill();
      ctx.globalAlpha = 1;
      ctx.stroke();
    }
    ctx.setLineDash([]);
    ctx.globalAlpha = 1;
    if (target.point_in_world) this.drawDot(pointOf(odometry, target));
  }

  /** @param {Point} point */
  drawDot(point) {
    this.ctx.beginPath();
    this.ctx.arc(...this.place(point), 3.5, 0, 2 * Math.PI);
    this.ctx.fill();
  }

  /** @param {OdometryView} odometry @param {readonly (readonly [number, number])[]} points in world */
  trace(odometry, points) {
    this.ctx.beginPath();
    for (const [x, y] of points) this.ctx.lineTo(...this.place(baseFromWorld(odometry, x, y)));
  }

  /** @param {OdometryView} odometry @param {readonly (readonly [number, number])[]} points in world */
  drawLine(odometry, points) {
    this.trace(odometry, points);
    this.ctx.stroke();
  }

  drawScale() {
    const { ctx } = this;
    const metres = roundLength((this.width * 0.34) / this.pixelsPerMetre);
    const y = this.height - 9;
    ctx.strokeStyle = ctx.fillStyle = SOFT;
    ctx.lineWidth = 2;
    ctx.beginPath();
    ctx.moveTo(10, y);
    ctx.lineTo(10 + metres * this.pixelsPerMetre, y);
    ctx.stroke();
    ctx.fillStyle = INK;
    ctx.font = `500 12px ${FONT}`;
    ctx.fillText(metres < 1 ? `${Math.round(metres * 100)} cm` : length(metres).replace(".00", ""), 10, y - 6);
  }
}

/** @param {OdometryView} odometry @param {TargetView} target @returns {Point} */
function pointOf(odometry, target) {
  const [x, y] = /** @type {readonly [number, number, number]} */ (target.point_in_world);
  return baseFromWorld(odometry, x, y);
}

/** @param {OdometryView} odometry @param {number} x @param {number} y @returns {Point} */
export function baseFromWorld(odometry, x, y) {
  const heading = (odometry.heading_deg * Math.PI) / 180;
  const east = x - odometry.x;
  const north = y - odometry.y;
  return {
    x: east * Math.cos(heading) + north * Math.sin(heading),
    y: -east * Math.sin(heading) + north * Math.cos(heading),
  };
}

/** @param {number} most @returns {number} the longest of 1, 2, 5 times a power of ten that is no longer */
export function roundLength(most) {
  const power = 10 ** Math.floor(Math.log10(most));
  return power * (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1);
}
