// Light and dark: as the system says, until the button is pressed.
"use strict";

const darkSystem = window.matchMedia("(prefers-color-scheme: dark)");

const isDark = () => (document.documentElement.dataset.theme ?? (darkSystem.matches ? "dark" : "light")) === "dark";

/** Colours of page.css for what is drawn on canvases. */
function readTheme() {
  const style = getComputedStyle(document.documentElement);
  const colour = (name) => style.getPropertyValue(`--${name}`).trim();
  return Object.fromEntries(
    ["canvas", "wall", "faint", "ink", "grid", "reference"].map((name) => [name, colour(name)]),
  );
}

function followTheme(changed) {
  darkSystem.addEventListener("change", changed);
  document.getElementById("theme").addEventListener("click", () => {
    document.documentElement.dataset.theme = isDark() ? "light" : "dark";
    changed();
  });
}
