// One key of the configuration: its effect, value, range, and what differs from the file.

import { make, setText } from "./dom.js";

/** @typedef {import("./messages.js").Setting} Setting */

/**
 * A value as the configuration file writes it.
 * @param {any} value
 * @returns {string}
 */
export function written(value) {
  return typeof value === "string" ? `"${value}"` : Array.isArray(value) ? `[${value.map(written).join(", ")}]` : String(value);
}

/**
 * @param {Setting} setting
 * @returns {boolean} whether the value in use is another one than the file's
 */
export function differs(setting) {
  return written(setting.value) !== written(setting.file_value);
}

/**
 * The value that a person has typed.
 * @param {Setting} setting
 * @param {string} text
 * @returns {{value?: any, error?: string}}
 */
export function parsed(setting, text) {
  if (setting.type !== "number" && setting.type !== "integer") return { value: text };
  const number = Number(text.trim().replace(",", "."));
  if (text.trim() === "" || !Number.isFinite(number)) return { error: `${text || "nothing"} is no number` };
  if (setting.type === "integer" && !Number.isInteger(number)) return { error: `${text} is no whole number` };
  if ((setting.min !== null && number < setting.min) || (setting.max !== null && number > setting.max))
    return { error: `expected ${setting.min} … ${setting.max} ${setting.unit}`.trim() };
  return { value: number };
}

export class SettingRow {
  /**
   * @param {Setting} setting
   * @param {(key: string, value: any) => Promise<string>} set sends the value; gives the error, empty: done
   */
  constructor(setting, set) {
    this.setting = setting;
    this.set = set;
    this.input = setting.type === "boolean" ? this.#makeSwitch() : setting.choices ? this.#makeChoice(setting.choices) : this.#makeInput();
    this.marks = make("p", { class: "setting-marks" });
    this.error = make("p", { class: "setting-error", role: "alert" });
    const id = `setting-${setting.key}`;
    this.effect = make("p", { class: "setting-effect", id: `${id}-effect` }, setting.effect);
    this.input.setAttribute("aria-label", setting.key);
    this.input.setAttribute("aria-describedby", `${id}-effect`);
    this.element = make("div", { class: "setting", "data-key": setting.key },
      make("div", {}, make("h3", { class: "setting-name" }, setting.key), this.effect),
      make("div", {}, make("div", { class: "setting-value" }, this.input, make("span", { class: "setting-unit" }, setting.unit)),
        this.marks), this.error);
    this.show(setting, false);
  }

  #makeSwitch() {
    const button = make("button", { type: "button", role: "switch" });
    button.addEventListener("click", () => {
      if (button.getAttribute("aria-disabled") !== "true") this.#send(!this.setting.value);
    });
    return button;
  }

  /** @param {string[]} choices */
  #makeChoice(choices) {
    const select = make("select", {}, ...choices.map((choice) => make("option", { value: choice }, choice)));
    select.addEventListener("change", () => this.#send(select.value));
    return select;
  }

  #makeInput() {
    const isNumber = this.setting.type === "number" || this.setting.type === "integer";
    // No type="number": it hides what it cannot read, takes the wheel, and differs between languages.
    const input = make("input", { type: "text", class: isNumber ? "" : "wide", autocomplete: "off", spellcheck: "false",
      inputmode: isNumber ? "decimal" : "text" });
    input.addEventListener("change", () => {
      if (input.readOnly) return;
      const { value, error } = parsed(this.setting, input.value);
      if (error) this.#showError(error);
      else this.#send(value);
    });
    input.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
      if (event.key !== "Escape") return;
      input.value = shownValue(this.setting);
      this.#showError("");
    });
    return input;
  }

  /** @param {any} value */
  async #send(value) {
    this.#showError("");
    this.#showError(await this.set(this.setting.key, value));
  }

  /** @param {string} error */
  #showError(error) {
    setText(this.error, error);
    this.input.setAttribute("aria-invalid", String(error !== ""));
    if (error) this.element.scrollIntoView({ block: "nearest" });
  }

  /**
   * Shows new values of the same key. What a person is typing stays.
   * @param {Setting} setting
   * @param {boolean} mayWrite
   */
  show(setting, mayWrite) {
    this.setting = setting;
    const locked = !setting.live || !mayWrite;
    if (setting.type === "boolean") {
      this.input.setAttribute("aria-checked", String(setting.value));
      this.input.setAttribute("aria-disabled", String(locked));
      setText(this.input, setting.value ? "on" : "off");
    } else if (setting.choices) {
      this.input.value = setting.value;
      this.input.disabled = locked;
    } else {
      this.input.readOnly = locked;
      const typing = document.activeElement === this.input || this.error.textContent !== "";
      if (!typing || locked) this.input.value = shownValue(setting);
      if (locked) this.#showError("");
    }
    this.input.title = locked ? (setting.live ? "sign in to change it" : "change it in the file, then restart heeld") : "";
    this.element.dataset.changed = String(differs(setting));
    this.#showMarks(mayWrite);
  }

  /** @param {boolean} mayWrite */
  #showMarks(mayWrite) {
    const { setting } = this;
    const parts = [];
    if (setting.min !== null && setting.max !== null) parts.push(make("span", {}, `${setting.min} … ${setting.max}`));
    parts.push(make("span", { class: setting.live ? "mark-live" : "" }, setting.live ? "in use at once" : "after a restart"));
    if (setting.limit && setting.live) parts.push(make("span", { title: "a limit is never made looser than in the file while heeld runs" },
      setting.limit === "tighter-only" ? `only ${setting.safer ?? "tighter"} than the file` : "in the file only"));
    this.marks.replaceChildren(...parts.flatMap((part, i) => (i ? [" · ", part] : [part])));
    if (!differs(setting)) {
      if (written(setting.value) !== written(setting.default)) this.marks.append(` · default ${written(setting.default)}`);
      return;
    }
    this.marks.append(` · file ${written(setting.file_value)} `);
    if (!mayWrite) return;
    const undo = make("button", { type: "button", "aria-label": `${setting.key}: back to file` }, "back to file");
    undo.addEventListener("click", () => this.#send(setting.file_value));
    this.marks.append(undo);
  }
}

/** @param {Setting} setting */
function shownValue(setting) {
  return Array.isArray(setting.value) ? setting.value.join(", ") : String(setting.value);
}
