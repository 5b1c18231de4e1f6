// The log: lines of the daemon with their severity, filtered and searched; and marks in the recording.

import { byId, make, makeSegments, setText } from "./dom.js";

/** @typedef {import("./messages.js").LogEvent} LogEvent */

const kLinesMost = 1000;
const kAtEnd_px = 40;
const kRank = /** @type {Record<string, number>} */ ({ info: 0, warning: 1, error: 2 });
/** @type {[string, string][]} */
const kFilters = [["info", "All"], ["warning", "Warnings"], ["error", "Errors"]];

export class LogView {
  #lines = byId("log-lines");
  #badge = byId("log-badge");
  #filter = "info";
  #unread = 0;
  #worst = "info";

  /**
   * @param {import("./bus.js").Bus} bus
   * @param {import("./operator_channel.js").OperatorChannel} channel
   */
  constructor(bus, channel) {
    this.bus = bus;
    this.channel = channel;
    makeSegments(byId("log-filter"), kFilters, this.#filter, (value) => {
      this.#filter = value;
      this.#showMatching();
    });
    byId("log-search").addEventListener("input", () => this.#showMatching());
    bus.on("log", (/** @type {{events: LogEvent[]}} */ log) => {
      this.#lines.replaceChildren(...log.events.map((event) => this.#makeLine(event)));
      this.#toEnd();
    });
    bus.on("event", (event) => this.#add(event));
    bus.on("tab", (tab) => {
      if (tab !== "log") return;
      this.#unread = 0;
      this.#worst = "info";
      this.#badge.hidden = true;
      this.#toEnd();
    });
    byId("mark-form").addEventListener("submit", (/** @type {Event} */ event) => {
      event.preventDefault();
      this.#mark();
    });
  }

  /** @param {LogEvent} event */
  #add(event) {
    const atEnd = this.#lines.scrollHeight - this.#lines.scrollTop - this.#lines.clientHeight < kAtEnd_px;
    this.#lines.append(this.#makeLine(event));
    while (this.#lines.childElementCount > kLinesMost) this.#lines.firstElementChild.remove();
    if (atEnd) this.#toEnd();
    if (document.body.dataset.tab === "log" || !(kRank[event.severity] > 0)) return;
    ++this.#unread;
    if (kRank[event.severity] > kRank[this.#worst]) this.#worst = event.severity;
    this.#badge.hidden = false;
    this.#badge.dataset.severity = this.#worst;
    setText(this.#badge, String(this.#unread));
    this.#badge.setAttribute("aria-label", `${this.#unread} warnings or errors not read`);
  }

  /** @param {LogEvent} event */
  #makeLine(event) {
    const line = make("div", { class: "log-line", "data-severity": event.severity },
      make("time", { datetime: event.wall }, clock(event.wall)), make("span", { class: "log-severity" }, event.severity),
      make("span", { class: "log-part" }, event.part), make("span", { class: "log-text" }, event.text));
    line.hidden = !this.#matches(line);
    return line;
  }

  /** @param {HTMLElement} line */
  #matches(line) {
    const severe = (kRank[line.dataset.severity ?? "info"] ?? 0) >= kRank[this.#filter];
    return severe && (line.textContent ?? "").toLowerCase().includes(byId("log-search").value.toLowerCase());
  }

  #showMatching() {
    for (const line of this.#lines.children) line.hidden = !this.#matches(line);
    this.#toEnd();
  }

  #toEnd() {
    this.#lines.scrollTop = this.#lines.scrollHeight;
  }

  async #mark() {
    const text = byId("mark-text");
    const answer = await this.channel.ask({ do: "mark", text: text.value });
    if (answer.ok) text.value = "";
    const now = new Date().toISOString();
    this.#add({ t_s: 0, wall: now, severity: answer.ok ? "info" : "warning", part: "page", text: answer.ok ? "marked in the recording" : `mark: ${answer.error}` });
  }
}

/** @param {string} wall */
function clock(wall) {
  const date = new Date(wall);
  return Number.isNaN(date.getTime()) ? wall : date.toLocaleTimeString([], { hour12: false });
}
