// The settings: found by search, set while the robot runs, undone, and saved to the file.

import { byId, make, makeSegments, setText } from "./dom.js";
import { differs, SettingRow, written } from "./setting_row.js";

/** @typedef {import("./messages.js").Setting} Setting */

/** The sections that change how it follows come first; the others stay in the order of the file. */
const kFirst = ["control", "gate", "supervisor", "estimate"];
/** @type {[string, string][]} */
const kFilters = [["live", "Live"], ["changed", "Changed"], ["all", "All"]];
const kUndoMost = 50;

export class SettingsView {
  /** @type {Map<string, SettingRow>} */
  #rows = new Map();
  /** @type {{key: string, value: any}[]} */
  #undo = [];
  #filter = "live";
  #file = "the file";

  /**
   * @param {import("./bus.js").Bus} bus
   * @param {import("./operator_channel.js").OperatorChannel} channel
   * @param {() => Promise<void>} reload reads the values again
   */
  constructor(bus, channel, reload) {
    this.bus = bus;
    this.channel = channel;
    this.reload = reload;
    makeSegments(byId("setting-filter"), kFilters, this.#filter, (value) => {
      this.#filter = value;
      this.#showMatching();
    });
    byId("setting-search").addEventListener("input", () => this.#showMatching());
    byId("setting-undo").addEventListener("click", () => this.#undoLast());
    byId("setting-save").addEventListener("click", () => this.#save());
    bus.on("config", (config) => this.#take(config));
    bus.on("session", () => this.#showAll());
  }

  get #settings() {
    return /** @type {Setting[]} */ (this.bus.newest("config")?.keys ?? []);
  }

  get #mayWrite() {
    return Boolean(this.bus.newest("session")?.mayWrite);
  }

  /** @param {{file: string, keys: Setting[]}} config */
  #take(config) {
    this.#file = config.file;
    if (this.#rows.size !== config.keys.length || config.keys.some(({ key }) => !this.#rows.has(key))) this.#build(config.keys);
    this.#showAll();
  }

  /** @param {Setting[]} settings */
  #build(settings) {
    this.#rows.clear();
    const sections = [...new Set([...kFirst, ...settings.map(({ section }) => section)])];
    const parts = sections.map((section) => {
      const rows = settings.filter((setting) => setting.section === section).map((setting) => {
        const row = new SettingRow(setting, (key, value) => this.#set(key, value, true));
        this.#rows.set(setting.key, row);
        return row.element;
      });
      return make("section", { "data-section": section }, make("h2", { class: "setting-section" }, section), ...rows);
    });
    byId("setting-list").replaceChildren(...parts, make("p", { class: "setting-empty", id: "setting-empty", hidden: "" }));
  }

  #showAll() {
    for (const setting of this.#settings) this.#rows.get(setting.key)?.show(setting, this.#mayWrite);
    this.#showMatching();
    this.#showFoot();
  }

  #showMatching() {
    const words = String(byId("setting-search").value).toLowerCase().split(/\s+/).filter(Boolean);
    let count = 0;
    for (const setting of this.#settings) {
      const text = `${setting.key} ${setting.effect}`.toLowerCase();
      const filtered = this.#filter === "all" || (this.#filter === "live" ? setting.live : differs(setting));
      const matches = filtered && words.every((word) => text.includes(word));
      const row = this.#rows.get(setting.key);
      if (row) row.element.hidden = !matches;
      count += Number(matches);
    }
    for (const section of byId("setting-list").querySelectorAll("section"))
      section.hidden = !section.querySelector(".setting:not([hidden])");
    const empty = document.getElementById("setting-empty");
    if (!empty) return;
    empty.hidden = count > 0;
    setText(empty, this.#filter === "changed" && words.length === 0 ? `Every value is as in ${this.#file}.` : "No key matches.");
  }

  #showFoot() {
    const changed = this.#settings.filter(differs);
    const names = changed.map(({ key, value, file_value }) => `${key} ${written(file_value)} → ${written(value)}`).join("; ");
    setText(byId("setting-changes"), this.#mayWrite
      ? (changed.length ? `Not saved: ${names}` : `All as in ${this.#file}`)
      : "Sign in to change settings.");
    byId("setting-changes").title = names;
    this.#enable("setting-save", changed.length === 0 ? "nothing differs from the file" : "");
    this.#enable("setting-undo", this.#undo.length === 0 ? "nothing was set from this page" : "");
    setText(byId("setting-save"), changed.length ? `Save ${changed.length} to file` : "Save to file");
  }

  /**
   * @param {string} id
   * @param {string} why empty: it works
   */
  #enable(id, why) {
    const refused = this.#mayWrite ? why : "sign in first";
    byId(id).setAttribute("aria-disabled", String(refused !== ""));
    byId(id).title = refused;
  }

  /**
   * @param {string} key
   * @param {any} value
   * @param {boolean} canBeUndone
   * @returns {Promise<string>} the error; empty: done
   */
  async #set(key, value, canBeUndone) {
    const before = this.#settings.find((setting) => setting.key === key)?.value;
    if (written(before) === written(value)) return "";
    const answer = await this.channel.ask({ do: "set", values: { [key]: value } });
    if (!answer.ok) return String(answer.error).replace(`${key}: `, "");
    if (canBeUndone) this.#undo = [...this.#undo, { key, value: before }].slice(-kUndoMost);
    this.#say(`${key} is ${written(value)}`);
    await this.reload();
    return "";
  }

  async #undoLast() {
    if (byId("setting-undo").getAttribute("aria-disabled") === "true") return;
    const last = this.#undo.pop();
    if (!last) return;
    const error = await this.#set(last.key, last.value, false);
    this.#say(error ? `${last.key}: ${error}` : `${last.key} is ${written(last.value)} again`);
    this.#showFoot();
  }

  async #save() {
    if (byId("setting-save").getAttribute("aria-disabled") === "true") return;
    const answer = await this.channel.ask({ do: "save" });
    this.#say(answer.ok ? `Saved ${answer.changes.length} to ${this.#file}` : String(answer.error));
    if (answer.ok) this.#undo = [];
    await this.reload();
    this.#showFoot();
  }

  /** @param {string} text */
  #say(text) {
    setText(byId("setting-note"), text);
  }
}
