/** The few things every part of the page does with elements. */

/**
 * @template {Element} [T=HTMLElement]
 * @param {string} id
 * @returns {T}
 * @throws {RangeError} when the page has no such element
 */
export function byId(id) {
  const element = document.getElementById(id);
  if (!element) throw new RangeError(`index.html has no element with the id "${id}"`);
  return /** @type {T} */ (/** @type {unknown} */ (element));
}

/**
 * Sets a text only when it is new, so that live regions speak once.
 * @param {Element} element
 * @param {string} text
 */
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/**
 * @param {string} tag
 * @param {Record<string, string | undefined>} attributes "text" is the text content
 * @param {Element[]} children
 * @returns {HTMLElement}
 */
export function make(tag, { text, ...attributes }, children = []) {
  const element = document.createElement(tag);
  if (text !== undefined) element.textContent = text;
  for (const [name, value] of Object.entries(attributes)) if (value !== undefined) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/**
 * @param {string} name of a symbol in index.html, without "i-"
 * @returns {SVGSVGElement}
 */
export function icon(name) {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  const use = document.createElementNS("http://www.w3.org/2000/svg", "use");
  svg.setAttribute("class", "icon icon--small");
  svg.setAttribute("aria-hidden", "true");
  use.setAttribute("href", `#i-${name}`);
  svg.append(use);
  return svg;
}
