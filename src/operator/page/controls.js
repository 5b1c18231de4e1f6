// Start, stop, reset and the sign that the operator watches.

import { kPlain, kSignIn, whyNot } from "./control_rules.js";
import { byId, setText } from "./dom.js";

const kAlive_ms = 500;
const kNote_ms = 6000;
/** @type {["start", "stop", "reset"]} */
const kCommands = ["start", "stop", "reset"];

export class Controls {
  #note = byId("control-note");
  #alive = byId("alive");
  #noteUntil_ms = 0;

  /**
   * @param {import("./bus.js").Bus} bus
   * @param {import("./operator_channel.js").OperatorChannel} channel
   * @param {() => void} askForToken opens the sign-in dialog
   */
  constructor(bus, channel, askForToken) {
    this.bus = bus;
    this.channel = channel;
    this.askForToken = askForToken;
    for (const command of kCommands) byId(command).addEventListener("click", () => this.#press(command));
    for (const name of ["tick", "session", "info", "old"]) bus.on(name, () => this.#update());
    this.#alive.addEventListener("click", () => {
      const on = this.#alive.getAttribute("aria-checked") !== "true";
      this.#alive.setAttribute("aria-checked", String(on));
      this.#sendAlive();
    });
    bus.on("config", (/** @type {{keys: import("./messages.js").Setting[]}} */ config) => {
      this.#alive.hidden = !(config.keys.find((key) => key.key === "supervisor.operator_timeout_s")?.value > 0);
    });
    setInterval(() => this.#sendAlive(), kAlive_ms);
  }

  /** Only while somebody can see the page: a tab in the background is no operator who watches. */
  #sendAlive() {
    const on = this.#alive.getAttribute("aria-checked") === "true" && !this.#alive.hidden;
    if (on && document.visibilityState === "visible" && this.bus.newest("session").mayWrite) this.channel.ask({ do: "alive" });
  }

  /** @param {"start" | "stop" | "reset"} command */
  #why(command) {
    return whyNot(command, { ...this.bus.newest("session"), hasToken: this.bus.newest("info")?.has_token !== false,
      old: this.bus.newest("old") ?? true, tick: this.bus.newest("tick") });
  }

  /** @param {"start" | "stop" | "reset"} command */
  async #press(command) {
    const why = this.#why(command);
    if (why === kSignIn) {
      this.askForToken();
      return;
    }
    const name = command.charAt(0).toUpperCase() + command.slice(1);
    if (why) {
      this.#say(`${name}: ${why}.`, true);
      return;
    }
    const answer = await this.channel.ask({ do: command });
    if (answer.ok) this.#say(answer.outcome === "already so" ? `${name}: nothing to change.` : "", false);
    else this.#say(`${name}: ${answer.error}.`, true);
  }

  /**
   * @param {string} text
   * @param {boolean} bad
   */
  #say(text, bad) {
    setText(this.#note, text);
    this.#note.dataset.level = bad ? "bad" : "";
    this.#noteUntil_ms = text ? performance.now() + kNote_ms : 0;
    this.#update();
  }

  #update() {
    const refusals = new Map();
    for (const command of kCommands) {
      const why = this.#why(command);
      const button = byId(command);
      button.setAttribute("aria-disabled", String(why !== "" && why !== kSignIn));
      button.dataset.ready = String(why === "");
      button.title = why ? `${command}: ${why}` : "";
      if (why) refusals.set(why, [...(refusals.get(why) ?? []), command]);
    }
    if (performance.now() < this.#noteUntil_ms) return;
    this.#note.dataset.level = "";
    const told = [...refusals].filter(([why]) => !kPlain.has(why));
    setText(this.#note, told.map(([why, commands]) => `${listed(commands)}: ${why}.`).join(" "));
  }
}

/**
 * @param {string[]} names
 * @returns {string} "Start, stop and reset"
 */
function listed(names) {
  const all = names.length > 1 ? `${names.slice(0, -1).join(", ")} and ${names[names.length - 1]}` : names[0];
  return all.charAt(0).toUpperCase() + all.slice(1);
}
