/**
 * Fetching beside the picture: whether it can be done, what the robot is at and why, what comes next, and
 * what the operator can say to it.
 */
import { sentence } from "../view/words.js";
import { byId, make, setText } from "./dom.js";

/**
 * @typedef {import("../net/messages.js").FetchView} FetchView
 * @typedef {import("../net/control_socket.js").Unnumbered} Unnumbered
 */

/** @type {Record<FetchView["verbs"][number], string>} */
const VERB_WORDS = { bring_back: "Bring back", put_down: "Put down", hand_over: "Hand over", let_go: "Let go" };

/** @type {Record<"yes" | "unsure" | "no", string>} */
const VERDICT_WORDS = { yes: "Can be fetched", unsure: "May be possible", no: "Cannot be fetched" };

export class FetchPanel {
  /**
   * @param {import("../net/control_socket.js").ControlSocket} socket
   * @param {import("./toast.js").Toast} toast
   */
  constructor(socket, toast) {
    this.socket = socket;
    this.toast = toast;
    /** @type {FetchView | null} */
    this.view = null;
    byId("fetch-close").addEventListener("click", () => this.show(null));
  }

  /** @param {FetchView | null} view null: nothing is being fetched, or it is not wanted on the page */
  show(view) {
    this.view = view?.phase ? view : null;
    byId("fetch").hidden = this.view === null;
    document.body.classList.toggle("has-fetch", this.view !== null);
    if (!this.view) return;
    const { attempt, progress, why, next, stopped, condition } = this.view;
    setText(byId("fetch-step"), attempt > 1 ? `try ${attempt}` : "");
    byId("fetch-progress").setAttribute("value", String(progress));
    showVerdict(this.view);
    setText(byId("fetch-does"), stopped ? sentence(`stopped: ${stopped}`) : sentence(this.view.does));
    setText(byId("fetch-why"), sentence(stopped ? condition : isSaid(why, this.view) ? "" : why));
    setText(byId("fetch-next"), next && !stopped ? `Next: ${next}` : "");
    this.showActs(this.view);
  }

  /** @param {FetchView} view */
  showActs(view) {
    /** @type {[string, Unnumbered][]} */
    const acts = view.verbs.map((verb) => [VERB_WORDS[verb], { type: "fetch_verb", verb }]);
    if (view.may_confirm) acts.unshift(["Fetch it", { type: "fetch_confirm" }]);
    if (view.may_resume) acts.unshift(["Go on", { type: "fetch_resume" }]);
    const names = acts.map(([name]) => name).join();
    const box = byId("fetch-acts");
    if (box.dataset.acts === names) return;
    box.dataset.acts = names;
    box.replaceChildren(...acts.map(([name, message], index) => this.makeAct(name, message, index === 0)));
  }

  /** @param {string} text @param {Unnumbered} message @param {boolean} isFirst */
  makeAct(text, message, isFirst) {
    const button = make("button", { type: "button", class: `button ${isFirst ? "button--accent" : ""}`, text });
    button.addEventListener("click", () => void this.send(message));
    return button;
  }

  /** @param {Unnumbered} message */
  async send(message) {
    const ack = await this.socket.send(message);
    if (!ack.ok) this.toast.tell(ack.reason, "bad");
  }
}

/** What could be done, until it is done. @param {FetchView} view */
function showVerdict({ phase, verdict, reason, advice, seconds }) {
  const isHeld = phase === "held";
  const line = byId("fetch-verdict");
  line.dataset.verdict = verdict ?? "";
  const time = seconds === null || verdict === "no" ? "" : `, about ${Math.round(seconds)} s`;
  setText(line, isHeld ? "Held" : verdict === null ? "Fetch" : VERDICT_WORDS[verdict] + time);
  setText(byId("fetch-reason"), isHeld ? "" : [reason, advice].filter(Boolean).map(sentence).join(". "));
}

/** Whether the verdict's reason says so already. @param {string} why @param {FetchView} view */
function isSaid(why, { reason, advice }) {
  return why === [reason, advice].filter(Boolean).join("; ");
}
