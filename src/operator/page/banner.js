// The full-width banner: an emergency stop that nobody has confirmed, or a lost connection.

import { byId, setText } from "./dom.js";

/** So long without news, and what the page shows counts as old. */
export const kOld_ms = 1000;
const kUpdate_ms = 100;

export class Banner {
  #banner = byId("banner");
  #unconfirmed = false;
  #wasOld = false;

  /**
   * @param {import("./bus.js").Bus} bus gets old: true or false
   * @param {import("./live_connection.js").LiveConnection} live
   */
  constructor(bus, live) {
    this.bus = bus;
    this.live = live;
    this.#banner.setAttribute("aria-atomic", "false");
    setInterval(() => this.#update(), kUpdate_ms);
  }

  /**
   * Says that no answer to an emergency stop has come.
   * @param {boolean} unconfirmed
   */
  emergencyStopUnconfirmed(unconfirmed) {
    this.#unconfirmed = unconfirmed;
    this.#update();
  }

  #update() {
    const age_ms = performance.now() - this.live.news_ms;
    const old = age_ms > kOld_ms;
    if (old !== this.#wasOld || this.bus.newest("old") === undefined) {
      this.#wasOld = old;
      document.body.dataset.old = String(old);
      this.bus.emit("old", old);
    }
    this.#banner.hidden = !old && !this.#unconfirmed;
    if (this.#banner.hidden) {
      this.#banner.replaceChildren();
      return;
    }
    this.#show(old, age_ms);
  }

  /**
   * The sentence is announced once; the time beside it, which changes all the time, is not.
   * @param {boolean} old
   * @param {number} age_ms
   */
  #show(old, age_ms) {
    if (!this.#banner.firstChild) {
      const sentence = document.createElement("span");
      const time = document.createElement("span");
      time.setAttribute("aria-hidden", "true");
      this.#banner.append(sentence, time);
    }
    const [sentence, time] = this.#banner.children;
    const lost = old ? "Connection lost: what you see is old, and nothing of this page reaches the robot. Use the robot's STOP button. " : "";
    const stop = this.#unconfirmed ? "The emergency stop is not confirmed: use the robot's STOP button. " : "";
    setText(sentence, stop + (stop && old ? "" : lost));
    setText(time, old ? `Last news ${duration(age_ms)} ago.` : "");
  }
}

/**
 * @param {number} time_ms
 * @returns {string}
 */
export function duration(time_ms) {
  const time_s = time_ms / 1000;
  if (time_s < 60) return `${time_s.toFixed(1)} s`;
  if (time_s < 3600) return `${Math.floor(time_s / 60)} min ${Math.floor(time_s % 60)} s`;
  return `${Math.floor(time_s / 3600)} h ${Math.floor((time_s % 3600) / 60)} min`;
}
