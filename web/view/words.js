/** Numbers and motion in the words a person reads. */

const MINUS = "\u2212";
const STILL_LINEAR = 0.005;
const STILL_ANGULAR = 0.01;

/**
 * @param {number} value
 * @param {number} digits after the point
 * @returns {string} with a true minus sign, and no negative zero
 */
export function number(value, digits) {
  const text = Math.abs(value).toFixed(digits);
  return value < 0 && Number(text) !== 0 ? MINUS + text : text;
}

/** @param {string} words @returns {string} with a capital first letter, as a sentence begins */
export function sentence(words) {
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** @param {number} ms @returns {string} */
export function duration(ms) {
  return ms < 1000 ? `${number(ms, 0)} ms` : `${number(ms / 1000, 1)} s`;
}

/** @param {number} metres @returns {string} centimetres below a metre, where they read better */
export function length(metres) {
  return Math.abs(metres) < 1 ? `${number(metres * 100, 1)} cm` : `${number(metres, 2)} m`;
}

/**
 * @param {number} linear [m/s]
 * @param {number} angular [rad/s], left positive
 * @returns {string} such as "Forward 0.12 m/s, left 14°/s"
 */
export function motion(linear, angular) {
  const parts = [];
  if (Math.abs(linear) >= STILL_LINEAR) {
    parts.push(`${linear > 0 ? "forward" : "back"} ${number(Math.abs(linear), 2)} m/s`);
  }
  if (Math.abs(angular) >= STILL_ANGULAR) {
    parts.push(`${angular > 0 ? "left" : "right"} ${number((Math.abs(angular) * 180) / Math.PI, 0)}°/s`);
  }
  return sentence(parts.join(", ") || "still");
}

/**
 * @param {number} linear
 * @param {number} angular
 * @returns {number | null} direction of an arrow, degrees clockwise from up; null when still
 */
export function arrow(linear, angular) {
  const ahead = Math.abs(linear) >= STILL_LINEAR ? Math.sign(linear) : 0;
  const right = Math.abs(angular) >= STILL_ANGULAR ? -Math.sign(angular) : 0;
  if (ahead === 0 && right === 0) return null;
  return (Math.atan2(right, ahead) * 180) / Math.PI;
}
