// Light and dark: as the system says, until the button is pressed.
"use strict";

const darkSystem = window.matchMedia("(prefers-color-scheme: dark)");

/** The attribute that page.css looks at. */
function setTheme(dark) {
  document.documentElement.dataset.theme = dark ? "dark" : "light";
}

setTheme(darkSystem.matches);

const curveCount = 7; // colours of runs and curves; further ones are dashed

/** Colours of page.css for what is drawn on canvases. */
function readTheme() {
  const style = getComputedStyle(document.documentElement);
  const colour = (name) => style.getPropertyValue(`--${name}`).trim();
  const names = ["canvas", "wall", "faint", "solid", "ink", "grid", "reference"];
  const curves = Array.from({ length: curveCount }, (_, k) => colour(`curve-${k}`));
  return { ...Object.fromEntries(names.map((name) => [name, colour(name)])), curves };
}

function followTheme(changed) {
  const change = (dark) => {
    setTheme(dark);
    changed();
  };
  const follow = () => change(darkSystem.matches);
  darkSystem.addEventListener("change", follow);
  document.getElementById("theme").addEventListener("click", () => {
    darkSystem.removeEventListener("change", follow);
    change(document.documentElement.dataset.theme !== "dark");
  });
}
