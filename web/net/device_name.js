/** @type {readonly [RegExp, string][]} first match wins */
const KINDS = [
  [/iPad/, "iPad"],
  [/iPhone/, "iPhone"],
  [/Android.*Mobile/, "Android phone"],
  [/Android/, "Android tablet"],
  [/CrOS/, "Chromebook"],
  [/Mac OS X/, "Mac"],
  [/Windows/, "Windows PC"],
  [/Linux/, "Linux PC"],
];

/**
 * @param {string} userAgent
 * @returns {string} what others read as "who drives"
 */
export function deviceName(userAgent) {
  return KINDS.find(([pattern]) => pattern.test(userAgent))?.[1] ?? "Browser";
}
