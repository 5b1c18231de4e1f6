// The emergency stop. It has its own request, waits for no other one, and goes out over two connections.

import { byId, setText } from "./dom.js";

const kAttempt_ms = 400;
const kPause_ms = 150;
const kAttempts = 12;
/** So long after the press without an answer, and the page says that the stop is not confirmed. */
const kUnconfirmed_ms = 700;

/**
 * Whether the space bar writes a space here. In a field for a number it has no use, and stops the robot.
 * @param {EventTarget | null} target
 * @returns {boolean}
 */
export function writesText(target) {
  if (target instanceof HTMLTextAreaElement) return true;
  if (target instanceof HTMLElement && target.isContentEditable) return true;
  return target instanceof HTMLInputElement && ["text", "search", "password"].includes(target.type) &&
    target.inputMode !== "decimal" && !target.readOnly;
}

export class EmergencyStop {
  #button = byId("estop");
  #word = /** @type {HTMLElement} */ (this.#button.querySelector(".estop-word"));
  #press = 0;
  #confirmed = true;

  /**
   * @param {import("./bus.js").Bus} bus
   * @param {import("./operator_channel.js").OperatorChannel} channel
   * @param {import("./banner.js").Banner} banner
   */
  constructor(bus, channel, banner) {
    this.channel = channel;
    this.banner = banner;
    // pointerdown, not click: a finger that slips off the button has stopped the robot.
    this.#button.addEventListener("pointerdown", () => this.press());
    this.#button.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
      if (event.key === "Enter" && !event.repeat) this.press();
    });
    // A click without a pointer: of a screen reader or a voice command.
    this.#button.addEventListener("click", (/** @type {PointerEvent} */ event) => {
      if (event.detail === 0 && this.#confirmed) this.press();
    });
    this.#listenToSpaceBar();
    bus.on("tick", (/** @type {import("./messages.js").Tick} */ tick) => {
      const stopped = tick.state === "emergency";
      if (stopped) this.#confirm(this.#press);
      this.#show(stopped ? "Emergency stop is on" : "Emergency stop");
    });
  }

  /** Stops the robot. A further press is a further request. */
  press() {
    const press = ++this.#press;
    this.#confirmed = false;
    this.channel.tellEmergencyStop();
    this.#post(press);
    this.#show("Stopping …");
    setTimeout(() => {
      if (!this.#confirmed && press === this.#press) this.banner.emergencyStopUnconfirmed(true);
    }, kUnconfirmed_ms);
  }

  /** @param {number} press */
  async #post(press) {
    for (let attempt = 0; attempt < kAttempts && !this.#confirmed && press === this.#press; ++attempt) {
      try {
        const answer = await fetch("/estop", {
          method: "POST", cache: "no-store", keepalive: true, signal: AbortSignal.timeout(kAttempt_ms) });
        if (answer.ok) {
          this.#confirm(press);
          return;
        }
      } catch {
        // No answer in time, or no connection: the next attempt follows.
      }
      await new Promise((done) => setTimeout(done, kPause_ms));
    }
  }

  /** @param {number} press */
  #confirm(press) {
    if (this.#confirmed || press !== this.#press) return;
    this.#confirmed = true;
    this.banner.emergencyStopUnconfirmed(false);
  }

  /** @param {string} word */
  #show(word) {
    const shown = this.#confirmed ? word : "Stopping …";
    setText(this.#word, shown);
    this.#button.dataset.sent = String(shown !== "Emergency stop");
  }

  #listenToSpaceBar() {
    // Before any other listener, so that no button takes the key.
    const swallow = (/** @type {KeyboardEvent} */ event) => {
      if (event.code !== "Space" || writesText(event.target)) return false;
      event.preventDefault();
      event.stopImmediatePropagation();
      return true;
    };
    window.addEventListener("keydown", (event) => {
      if (swallow(event) && !event.repeat) this.press();
    }, { capture: true });
    window.addEventListener("keyup", swallow, { capture: true });
    // After the field's own listener, which takes back what was typed: leaving the field would send it.
    window.addEventListener("keydown", (event) => {
      if (event.key === "Escape" && event.target instanceof HTMLInputElement) event.target.blur();
    });
    const key = byId("estop-key");
    document.addEventListener("focusin", (event) => setText(key, writesText(event.target) ? "Esc, then space bar" : "space bar"));
    document.addEventListener("focusout", () => setText(key, "space bar"));
  }
}
