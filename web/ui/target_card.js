/** The newest target in numbers: distance, interval, X, Y, Z with their uncertainty, reason and advice. */
import { SIGMAS_OF_95, length, number, sentence, size } from "../view/words.js";
import { byId, make, setText } from "./dom.js";

/** @typedef {import("../net/messages.js").TargetView} TargetView */

const TITLES = { floor: "Floor guess", locate: "Target", two_tap: "Two-tap target" };

export class TargetCard {
  /**
   * @param {import("../net/control_socket.js").ControlSocket} socket
   * @param {import("../view/targets.js").Targets} targets
   * @param {import("./fetch_mode.js").FetchMode} fetchMode
   * @param {import("./toast.js").Toast} toast
   */
  constructor(socket, targets, fetchMode, toast) {
    this.socket = socket;
    this.targets = targets;
    this.fetchMode = fetchMode;
    this.toast = toast;
    targets.addEventListener("change", () => this.show());
    byId("card-close").addEventListener("click", () => {
      const { newest } = targets;
      if (newest) void socket.send({ type: "target_clear", target_id: newest.target_id });
    });
    byId("card-fetch").addEventListener("click", () => this.fetch());
    byId("card-flip").addEventListener("click", () => this.flip());
  }

  async fetch() {
    const { newest } = this.targets;
    if (!newest) return;
    const ack = await this.socket.send({ type: "fetch", mode: this.fetchMode.chosen, target_id: newest.target_id });
    if (!ack.ok) this.toast.tell(ack.reason, "bad");
  }

  flip() {
    const showsPlan = byId("card").classList.toggle("shows-plan");
    byId("card-flip").setAttribute("aria-pressed", String(showsPlan));
    setText(byId("card-flip"), showsPlan ? "Numbers" : "Plan");
    this.targets.dispatchEvent(new CustomEvent("change"));
  }

  show() {
    const target = this.targets.newest;
    byId("card").hidden = target === null;
    if (!target) return;
    byId("card").dataset.source = target.source;
    byId("card-fetch").hidden = target.source === "floor" || target.point_in_world === null;
    setText(byId("card-title"), TITLES[target.source]);
    setText(byId("card-range"), target.range === null ? "No position" : length(target.range));
    setText(byId("card-interval"), intervalWords(target));
    setText(byId("card-size"), target.extent ? size(target.extent) : "");
    setText(byId("card-reason"), sentence(target.reason));
    setText(byId("card-advice"), sentence(target.advice));
    byId("card-xyz").replaceChildren(...coordinates(target));
  }
}

/** @param {TargetView} target */
function intervalWords({ range, range_low: low, range_high: high }) {
  if (low === null) return range === null ? "" : "uncertainty unknown";
  return high === null ? `95 %: beyond ${length(low)}` : `95 %: ${length(low)} to ${length(high)}`;
}

/** @param {TargetView} target @returns {HTMLElement[]} one row each for X, Y, Z from where the robot is now */
function coordinates({ point_in_base: point, sigma }) {
  if (!point) return [];
  return ["X", "Y", "Z"].flatMap((name, axis) => [
    make("dt", { text: name }),
    make("dd", { text: `${number(Number(point[axis]) * 100, 1)} cm` }),
    make("dd", { class: "xyz__sigma", text: sigma ? `± ${number(Number(sigma[axis]) * 100 * SIGMAS_OF_95, 1)}` : "" }),
  ]);
}
