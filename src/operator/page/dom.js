// Short ways to the elements of index.html and to new ones.

/**
 * The element of this id; one that is missing is a mistake in index.html.
 * @param {string} id
 * @returns {any} any, because the caller knows which element it is
 */
export function byId(id) {
  const element = document.getElementById(id);
  if (!element) throw new Error(`index.html has no element with the id ${id}`);
  return element;
}

/**
 * A new element.
 * @param {string} tag
 * @param {Record<string, string>} [attributes]
 * @param {(Node | string)[]} children
 * @returns {any}
 */
export function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/**
 * Writes a text only when it differs, so that screen readers and the browser have nothing to do otherwise.
 * @param {Element} element
 * @param {string} text
 */
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/**
 * A number with a true minus sign, and without one for what is rounded to zero.
 * @param {number} value
 * @param {number} digits
 * @returns {string}
 */
export function signed(value, digits) {
  const text = Math.abs(value).toFixed(digits);
  return value < 0 && Number(text) !== 0 ? `−${text}` : text;
}

/**
 * A group of buttons of which one is chosen, with arrow keys.
 * @param {HTMLElement} group
 * @param {[string, string][]} choices value and label
 * @param {string} chosen
 * @param {(value: string) => void} choose
 */
export function makeSegments(group, choices, chosen, choose) {
  const buttons = choices.map(([value, label]) =>
    make("button", { type: "button", role: "radio", "data-value": value }, label));
  const select = (/** @type {string} */ value) => {
    for (const button of buttons) {
      const is = button.dataset.value === value;
      button.setAttribute("aria-checked", String(is));
      button.tabIndex = is ? 0 : -1;
    }
  };
  buttons.forEach((button, i) => {
    button.addEventListener("click", () => {
      select(button.dataset.value);
      choose(button.dataset.value);
    });
    button.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
      const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
      if (!step) return;
      event.preventDefault();
      const next = buttons[(i + step + buttons.length) % buttons.length];
      next.focus();
      next.click();
    });
  });
  group.replaceChildren(...buttons);
  select(chosen);
}

/**
 * Fits a canvas to its place on the screen, in device pixels.
 * @param {HTMLCanvasElement} canvas
 * @returns {number} device pixels for each CSS pixel
 */
export function fitCanvas(canvas) {
  const scale = window.devicePixelRatio || 1;
  const width = Math.round(canvas.clientWidth * scale);
  const height = Math.round(canvas.clientHeight * scale);
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  return scale;
}

/** @type {Map<string, string>} */
const colours = new Map();
document.addEventListener("themechange", () => colours.clear());

/**
 * A colour of base.css, as the chosen theme has it.
 * @param {string} name without the dashes
 * @returns {string}
 */
export function colour(name) {
  let value = colours.get(name);
  if (value === undefined) {
    value = getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
    colours.set(name, value);
  }
  return value;
}
