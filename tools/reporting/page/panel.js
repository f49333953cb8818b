// The picture of one run: its canvas, what the pointer does there, what is said below.
"use strict";

class Panel {
  constructor(particles, app) {
    Object.assign(this, { particles, app, run: particles.run });
    this.element = cloneTemplate("panel");
    this.canvas = this.element.querySelector("canvas");
    this.tip = this.element.querySelector(".tip");
    this.note = this.element.querySelector(".note");
    this.element.querySelector(".name").textContent = this.run.label;
    this.canvas.setAttribute(
      "aria-label",
      `Particles of ${this.run.label}. ${document.getElementById("keys").textContent}`,
    );
    this.context = this.canvas.getContext("2d");
    const [wide, high] = extentOf(this.run);
    this.canvas.style.aspectRatio = `${wide} / ${high}`;
    this.canvas.classList.toggle("space", this.run.dimension === 3);
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    this.listen();
  }

  resize() {
    const pixels = devicePixels();
    this.width = this.canvas.clientWidth;
    this.height = this.canvas.clientHeight;
    const [width, height] = [this.width, this.height].map((size) => Math.max(1, Math.round(size * pixels)));
    if (this.canvas.width === width && this.canvas.height === height) return;
    Object.assign(this.canvas, { width, height });
    this.app.changed();
  }

  draw() {
    if (!this.width) return;
    const { time } = this.app;
    this.projection = drawRun(this.context, this.width, this.height, this.particles, time, this.app.look());
    this.describe(time);
  }

  /** What is drawn over the particles now, and if the run has no output at this time. */
  describe(time) {
    const parts = [];
    const reference = referenceAt(this.run, time);
    if (reference) parts.push(["―", `${reference.curves.name} at ${shown(reference.curves.time)} s`]);
    else if (this.run.references.length)
      parts.push(["", `${this.run.references[0].name} at ${this.referenceTimes()} s`]);
    if (this.run.surfaces) parts.push(["", "line: the surface of the liquid"]);
    if (this.run.corners) parts.push(["×", "where the corners are in theory: in free flight"]);
    const { counts, changes } = this.run.particles;
    if (changes) parts.push(["", `${counts[this.particles.frameAt(time)]} particles`]);
    const last = this.run.times[this.run.times.length - 1];
    if (time > last * (1 + 1e-6)) parts.push(["", `ended at ${shown(last)} s`]);
    const text = parts.flat().join();
    if (text === this.described) return;
    this.described = text;
    this.note.replaceChildren(
      ...parts.map(([mark, words]) => {
        const part = document.createElement("span");
        const symbol = document.createElement("i");
        symbol.textContent = mark;
        part.append(symbol, ` ${words}  `);
        return part;
      }),
    );
  }

  referenceTimes() {
    return this.run.references.map((curves) => shown(curves.time)).join(", ");
  }

  listen() {
    const held = new Map(); // pointers that are down
    const local = (event) => {
      const edge = this.canvas.getBoundingClientRect();
      return [event.clientX - edge.left, event.clientY - edge.top];
    };
    this.canvas.addEventListener("pointerdown", (event) => {
      held.set(event.pointerId, local(event));
      this.canvas.setPointerCapture(event.pointerId);
      this.tip.hidden = true;
    });
    this.canvas.addEventListener("pointermove", (event) => {
      const at = local(event);
      if (held.size === 0) this.point(at);
      else if (held.has(event.pointerId)) this.drag(held, event, at);
    });
    for (const name of ["pointerup", "pointercancel"]) {
      this.canvas.addEventListener(name, (event) => held.delete(event.pointerId));
    }
    this.canvas.addEventListener("pointerleave", () => (this.tip.hidden = true));
    this.canvas.addEventListener("dblclick", () => this.app.resetCamera());
    this.canvas.addEventListener("wheel", (event) => this.wheel(event, local(event)), { passive: false });
  }

  drag(held, event, at) {
    const { camera } = this.app;
    const from = held.get(event.pointerId);
    const moved = [(at[0] - from[0]) / this.width, (at[1] - from[1]) / this.width];
    if (held.size > 1) {
      const other = [...held].find(([id]) => id !== event.pointerId)[1];
      const spread = (a) => Math.hypot(a[0] - other[0], a[1] - other[1]);
      camera.zoomAt(
        spread(at) / Math.max(spread(from), 1),
        this.fromMiddle([(at[0] + other[0]) / 2, (at[1] + other[1]) / 2]),
      );
      camera.shift(moved[0] / 2, -moved[1] / 2);
    } else if (this.run.dimension === 3 && !event.shiftKey && event.buttons !== 2) {
      camera.orbit(-moved[0] * Math.PI, moved[1] * Math.PI);
    } else {
      camera.shift(moved[0], -moved[1]);
    }
    held.set(event.pointerId, at);
    this.app.changed();
  }

  /** Scrolls the page, unless the picture has the focus. */
  wheel(event, at) {
    if (document.activeElement !== this.canvas && !event.ctrlKey) return;
    event.preventDefault();
    this.app.camera.zoomAt(Math.exp(-0.0015 * event.deltaY), this.fromMiddle(at));
    this.app.changed();
  }

  fromMiddle([x, y]) {
    return [(x - this.width / 2) / this.width, -(y - this.height / 2) / this.width];
  }

  /** Says what the particle under the pointer has. */
  point(at) {
    const frame = this.particles.frameAt(this.app.time);
    const found = this.projection && !this.app.playing ? this.particleAt(at, frame) : null;
    this.tip.hidden = found === null;
    if (found === null) return;
    const place = this.particles
      .place(frame, found)
      .map((x) => shown(x, 5))
      .join(", ");
    const lines = [`particle ${this.particles.id(frame, found)}`, `at (${place}) m`];
    for (const field of this.particles.fields.values()) {
      const value = this.particles.value(field.name, frame, found);
      const text = field.classes?.[Math.round(value)] ?? withUnit(shown(value), field.unit);
      if (value !== undefined) lines.push(`${field.name} ${text}`);
    }
    this.tip.textContent = lines.join("\n");
    this.tip.style.left = `${Math.min(at[0] + 14, this.width - this.tip.offsetWidth - 4)}px`;
    this.tip.style.top = `${Math.min(at[1] + 14, this.height - this.tip.offsetHeight - 4)}px`;
  }

  /** The particle drawn nearest to a pixel, within a few pixels; in 3-D the one in front. */
  particleAt([x, y], frame) {
    const slice = sliceOf(this.run, this.app.slice);
    const radius = Math.max(5, 0.6 * this.run.particle_size * this.projection.scale);
    let best = null,
      least = Infinity;
    for (let p = 0; p < this.particles.rows; ++p) {
      if (this.particles.id(frame, p) < 0) continue;
      const place = this.particles.place(frame, p);
      if (slice && (place[slice.axis] < slice.low || place[slice.axis] > slice.high)) continue;
      const [px, py] = this.projection.point(place);
      const off = (px - x) ** 2 + (py - y) ** 2;
      if (off > radius * radius) continue;
      const rank = this.run.dimension === 3 ? this.projection.distance(place) : off;
      if (rank < least) [best, least] = [p, rank];
    }
    return best;
  }
}

function cloneTemplate(name) {
  return document.getElementById(`template-${name}`).content.firstElementChild.cloneNode(true);
}
