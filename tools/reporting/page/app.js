// Everything together: one time, one field, one camera for all runs.
"use strict";

class App {
  constructor() {
    this.camera = new Camera();
    this.painter = new Painter();
    this.theme = readTheme();
    this.playing = false;
    this.slice = null;
    this.times = timesOf(report.runs);
    this.time = this.times[0] ?? 0;
    this.plots = new Plots(this);
  }

  shownRuns() {
    return report.runs.filter((run) => run.particles);
  }

  async start() {
    followTheme(() => this.rethemed());
    const histories = await Promise.all(report.runs.map((run) => (run.history ? loadHistory(run.history) : null)));
    if (this.shownRuns().length) await this.showParticles();
    if (report.plots.length) this.plots.show(histories);
    document.documentElement.dataset.ready = "yes";
  }

  async showParticles() {
    const particles = this.shownRuns().map((run) => new Particles(run));
    for (const each of particles) await each.loadPlaces();
    this.panels = particles.map((each) => new Panel(each, this));
    document.getElementById("panels").replaceChildren(...this.panels.map((panel) => panel.element));
    this.colourBar = new ColourBar(this);
    this.player = new Player(this);
    this.strip = new Strip(this, report.strip);
    offerSlices(this);
    document.getElementById("reset").addEventListener("click", () => this.resetCamera());
    document
      .getElementById("save")
      .addEventListener("click", () => savePicture(this.panels, this.theme, this.player.label.textContent));
    const names = [...this.colourBar.fields.keys()];
    document
      .getElementById("particles")
      .classList.toggle("wide-run", this.panels.length === 1 && isWide(this.panels[0].run));
    await this.colourBar.chooseField(names[0]);
    for (const panel of this.panels) panel.resize();
    this.setTime(this.time);
  }

  async loadField(name) {
    for (const { particles } of this.panels) await particles.load(name);
  }

  look() {
    return {
      camera: this.camera,
      painter: this.painter,
      theme: this.theme,
      field: this.field,
      range: this.range,
      slice: this.slice,
      smooth: this.playing,
      scale: true,
    };
  }

  setTime(time) {
    this.time = time;
    this.player?.showTime(time);
    this.strip?.showTime(time);
    this.plots.showTime(time);
    if (this.playing) this.drawPanels();
    else this.changed();
  }

  resetCamera() {
    this.camera.reset();
    this.changed();
  }

  /** Draws before the screen is next shown, once, however many changes there were. */
  changed() {
    this.due ??= requestAnimationFrame(() => {
      this.due = undefined;
      this.drawPanels();
    });
  }

  drawPanels() {
    if (!this.range) return;
    for (const panel of this.panels) panel.draw();
  }

  recoloured() {
    if (!this.range) return;
    this.changed();
    this.strip.draw();
  }

  rethemed() {
    this.theme = readTheme();
    if (this.panels) this.recoloured();
    if (this.plots.histories) this.plots.redraw();
  }
}

/** Too wide to leave room next to it. */
function isWide(run) {
  const [across, up] = extentOf(run);
  return across > 1.7 * up;
}

/** All output times of all runs; those that differ by rounding are one. */
function timesOf(runs) {
  const all = runs.flatMap((run) => (run.particles ? run.times : [])).sort((a, b) => a - b);
  const near = 1e-6 * (all[all.length - 1] ?? 0);
  return all.filter((time, k) => k === 0 || time - all[k - 1] > near);
}

/** In 3-D: which slab is shown. */
function offerSlices(app) {
  const holder = document.getElementById("slice-controls");
  holder.hidden = !app.shownRuns().some((run) => run.dimension === 3);
  const axis = document.getElementById("slice-axis"),
    at = document.getElementById("slice-at");
  const change = () => {
    app.slice = axis.value === "none" ? null : { axis: "xyz".indexOf(axis.value), at: Number(at.value) };
    at.disabled = app.slice === null;
    app.changed();
    app.strip.draw();
  };
  for (const control of [axis, at]) control.addEventListener("input", change);
}

/** Downloads the panels, side by side, as a PNG. */
function savePicture(panels, theme, name) {
  const canvas = document.createElement("canvas");
  canvas.width = panels.reduce((sum, panel) => sum + panel.canvas.width, 0);
  canvas.height = Math.max(...panels.map((panel) => panel.canvas.height));
  const context = canvas.getContext("2d");
  context.fillStyle = theme.canvas;
  context.fillRect(0, 0, canvas.width, canvas.height);
  let left = 0;
  for (const panel of panels) {
    context.drawImage(panel.canvas, left, 0);
    left += panel.canvas.width;
  }
  const link = document.createElement("a");
  link.download = `${document.title}, ${name}.png`;
  link.href = canvas.toDataURL("image/png");
  link.click();
}

const app = new App();
app.start().catch((problem) => {
  const box = document.getElementById("problem");
  box.hidden = false;
  box.textContent =
    typeof DecompressionStream === "undefined"
      ? "This browser cannot unpack the results; Firefox 113, Chromium 80 and Safari 16.4 have the DecompressionStream."
      : `The page failed: ${problem.message}`;
  console.error(problem);
});
