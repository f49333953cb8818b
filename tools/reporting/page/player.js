// Time: play and pause, slider, speed, keys.
"use strict";

const speeds = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];

class Player {
  constructor(app) {
    this.app = app;
    this.times = app.times;
    this.button = document.getElementById("play");
    this.slider = document.getElementById("time");
    this.label = document.getElementById("time-label");
    this.speed = document.getElementById("speed");
    this.loop = document.getElementById("loop");
    this.decimals = Math.max(
      ...this.times.map((time) => (String(Number(time.toPrecision(4))).split(".")[1] ?? "").length),
    );
    this.slider.max = this.times.length - 1;
    fillChoice(this.speed, speeds.map(String));
    for (const option of this.speed.options) option.textContent = `${option.value}×`;
    this.speed.value = String(this.fittingSpeed());
    this.button.addEventListener("click", () => this.toggle());
    this.slider.addEventListener("input", () => this.jump(this.times[this.slider.value]));
    document.getElementById("back").addEventListener("click", () => this.step(-1));
    document.getElementById("forth").addEventListener("click", () => this.step(1));
    document.addEventListener("keydown", (event) => this.key(event));
  }

  get end() {
    return this.times[this.times.length - 1];
  }

  /** Real time where that takes 3 to 20 s, else what takes about 8 s. */
  fittingSpeed() {
    const duration = this.end - this.times[0];
    if (duration >= 3 && duration <= 20) return 1;
    return speeds[nearest(speeds, (duration || 1) / 8)];
  }

  toggle() {
    this.app.playing ? this.pause() : this.play();
  }

  play() {
    if (this.times.length < 2) return;
    if (this.app.time >= this.end) this.app.time = this.times[0];
    this.app.playing = true;
    this.showState();
    let before = performance.now();
    const advance = (now) => {
      if (!this.app.playing) return;
      this.forward(((now - before) / 1000) * Number(this.speed.value));
      before = now;
      if (this.app.playing) requestAnimationFrame(advance);
    };
    requestAnimationFrame(advance);
  }

  forward(seconds) {
    const time = this.app.time + seconds;
    if (time < this.end) return this.app.setTime(time);
    if (this.loop.checked) return this.app.setTime(this.times[0]);
    this.app.setTime(this.end);
    this.pause();
  }

  /** Stands still on an output time: a picture that is looked at is never between two. */
  pause() {
    this.app.playing = false;
    this.showState();
    this.app.setTime(this.times[nearest(this.times, this.app.time)]);
  }

  jump(time) {
    this.app.playing = false;
    this.showState();
    this.app.setTime(this.times[nearest(this.times, time)]);
  }

  step(frames) {
    const at = nearest(this.times, this.app.time) + frames;
    this.jump(this.times[Math.min(Math.max(at, 0), this.times.length - 1)]);
  }

  showState() {
    this.button.textContent = this.app.playing ? "⏸" : "▶";
    this.button.setAttribute("aria-label", this.app.playing ? "pause" : "play");
  }

  showTime(time) {
    this.slider.value = nearest(this.times, time);
    const text = `t = ${time.toFixed(this.decimals)} s`;
    this.slider.setAttribute("aria-valuetext", text);
    this.label.textContent = text;
  }

  key(event) {
    const typing = event.target.closest("input, select") && !(event.target === this.slider && event.key === " ");
    const pressing = event.target.closest("button, summary") && event.key === " ";
    if (typing || pressing) return;
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    const { camera } = this.app;
    const pan = (x, y) => camera.shift(x, y);
    const actions = {
      " ": () => this.toggle(),
      ArrowRight: () => this.step(1),
      ArrowLeft: () => this.step(-1),
      Home: () => this.jump(this.times[0]),
      End: () => this.jump(this.end),
      "+": () => camera.zoomAt(1.25, [0, 0]),
      "=": () => camera.zoomAt(1.25, [0, 0]),
      "-": () => camera.zoomAt(0.8, [0, 0]),
      0: () => camera.reset(),
      w: () => pan(0, -0.05),
      a: () => pan(0.05, 0),
      s: () => pan(0, 0.05),
      d: () => pan(-0.05, 0),
      q: () => camera.orbit(0.1, 0),
      e: () => camera.orbit(-0.1, 0),
      r: () => camera.orbit(0, 0.1),
      f: () => camera.orbit(0, -0.1),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
    this.app.changed();
  }
}
