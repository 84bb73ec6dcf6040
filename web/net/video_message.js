/**
 * A picture on the wire: header (little-endian `<4sIQQHHI`), meta as JSON, JPEG.
 *
 * @typedef {{target_id: number, u: number, v: number, inside: boolean, region: [number, number][],
 *   box?: [number, number][], state: "followed" | "predicted"}} Marker `box`: corners of the thing's size, or none
 * @typedef {{base: [number, number, number] | null, markers: Marker[],
 *   path?: [number, number][][], plan?: [number, number][][]}} FrameMeta `base`: x, y [m], heading [rad];
 *   `path`: sides of the way being driven, and the robot's body at its end [px]; `plan`: the way to what is
 *   to be fetched, and the claw there [px]
 * @typedef {{frameId: number, capturedMs: number, sentMs: number, receivedMs: number, width: number,
 *   height: number, meta: FrameMeta, jpeg: Blob}} Frame `captured` and `sent` on the server's clock
 */
export const HEADER_BYTES = 32;
const MAGIC = 0x31565254; // "TRV1", little-endian

/** @param {bigint} ns @returns {number} [ms], exact to a microsecond for three centuries */
const toMs = (ns) => Number(ns / 1000n) / 1000;

/**
 * @param {ArrayBuffer} message
 * @param {number} receivedMs the page's clock
 * @returns {Frame}
 * @throws {RangeError} when the message is no picture of this protocol
 */
export function parseVideoMessage(message, receivedMs) {
  const view = new DataView(message);
  if (message.byteLength < HEADER_BYTES || view.getUint32(0, true) !== MAGIC) {
    throw new RangeError(`no TRV1 picture in a message of ${message.byteLength} bytes`);
  }
  const metaEnd = HEADER_BYTES + view.getUint32(28, true);
  if (metaEnd > message.byteLength) {
    throw new RangeError(`meta ends at byte ${metaEnd} of a message of ${message.byteLength} bytes`);
  }
  return {
    frameId: view.getUint32(4, true),
    capturedMs: toMs(view.getBigUint64(8, true)),
    sentMs: toMs(view.getBigUint64(16, true)),
    receivedMs,
    width: view.getUint16(24, true),
    height: view.getUint16(26, true),
    meta: JSON.parse(new TextDecoder().decode(new Uint8Array(message, HEADER_BYTES, metaEnd - HEADER_BYTES))),
    jpeg: new Blob([new Uint8Array(message, metaEnd)], { type: "image/jpeg" }),
  };
}
