/**
 * Where a picture lies inside its box when all of it is shown, centred.
 *
 * @typedef {{left: number, top: number, width: number, height: number, scale: number}} Placement
 *   in CSS pixels of the box; `scale`: CSS pixels per picture pixel
 */

/**
 * @param {number} boxWidth
 * @param {number} boxHeight
 * @param {number} width of the picture
 * @param {number} height of the picture
 * @returns {Placement}
 */
export function placePicture(boxWidth, boxHeight, width, height) {
  const scale = Math.min(boxWidth / width, boxHeight / height);
  return {
    left: (boxWidth - width * scale) / 2,
    top: (boxHeight - height * scale) / 2,
    width: width * scale,
    height: height * scale,
    scale,
  };
}

/**
 * The picture point under a point of the box. The centre of the top-left pixel is (0, 0).
 *
 * @param {Placement} placement
 * @param {number} x
 * @param {number} y
 * @returns {{u: number, v: number} | null} null beside the picture
 */
export function pictureFromBox(placement, x, y) {
  const right = x - placement.left;
  const down = y - placement.top;
  if (right < 0 || down < 0 || right > placement.width || down > placement.height) return null;
  return { u: right / placement.scale - 0.5, v: down / placement.scale - 0.5 };
}

/**
 * The picture point nearest to a point of the screen, which may lie beside the picture.
 *
 * @param {import("./picture.js").Picture} picture
 * @param {number} clientX
 * @param {number} clientY
 * @returns {{u: number, v: number} | null} null while nothing is painted
 */
export function nearestInPicture(picture, clientX, clientY) {
  const placement = picture.placement();
  if (!placement) return null;
  const box = picture.canvas.getBoundingClientRect();
  const x = Math.min(Math.max(clientX - box.left, placement.left), placement.left + placement.width);
  const y = Math.min(Math.max(clientY - box.top, placement.top), placement.top + placement.height);
  return { u: (x - placement.left) / placement.scale - 0.5, v: (y - placement.top) / placement.scale - 0.5 };
}

/**
 * @param {Placement} placement
 * @param {number} u
 * @param {number} v
 * @returns {{x: number, y: number}}
 */
export function boxFromPicture(placement, u, v) {
  return {
    x: placement.left + (u + 0.5) * placement.scale,
    y: placement.top + (v + 0.5) * placement.scale,
  };
}
