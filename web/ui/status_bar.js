/**
 * Always visible: the link, the picture's age, the round trip, what really went to the wheels and why not
 * more, and odometry.
 */
import { arrow, duration, motion, number } from "../view/words.js";
import { byId, setText } from "./dom.js";

export class StatusBar {
  /** @param {import("../net/situation.js").Situation} situation */
  constructor(situation) {
    this.situation = situation;
    situation.addEventListener("change", () => this.show());
  }

  show() {
    const { facts } = this.situation;
    this.showLink();
    setText(byId("age"), facts.pictureAgeMs === null ? "–" : duration(facts.pictureAgeMs));
    setText(byId("age-label"), facts.isPaused ? "Paused" : "Picture");
    byId("fact-age").dataset.tone = facts.isPaused ? "warn" : facts.isFrozen ? "bad" : "";
    setText(byId("rtt"), facts.rttMs === null || !this.situation.isConnected ? "–" : duration(facts.rttMs));
    this.showMotion();
    this.showOdometry();
  }

  showLink() {
    const { facts, isConnected } = this.situation;
    const health = facts.state?.health;
    setText(byId("robot-name"), facts.welcome?.robot || "Tapreach");
    byId("link-dot").dataset.tone = !isConnected || health === "lost" ? "bad" : health === "running" ? "good" : "";
    setText(byId("link-text"), linkWords(isConnected, facts));
  }

  showMotion() {
    const { facts, isConnected } = this.situation;
    const sent = isConnected ? facts.state?.sent : null;
    const limit = (isConnected && facts.state?.limited_by) || "";
    setText(byId("motion"), sent ? motion(sent.linear, sent.angular) : "–");
    setText(byId("motion-label"), limit ? `Limited: ${limit}` : "Robot");
    byId("fact-motion").title = limit;
    byId("fact-motion").dataset.tone = limit ? "warn" : "";
    const turn = sent ? arrow(sent.linear, sent.angular) : null;
    const icon = byId("motion-arrow");
    icon.toggleAttribute("hidden", turn === null);
    icon.style.transform = `rotate(${turn ?? 0}deg)`;
  }

  showOdometry() {
    const odometry = this.situation.facts.state?.odometry;
    setText(
      byId("odometry"),
      odometry ? `x ${number(odometry.x, 2)}  y ${number(odometry.y, 2)} m  ${number(odometry.heading_deg, 0)}°` : "–",
    );
  }
}

/** @param {boolean} isConnected @param {import("../net/situation.js").Facts} facts */
function linkWords(isConnected, { link, state }) {
  if (link.stage === "refused") return "Not paired";
  if (link.stage === "waiting") return "Connection lost";
  if (!isConnected || !state) return "Connecting";
  if (state.health === "starting") return "Robot starting";
  if (state.health === "lost") return "Robot lost";
  return state.viewers > 1 ? `${state.viewers} watching` : "Connected";
}
