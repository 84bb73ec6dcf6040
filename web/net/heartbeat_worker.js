/**
 * The control socket lives in this worker: heartbeats leave on time while the page draws, and the round
 * trip is measured without the page's own delays. The page talks to it through control_socket.js.
 *
 * @typedef {import("./control_socket.js").ToWorker} ToWorker
 * @typedef {import("./control_socket.js").FromWorker} FromWorker
 */
import { Heartbeat } from "./heartbeat.js";
import { Link } from "./link.js";

const BEAT_MS = 50;
const PING_MS = 1000;
const SILENCE_MS = 3000;
const CHOKED_BYTES = 8192;

const heartbeat = new Heartbeat();
/** @type {Map<number, number>} seq on the wire to the page's ticket */
const tickets = new Map();
/** @type {Link | null} */
let link = null;
let pageOriginMs = 0;
let seq = 0;

/** @param {FromWorker} message */
const tellPage = (message) => self.postMessage(message);

/** The page's performance.now(): both clocks are the same one, counted from different starts. */
const pageNow = () => performance.timeOrigin + performance.now() - pageOriginMs;

/**
 * @param {import("./control_socket.js").Unnumbered} message
 * @param {number | null} ticket
 */
function send(message, ticket) {
  seq += 1;
  const isSent = link?.send(JSON.stringify({ ...message, seq })) ?? false;
  if (ticket === null) return;
  if (isSent) tickets.set(seq, ticket);
  else tellPage({ kind: "unsent", ticket });
}

/** @param {{url: string, probeUrl: string, pageOriginMs: number, name: string}} command */
function open(command) {
  ({ pageOriginMs } = command);
  link = new Link(command.url, command.probeUrl, SILENCE_MS);
  link.addEventListener("state", (event) => {
    const { detail } = /** @type {CustomEvent} */ (event);
    tellPage({ kind: "link", state: detail });
    if (detail.stage === "open") greet(command.name);
    else forgetTickets();
  });
  link.addEventListener("data", (event) => receive(/** @type {CustomEvent} */ (event).detail));
  link.open();
}

/** @param {string} name */
function greet(name) {
  seq = 0;
  send({ type: "hello", name }, null);
  ping();
}

function forgetTickets() {
  for (const ticket of tickets.values()) tellPage({ kind: "unsent", ticket });
  tickets.clear();
}

function ping() {
  send({ type: "ping", client_ms: pageNow() }, null);
}

/** @param {string} text */
function receive(text) {
  const message = JSON.parse(text);
  const ticket = tickets.get(message.seq) ?? null;
  tickets.delete(message.seq);
  tellPage({ kind: "message", message, ticket, atMs: pageNow() });
}

function beat() {
  const message = heartbeat.beat(pageNow());
  if (message && link && link.backlog < CHOKED_BYTES) send(message, null);
}

/** @param {MessageEvent<ToWorker>} event */
self.onmessage = ({ data }) => {
  if (data.kind === "open") open(data);
  else if (data.kind === "token") heartbeat.feed(data.token);
  else if (data.kind === "retry") link?.retryNow();
  else if (data.isMotion && link && link.backlog >= CHOKED_BYTES) tellPage({ kind: "unsent", ticket: data.ticket });
  else send(data.message, data.ticket);
};

setInterval(beat, BEAT_MS);
setInterval(() => link?.isOpen && ping(), PING_MS);
