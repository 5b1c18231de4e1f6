// Messages from one part of the page to the others, by name. The newest of each is kept.

export class Bus {
  /** @type {Map<string, ((value: any) => void)[]>} */
  #listeners = new Map();
  /** @type {Map<string, any>} */
  #newest = new Map();

  /**
   * Calls `listener` for each message of this name, and at once for the newest if there is one.
   * @param {string} name
   * @param {(value: any) => void} listener
   */
  on(name, listener) {
    const listeners = this.#listeners.get(name) ?? [];
    this.#listeners.set(name, [...listeners, listener]);
    if (this.#newest.has(name)) listener(this.#newest.get(name));
  }

  /**
   * @param {string} name
   * @param {any} value
   */
  emit(name, value) {
    this.#newest.set(name, value);
    for (const listener of this.#listeners.get(name) ?? []) listener(value);
  }

  /**
   * The newest message of this name.
   * @param {string} name
   * @returns {any} undefined: none yet
   */
  newest(name) {
    return this.#newest.get(name);
  }
}
