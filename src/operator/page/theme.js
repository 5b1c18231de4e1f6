// Dark or light, before anything is drawn: a classic script, because modules run after the first paint.
"use strict";
{
  const kThemes = ["auto", "light", "dark"];
  const darkWanted = matchMedia("(prefers-color-scheme: dark)");
  let choice = "auto";
  try {
    choice = localStorage.getItem("heel.theme") ?? "auto";
  } catch {
    // Storage may be forbidden; the system's choice then counts.
  }
  if (!kThemes.includes(choice)) choice = "auto";

  const apply = () => {
    const dark = choice === "dark" || (choice === "auto" && darkWanted.matches);
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    const button = document.getElementById("theme");
    if (button) {
      button.textContent = `Theme: ${choice}`;
    }
    document.dispatchEvent(new Event("themechange"));
  };
  const next = () => {
    choice = kThemes[(kThemes.indexOf(choice) + 1) % kThemes.length];
    try {
      localStorage.setItem("heel.theme", choice);
    } catch {
      // It then lasts until the page is loaded again.
    }
    apply();
  };
  apply();
  darkWanted.addEventListener("change", apply);
  document.addEventListener("DOMContentLoaded", () => {
    document.getElementById("theme")?.addEventListener("click", next);
    apply();
  });
}
