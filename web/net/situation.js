/**
 * What the page knows of the world right now, and whether it may move the robot.
 * Event "change" after every change of a fact.
 *
 * @typedef {import("./messages.js").Welcome} Welcome
 * @typedef {import("./messages.js").State} State
 * @typedef {import("./link.js").LinkState} LinkState
 * @typedef {{link: LinkState, welcome: Welcome | null, state: State | null, frameId: number | null,
 *   pictureAgeMs: number | null, rttMs: number | null, isFrozen: boolean, isPaused: boolean}} Facts
 */
import { number } from "../view/words.js";

export class Situation extends EventTarget {
  constructor() {
    super();
    /** @type {Facts} */
    this.facts = {
      link: { stage: "connecting", retryMs: 0 },
      welcome: null,
      state: null,
      frameId: null,
      pictureAgeMs: null,
      rttMs: null,
      isFrozen: false,
      isPaused: false,
    };
  }

  /** @param {Partial<Facts>} news */
  learn(news) {
    Object.assign(this.facts, news);
    this.dispatchEvent(new CustomEvent("change"));
  }

  get isConnected() {
    return this.facts.link.stage === "open" && this.facts.welcome !== null;
  }

  get sessionId() {
    return this.facts.welcome?.session_id ?? null;
  }

  get holdsLease() {
    const { state } = this.facts;
    return this.isConnected && state !== null && state.lease.holder_id === this.sessionId;
  }

  /** Why this page may not move the robot at all: '' when it may. */
  get moveRefusal() {
    const { state } = this.facts;
    if (!this.isConnected || !state) return "No connection to the robot.";
    if (state.health === "lost") return `The robot is lost: ${state.health_reason}`;
    if (state.emergency_stop) return "Stopped. Press Resume first.";
    if (this.holdsLease) return "";
    if (state.lease.holder_id === null) return "Nobody drives. Press Drive to take over.";
    return `${state.lease.holder_name || "Another session"} drives. Ask to take over first.`;
  }

  /** Why this page may not drive on sight: the picture counts too. */
  get driveRefusal() {
    const { isPaused, isFrozen, frameId, pictureAgeMs } = this.facts;
    if (this.moveRefusal) return this.moveRefusal;
    if (isPaused) return "The picture is paused. Go live to drive.";
    if (frameId === null) return "There is no picture yet.";
    if (isFrozen) return `The picture is ${number((pictureAgeMs ?? 0) / 1000, 1)} s old. Driving waits for a fresh one.`;
    return "";
  }
}
