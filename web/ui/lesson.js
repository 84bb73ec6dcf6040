/**
 * Teach-in beside the picture: which lesson, what is asked now, how the robot file would change, how it ended.
 * What is asked stays, without effect, while the robot moves: nothing jumps under the fingers.
 */
import { sentence } from "../view/words.js";
import { byId, make, setText } from "./dom.js";

/**
 * @typedef {import("../net/messages.js").LessonView} LessonView
 * @typedef {NonNullable<LessonView["lesson"]>} LessonName
 */

/** @type {Record<LessonName, [string, string]>} */
const LESSONS = {
  motors: ["Motors", "Which way each wheel turns and counts"],
  encoders: ["Encoders", "Ticks of a turn, by hand"],
  servos: ["Servos", "Ends, direction and zero of each joint"],
};

/** @type {Record<string, [string, string]>} in the order in which they stand */
const STEPS = {
  "--": ["−50", "Pulse shorter by 50 µs"],
  "-": ["−10", "Pulse shorter by 10 µs"],
  "+": ["+10", "Pulse longer by 10 µs"],
  "++": ["+50", "Pulse longer by 50 µs"],
  ok: ["It is there", "It is there"],
};

const ENDINGS = { done: "Ended", failed: "Not done", cancelled: "Stopped" };

export class Lesson {
  /**
   * @param {import("../net/control_socket.js").ControlSocket} socket
   * @param {import("../net/situation.js").Situation} situation
   * @param {import("./toast.js").Toast} toast
   */
  constructor(socket, situation, toast) {
    this.socket = socket;
    this.situation = situation;
    this.toast = toast;
    /** @type {LessonView | null} */
    this.view = null;
    this.isChoosing = false;
    byId("lesson-close").addEventListener("click", () => this.close());
    situation.addEventListener("change", () => this.showRights());
  }

  /** Offers what this robot can be taught. */
  choose() {
    this.isChoosing = true;
    this.view = null;
    this.open("Teach-in", "");
    setText(byId("lesson-said"), "Wheels off the ground, the arm free all around. In this order:");
    setText(byId("lesson-question"), "");
    showChange("");
    this.setActs((this.situation.facts.welcome?.lessons ?? []).map((name) => this.makeItem(name)), "lesson__acts");
  }

  close() {
    const mustTell = this.view !== null && (!this.view.ended || this.situation.holdsLease);
    this.isChoosing = false;
    if (mustTell) void this.send({ type: "lesson_end" });
    if (this.view === null || this.view.ended) this.hide();
  }

  hide() {
    this.view = null;
    this.isChoosing = false;
    byId("lesson").hidden = true;
    document.body.classList.remove("has-lesson");
  }

  /** @param {import("../net/control_socket.js").Unnumbered} message */
  async send(message) {
    const ack = await this.socket.send(message);
    if (!ack.ok) this.toast.tell(ack.reason, "bad");
  }

  /** @param {LessonView} view */
  show(view) {
    if (view.lesson === null) {
      if (!this.isChoosing) this.hide();
      return;
    }
    if (this.view === null) this.setActs([], "guide__acts");
    const isNew = view.question_id !== this.view?.question_id || view.lesson !== this.view.lesson;
    this.view = view;
    this.isChoosing = false;
    this.open(LESSONS[view.lesson][0], view.ended ? ENDINGS[view.ended] : "");
    byId("lesson").dataset.ended = view.ended;
    setText(byId("lesson-said"), view.said.join("\n"));
    if (view.question || view.ended) {
      setText(byId("lesson-question"), sentence(view.question || view.outcome));
      showChange(view.change);
      if (view.ended) this.showWaysOn(view.lesson);
      else if (isNew) this.showAnswers(view);
    }
    this.showRights();
  }

  /** @param {string} title @param {string} state */
  open(title, state) {
    byId("lesson").hidden = false;
    document.body.classList.add("has-lesson");
    delete byId("lesson").dataset.ended;
    setText(byId("lesson-title"), title);
    setText(byId("lesson-state"), state);
    byId("lesson-close").setAttribute("aria-label", state || this.isChoosing ? "Close teach-in" : "Stop the lesson");
  }

  /** @param {LessonView} view */
  showAnswers({ answers, question_id: questionId }) {
    const isJog = answers.includes("++");
    const ordered = isJog ? Object.keys(STEPS).filter((step) => answers.includes(step)) : answers;
    const buttons = ordered.map((answer) => {
      const isMain = answer === "ok" || answer === "yes";
      const [text, label] = (isJog ? STEPS[answer] : undefined) ?? [sentence(answer), undefined];
      const attributes = { type: "button", class: `button ${isMain ? "button--accent" : ""}`, text };
      const button = make("button", { ...attributes, "aria-label": label });
      button.addEventListener("click", () => void this.send({ type: "lesson_answer", question_id: questionId, answer }));
      return button;
    });
    this.setActs(buttons, isJog ? "guide__acts lesson__steps" : "guide__acts");
  }

  /** After the end: once more, or another one. @param {LessonName} lesson */
  showWaysOn(lesson) {
    const again = make("button", { type: "button", class: "button", text: "Again" });
    const others = make("button", { type: "button", class: "button", text: "All lessons" });
    again.addEventListener("click", () => void this.send({ type: "lesson_start", lesson }));
    others.addEventListener("click", () => this.choose());
    this.setActs([again, others], "guide__acts");
  }

  /** @param {HTMLElement[]} acts @param {string} className */
  setActs(acts, className) {
    byId("lesson-acts").className = className;
    byId("lesson-acts").replaceChildren(...acts);
  }

  /** @param {LessonName} name @returns {HTMLElement} */
  makeItem(name) {
    const [title, purpose] = LESSONS[name];
    const words = [make("strong", { text: title }), make("span", { text: purpose })];
    const item = make("button", { type: "button", class: "item" }, words);
    item.addEventListener("click", () => void this.send({ type: "lesson_start", lesson: name }));
    return item;
  }

  /** Only who drives may answer, and only what is asked now. */
  showRights() {
    byId("menu-lessons").hidden = !this.situation.facts.welcome?.lessons.length;
    if (this.view === null) return;
    const mayAnswer = this.situation.holdsLease && (this.view.question || this.view.ended) !== "";
    byId("lesson").setAttribute("aria-busy", String(!this.view.question && !this.view.ended));
    for (const button of byId("lesson-acts").querySelectorAll("button")) button.disabled = !mayAnswer;
  }
}

/** @param {string} change a unified diff; of its heads only the tables are shown, each once */
function showChange(change) {
  const lines = change.split("\n").filter((line) => line && !/^(---|\+\+\+) /.test(line));
  byId("lesson-change").hidden = lines.length === 0;
  let table = "";
  const shown = lines.flatMap((line) => {
    const head = /^@@.*@@ ?(.*)$/.exec(line);
    if (!head) return [make(line.startsWith("+") ? "ins" : "del", { text: line })];
    const isSame = head[1] === table;
    table = head[1] ?? "";
    return isSame ? [] : [make("span", { class: "lesson__table", text: table })];
  });
  byId("lesson-change").replaceChildren(...shown);
}
