/**
 * A guided procedure beside the picture: what to do now, what helps, what the robot can do itself, the two
 * values that may be typed, and the result.
 */
import { number, sentence } from "../view/words.js";
import { byId, make, setText } from "./dom.js";

/** @typedef {import("../net/messages.js").GuideView} GuideView */

/** @type {Record<string, string>} */
const ACT_WORDS = {
  pose: "Take pose",
  centre: "Centre it",
  turn: "Turn",
  advance: "Advance",
  next: "Next",
  back: "Back",
};

export class Guide {
  /**
   * @param {import("../net/control_socket.js").ControlSocket} socket
   * @param {import("./toast.js").Toast} toast
   */
  constructor(socket, toast) {
    this.socket = socket;
    this.toast = toast;
    /** @type {GuideView | null} */
    this.view = null;
    byId("guide-close").addEventListener("click", () => void this.send({ type: "guide_end" }));
    byId("guide-theta").addEventListener("change", (event) => this.type(event, "theta_deg", 1));
    byId("guide-distance").addEventListener("change", (event) => this.type(event, "distance", 0.01));
  }

  get wantsTap() {
    return this.view?.wants_tap ?? false;
  }

  /** @param {"two_tap" | "rotation_centre"} kind */
  start(kind) {
    void this.send({ type: "guide_start", kind });
  }

  /** @param {import("../net/control_socket.js").Unnumbered} message */
  async send(message) {
    const ack = await this.socket.send(message);
    if (!ack.ok) this.toast.tell(ack.reason, "bad");
  }

  /** @param {Event} event @param {"theta_deg" | "distance"} name @param {number} unit of what is typed */
  type(event, name, unit) {
    const { value, valueAsNumber } = /** @type {HTMLInputElement} */ (event.target);
    if (value !== "" && !Number.isFinite(valueAsNumber)) return;
    void this.send({ type: "guide_value", name, value: value === "" ? null : valueAsNumber * unit });
  }

  /** @param {GuideView} view */
  show(view) {
    this.view = view.kind === null ? null : view;
    byId("guide").hidden = this.view === null;
    document.body.classList.toggle("has-guide", this.view !== null);
    document.body.classList.toggle("wants-tap", this.wantsTap);
    if (!this.view) return;
    setText(byId("guide-title"), view.title);
    setText(byId("guide-step"), `${view.step} of ${view.steps}`);
    setText(byId("guide-instruction"), view.instruction);
    setText(byId("guide-hint"), sentence(view.hint));
    setText(byId("guide-result"), view.result);
    this.showFields(view);
    this.showActs(view.acts);
  }

  /** @param {GuideView} view */
  showFields(view) {
    const movesNow = view.acts.includes("turn") || view.acts.includes("advance");
    byId("guide-fields").hidden = !movesNow && view.theta_deg === null && view.distance === null;
    const typed = new Set(view.values_typed);
    showField("guide-theta", view.theta_deg, 1, 2, typed.has("theta_deg"));
    showField("guide-distance", view.distance, 100, 1, typed.has("distance"));
  }

  /** @param {readonly string[]} acts */
  showActs(acts) {
    const box = byId("guide-acts");
    if (box.dataset.acts === acts.join()) return;
    box.dataset.acts = acts.join();
    box.replaceChildren(...acts.map((act) => this.makeAct(act, act === acts.find((other) => other !== "back"))));
  }

  /** @param {string} act @param {boolean} isFirst */
  makeAct(act, isFirst) {
    const button = make("button", {
      type: "button",
      class: `button ${isFirst ? "button--accent" : ""}`,
      text: ACT_WORDS[act] ?? act,
    });
    button.addEventListener("click", () => {
      void this.send({ type: "guide_act", act: /** @type {import("../net/messages.js").GuideAct["act"]} */ (act) });
    });
    return button;
  }
}

/** @param {string} id @param {number | null} value @param {number} scale @param {number} digits @param {boolean} isTyped */
function showField(id, value, scale, digits, isTyped) {
  const input = /** @type {HTMLInputElement} */ (byId(id));
  input.classList.toggle("is-typed", isTyped);
  // Never under the fingers of someone who types.
  if (document.activeElement === input) return;
  input.value = value === null ? "" : number(value * scale, digits).replace("\u2212", "-");
}
