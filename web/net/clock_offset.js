/**
 * Where the server's clock stands against the page's, from ping and pong: of the last samples the one
 * with the shortest round trip is believed, since its error is at most half of it.
 */
const SAMPLES = 20;

export class ClockOffset {
  constructor() {
    /** @type {{rttMs: number, offsetMs: number}[]} */
    this.samples = [];
  }

  /** A new connection may be to a server that was started anew. */
  reset() {
    this.samples = [];
  }

  /**
   * @param {number} clientMs the page's clock when the ping left
   * @param {number} serverNs the server's clock when it answered
   * @param {number} nowMs the page's clock when the pong came
   */
  add(clientMs, serverNs, nowMs) {
    const rttMs = Math.max(0, nowMs - clientMs);
    this.samples.push({ rttMs, offsetMs: serverNs / 1e6 - (clientMs + nowMs) / 2 });
    if (this.samples.length > SAMPLES) this.samples.shift();
  }

  /** Round trip of the newest ping [ms]; null before the first. */
  get rttMs() {
    return this.samples.at(-1)?.rttMs ?? null;
  }

  /** Server's clock minus the page's [ms]; null before the first pong. */
  get offsetMs() {
    if (this.samples.length === 0) return null;
    return this.samples.reduce((best, sample) => (sample.rttMs < best.rttMs ? sample : best)).offsetMs;
  }

  /**
   * @param {number} serverMs a time on the server's clock
   * @param {number} nowMs the page's clock
   * @returns {number | null} how long ago that was [ms], never negative; null while the offset is unknown
   */
  ageMs(serverMs, nowMs) {
    const { offsetMs } = this;
    return offsetMs === null ? null : Math.max(0, nowMs + offsetMs - serverMs);
  }
}
