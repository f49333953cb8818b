// A few moments side by side, a row per run; a click goes there.
"use strict";

class Strip {
  constructor(app, times) {
    this.app = app;
    this.element = document.getElementById("strip");
    this.frames = times.map((time) => this.frame(time));
    this.more = document.getElementById("pin");
    this.more.addEventListener("click", () => this.pin(this.app.time));
    this.show();
    new ResizeObserver(() => this.draw()).observe(this.element);
  }

  show() {
    this.element.replaceChildren(...this.frames.map((frame) => frame.button));
    this.showTime(this.app.time);
  }

  /** Takes up a moment that is not there yet. */
  pin(time) {
    if (this.frames.some((frame) => frame.time === time)) return;
    this.frames = [...this.frames, this.frame(time)].sort((a, b) => a.time - b.time);
    this.show();
    this.draw();
  }

  frame(time) {
    const button = document.createElement("button");
    button.type = "button";
    const canvases = this.app.panels.map((panel) => {
      const canvas = document.createElement("canvas");
      const [wide, high] = extentOf(panel.run);
      canvas.style.aspectRatio = `${wide} / ${high}`;
      return canvas;
    });
    const caption = document.createElement("span");
    caption.textContent = `${shown(time)} s`;
    button.append(...canvases, caption);
    button.setAttribute("aria-label", `go to ${shown(time)} s`);
    button.addEventListener("click", () => this.app.player.jump(time));
    return { time, button, canvases };
  }

  /** Seen as at the start, whatever was turned or zoomed since. */
  draw() {
    if (!this.app.range) return;
    const look = { ...this.app.look(), camera: new Camera(), smooth: false, scale: false };
    const pixels = devicePixels();
    for (const { time, canvases } of this.frames) {
      canvases.forEach((canvas, k) => {
        const { clientWidth: width, clientHeight: height } = canvas;
        if (!width || !height) return;
        Object.assign(canvas, { width: Math.round(width * pixels), height: Math.round(height * pixels) });
        drawRun(canvas.getContext("2d"), width, height, this.app.panels[k].particles, time, look);
      });
    }
  }

  showTime(time) {
    this.frames.forEach(({ button, time: own }) => {
      const current = Math.abs(own - time) < 1e-6 * (1 + Math.abs(own));
      if (button.classList.contains("current") !== current) button.classList.toggle("current", current);
    });
  }
}
