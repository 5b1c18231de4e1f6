// The dialogs: sign-in, and the list of keys. They are not modal, because a modal one would block the emergency stop.

import { byId, setText } from "./dom.js";

/**
 * @param {HTMLDialogElement} dialog
 * @param {HTMLElement} [first] gets the focus
 */
function open(dialog, first) {
  if (!dialog.open) {
    const before = /** @type {HTMLElement | null} */ (document.activeElement);
    dialog.addEventListener("close", () => before?.focus(), { once: true });
    dialog.show();
  }
  (first ?? dialog.querySelector("button"))?.focus();
}

/** @param {HTMLDialogElement} dialog */
function prepare(dialog) {
  dialog.addEventListener("keydown", (event) => {
    if (event.key === "Escape") dialog.close();
  });
  for (const button of dialog.querySelectorAll("[data-close]")) button.addEventListener("click", () => dialog.close());
}

/**
 * Prepares both dialogs and the buttons that open them.
 * @param {import("./bus.js").Bus} bus
 * @param {import("./operator_channel.js").OperatorChannel} channel
 * @returns {() => void} opens the sign-in dialog
 */
export function setUpDialogs(bus, channel) {
  const keys = byId("keys");
  const signIn = byId("sign-in");
  const token = byId("token");
  const error = byId("sign-in-error");
  prepare(keys);
  prepare(signIn);
  byId("help").addEventListener("click", () => open(keys));
  const askForToken = () => {
    setText(error, "");
    open(signIn, token);
  };
  let mayWrite = false;
  const button = byId("session");
  bus.on("session", (session) => {
    mayWrite = session.mayWrite;
    setText(button, mayWrite ? "Sign out" : "Sign in");
    button.setAttribute("aria-haspopup", mayWrite ? "false" : "dialog");
  });
  button.addEventListener("click", () => (mayWrite ? channel.signOut() : askForToken()));
  byId("sign-in-form").addEventListener("submit", async (/** @type {Event} */ event) => {
    event.preventDefault();
    const refused = await channel.signIn(token.value);
    setText(error, refused);
    if (refused) {
      token.select();
      return;
    }
    token.value = "";
    signIn.close();
  });
  return askForToken;
}
