// The tabs: live (only where it does not stand beside them), plots, settings, log.

import { byId } from "./dom.js";
import { writesText } from "./estop.js";

const kTabs = ["live", "plots", "settings", "log"];

/**
 * @param {import("./bus.js").Bus} bus gets tab: the name of the tab that is shown
 */
export function setUpTabs(bus) {
  const narrow = matchMedia("(max-width: 699px), (max-height: 560px)");
  const show = (/** @type {string} */ name) => {
    const shown = !narrow.matches && name === "live" ? "plots" : name;
    document.body.dataset.tab = shown;
    for (const tab of kTabs) {
      const button = byId(`tab-${tab}`);
      button.setAttribute("aria-selected", String(tab === shown));
      button.tabIndex = tab === shown ? 0 : -1;
    }
    bus.emit("tab", shown);
  };
  kTabs.forEach((name) => {
    const button = byId(`tab-${name}`);
    button.addEventListener("click", () => show(name));
    button.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!step) return;
      event.preventDefault();
      const tabs = narrow.matches ? kTabs : kTabs.slice(1);
      const next = tabs[(tabs.indexOf(name) + step + tabs.length) % tabs.length];
      show(next);
      byId(`tab-${next}`).focus();
    });
  });
  document.addEventListener("keydown", (event) => {
    if (writesText(event.target) || event.target instanceof HTMLInputElement) return;
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const tab = kTabs[Number(event.key) - 1];
    if (tab) show(tab);
    if (event.key === "/") {
      event.preventDefault();
      if (document.body.dataset.tab !== "log") show("settings");
      byId(document.body.dataset.tab === "log" ? "log-search" : "setting-search").focus();
    }
  });
  narrow.addEventListener("change", () => show(narrow.matches ? "live" : /** @type {string} */ (document.body.dataset.tab)));
  show(narrow.matches ? "live" : "plots");
}
