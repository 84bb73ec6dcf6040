/** Captures stored on the robot's side: take, browse, download, delete. */
import { byId, icon, make, setText } from "./dom.js";

/** @typedef {{id: string, taken_at: string, width: number, height: number, frame_id: number}} CaptureInfo */

export class Captures {
  /**
   * @param {import("../net/control_socket.js").ControlSocket} socket
   * @param {import("./toast.js").Toast} toast
   */
  constructor(socket, toast) {
    this.socket = socket;
    this.toast = toast;
    /** @type {readonly CaptureInfo[]} */
    this.captures = [];
  }

  /** @param {number | null} frameId the frame on the screen when it is paused; null: the newest */
  async take(frameId) {
    const ack = await this.socket.send({ type: "capture", frame_id: frameId });
    this.toast.tell(ack.ok ? "Captured, and stored on the robot's side." : ack.reason, ack.ok ? "plain" : "bad");
  }

  async refresh() {
    try {
      const answer = await fetch("/api/captures", { cache: "no-store" });
      if (!answer.ok) throw new Error(`the server answered ${answer.status}`);
      this.captures = await answer.json();
    } catch (error) {
      this.toast.tell(`The list of captures did not come: ${error instanceof Error ? error.message : error}`, "bad");
      return;
    }
    this.show();
  }

  show() {
    const count = this.captures.length;
    byId("captures-empty").hidden = count > 0;
    byId("captures-count").hidden = count === 0;
    setText(byId("captures-count"), String(count));
    byId("captures-open").setAttribute("aria-label", `Captures, ${count} stored`);
    byId("captures-list").replaceChildren(...this.captures.map((capture) => this.makeThumb(capture)));
  }

  /** @param {CaptureInfo} capture */
  makeThumb(capture) {
    const address = `/api/captures/${encodeURIComponent(capture.id)}`;
    const name = when(capture.taken_at);
    const picture = make("img", { src: `${address}.jpg`, alt: `Capture of ${name}`, loading: "lazy" });
    const row = make("div", { class: "thumb__row" });
    this.fillRow(row, capture, address, name);
    return make("li", { class: "thumb" }, [picture, row]);
  }

  /** @param {HTMLElement} row @param {CaptureInfo} capture @param {string} address @param {string} name */
  fillRow(row, capture, address, name) {
    const label = make("span", { text: name }, [make("small", { text: `${capture.width} × ${capture.height}` })]);
    const download = make("a", { class: "close", href: `${address}.jpg`, download: `${capture.id}.jpg`, "aria-label": `Download ${name}` }, [icon("download")]);
    const remove = make("button", { type: "button", class: "close", "aria-label": `Delete ${name}` }, [icon("trash")]);
    remove.addEventListener("click", () => this.askDelete(row, capture, address, name));
    row.replaceChildren(label, download, remove);
  }

  /** @param {HTMLElement} row @param {CaptureInfo} capture @param {string} address @param {string} name */
  askDelete(row, capture, address, name) {
    const sure = make("button", { type: "button", class: "button button--small button--stop", text: "Delete" });
    const keep = make("button", { type: "button", class: "button button--small button--quiet", text: "Keep" });
    sure.addEventListener("click", () => this.remove(address));
    keep.addEventListener("click", () => this.fillRow(row, capture, address, name));
    row.replaceChildren(make("span", { class: "thumb__sure", text: "For good?" }), sure, keep);
    keep.focus();
  }

  /** @param {string} address */
  async remove(address) {
    try {
      const answer = await fetch(address, { method: "DELETE" });
      if (!answer.ok) throw new Error(`the server answered ${answer.status}`);
    } catch (error) {
      this.toast.tell(`Not deleted: ${error instanceof Error ? error.message : error}`, "bad");
    }
    await this.refresh();
  }
}

/** @param {string} takenAt ISO 8601 @returns {string} as the person's own language writes it */
function when(takenAt) {
  const date = new Date(takenAt);
  if (Number.isNaN(date.getTime())) return takenAt;
  return date.toLocaleString(undefined, { month: "short", day: "numeric", hour: "2-digit", minute: "2-digit", second: "2-digit" });
}
