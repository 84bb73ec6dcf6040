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

/**
 * @param {{expected_sd: number | null, expected_relative_sd: number | null}} move
 * @returns {string} such as "±2.1 cm, 1.4 %"; '' when nothing is expected
 */
export function expectation({ expected_sd: sd, expected_relative_sd: share }) {
  return sd === null || share === null ? "" : `±${number(sd * 100, 1)} cm, ${number(share * 100, 1)} %`;
}

/** @param {number} metres @returns {string} centimetres below a metre, where they read better */
export function length(metres) {
  return Math.abs(metres) < 1 ? `${number(metres * 100, 1)} cm` : `${number(metres, 2)} m`;
}

/** Two-sided 95 % of a normal distribution, in sigmas. */
export const SIGMAS_OF_95 = 1.96;

/**
 * @param {import("../net/messages.js").ExtentView} extent
 * @returns {string} such as "7 cm wide ± 1, 11.8 cm high ± 0.6", and what to know of it
 */
export function size({ width, height, width_sigma: across, height_sigma: down, reason }) {
  if (width === null || height === null) return `No size: ${reason}`;
  const words = [`${centimetres(width, across, "wide")}, ${centimetres(height, down, "high")}`, reason];
  return words.filter(Boolean).map(sentence).join(". ");
}

/**
 * @param {import("../net/messages.js").ExtentView} extent
 * @returns {string} such as "7 × 12 cm"
 */
export function shortSize({ width, height, width_sigma: across, height_sigma: down }) {
  if (width === null || height === null) return "";
  const digits = digitsFor(Math.max(across ?? 0, down ?? 0));
  return `${number(width * 100, digits)} × ${number(height * 100, digits)} cm`;
}

/** @param {number} metres @param {number | null} sigma @param {string} way */
function centimetres(metres, sigma, way) {
  const digits = digitsFor(sigma ?? 0);
  return `${number(metres * 100, digits)} cm ${way} ± ${number(SIGMAS_OF_95 * 100 * (sigma ?? 0), digits)}`;
}

/** @param {number} sigma [m] @returns {number} digits after the point of centimetres that say something */
const digitsFor = (sigma) => (SIGMAS_OF_95 * 100 * sigma < 0.95 ? 1 : 0);

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
