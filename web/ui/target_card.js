/** The newest target in numbers: distance, interval, X, Y, Z with their uncertainty, reason and advice. */
import { length, number, sentence } from "../view/words.js";
import { byId, make, setText } from "./dom.js";

/** @typedef {import("../net/messages.js").TargetView} TargetView */

/** Two-sided 95 % of a normal distribution, in sigmas. */
const SIGMAS_OF_95 = 1.96;
const TITLES = { floor: "Floor guess", locate: "Target", two_tap: "Two-tap target" };

export class TargetCard {
  /**
   * @param {import("../net/control_socket.js").ControlSocket} socket
   * @param {import("../view/targets.js").Targets} targets
   */
  constructor(socket, targets) {
    this.targets = targets;
    targets.addEventListener("change", () => this.show());
    byId("card-close").addEventListener("click", () => {
      const { newest } = targets;
      if (newest) void socket.send({ type: "target_clear", target_id: newest.target_id });
    });
    byId("card-flip").addEventListener("click", () => this.flip());
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
    setText(byId("card-title"), TITLES[target.source]);
    setText(byId("card-range"), target.range === null ? "No position" : length(target.range));
    setText(byId("card-interval"), intervalWords(target));
    setText(byId("card-size"), sizeWords(target));
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

/**
 * @param {TargetView} target
 * @returns {string} such as "7 cm wide ± 1, 12 cm high ± 2", and what to know of it
 */
function sizeWords({ extent }) {
  if (!extent) return "";
  const { width, height, width_sigma: across, height_sigma: down, reason } = extent;
  if (width === null || height === null) return `No size: ${reason}`;
  const size = `${centimetres(width, across, "wide")}, ${centimetres(height, down, "high")}`;
  return [size, reason].filter(Boolean).map(sentence).join(". ");
}

/** @param {number} metres @param {number | null} sigma @param {string} way */
function centimetres(metres, sigma, way) {
  const half = SIGMAS_OF_95 * 100 * (sigma ?? 0);
  const digits = half < 0.95 ? 1 : 0;
  return `${number(metres * 100, digits)} cm ${way} ± ${number(half, digits)}`;
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
