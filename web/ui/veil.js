/**
 * Over the picture, when it must not be trusted: FROZEN with its age, no connection, robot lost, not paired.
 *
 * @typedef {{kind: string, title: string, text: string, canRetry: boolean}} Notice
 */
import { number, sentence } from "../view/words.js";
import { byId, setText } from "./dom.js";

export class Veil {
  /**
   * @param {import("../net/situation.js").Situation} situation
   * @param {() => void} retry
   */
  constructor(situation, retry) {
    this.situation = situation;
    situation.addEventListener("change", () => this.show());
    byId("veil-action").addEventListener("click", retry);
  }

  show() {
    const notice = this.notice();
    const veil = byId("veil");
    veil.hidden = notice === null;
    veil.dataset.kind = notice?.kind ?? "";
    setText(byId("veil-title"), notice?.title ?? "");
    setText(byId("veil-text"), sentence(notice?.text ?? ""));
    byId("veil-action").hidden = !notice?.canRetry;
  }

  /** @returns {Notice | null} the worst thing first */
  notice() {
    const { facts, isConnected } = this.situation;
    return linkNotice(facts, isConnected) ?? robotNotice(facts) ?? frozenNotice(facts);
  }
}

/** @param {import("../net/situation.js").Facts} facts @param {boolean} isConnected @returns {Notice | null} */
function linkNotice({ link, welcome }, isConnected) {
  if (link.stage === "refused") {
    const text = "The robot lets in only who has its printed address. Open that address, or scan its code again.";
    return { kind: "refused", title: "Not paired", text, canRetry: true };
  }
  if (isConnected) return null;
  if (link.stage === "waiting" || welcome) {
    const text = "The server does not answer, and the robot stops by itself. Trying again all the time.";
    return { kind: "gone", title: "Connection lost", text, canRetry: true };
  }
  return { kind: "connecting", title: "Connecting", text: "Asking the robot for its picture.", canRetry: false };
}

/** @param {import("../net/situation.js").Facts} facts @returns {Notice | null} */
function robotNotice({ state, frameId, isFrozen, isPaused, pictureAgeMs }) {
  if (state?.health === "lost") {
    const isOld = frameId !== null && isFrozen && !isPaused;
    const title = isOld ? frozenTitle(pictureAgeMs) : "Robot lost";
    return { kind: "lost", title, text: state.health_reason, canRetry: false };
  }
  if (frameId !== null) return null;
  const text = state?.health_reason || "The camera has not sent its first picture yet.";
  return { kind: "starting", title: "Waiting for the picture", text, canRetry: false };
}

/** @param {import("../net/situation.js").Facts} facts @returns {Notice | null} */
function frozenNotice({ isFrozen, isPaused, pictureAgeMs }) {
  if (!isFrozen || isPaused) return null;
  const text = "This picture is old. Driving waits until it moves again.";
  return { kind: "frozen", title: frozenTitle(pictureAgeMs), text, canRetry: false };
}

/** @param {number | null} ageMs @returns {string} */
function frozenTitle(ageMs) {
  return `FROZEN ${number((ageMs ?? 0) / 1000, 1)} s`;
}
