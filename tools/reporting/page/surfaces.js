// The free surface of runs in 2-D that have written it: closed lines over the particles.
"use strict";

class Surfaces {
  constructor(run) {
    this.run = run;
  }

  /** Paths are made of the points of a frame, loop after loop. */
  async load() {
    const { points, lengths, loops } = this.run.surfaces;
    this.axes = [];
    for (const key of points) this.axes.push(codesOf(await unpack(key), 1, 0));
    this.lengths = floatsOf(await unpack(lengths));
    this.frames = [];
    let loop = 0,
      point = 0;
    for (const count of loops) {
      this.frames.push({ loop, point, count });
      for (let k = 0; k < count; ++k) point += this.lengths[loop++];
    }
    return this;
  }

  /** The loops of a frame, as lists of places. [m] */
  at(frame) {
    const { low, high } = this.run.box;
    const { loop, point, count } = this.frames[frame];
    let next = point;
    return Array.from({ length: count }, (_, k) =>
      Array.from({ length: this.lengths[loop + k] }, () => {
        const place = this.axes.map((codes, d) => low[d] + (codes[next] / 65535) * (high[d] - low[d]));
        next += 1;
        return place;
      }),
    );
  }
}

async function loadSurfaces(run) {
  return run.surfaces ? new Surfaces(run).load() : null;
}

/** The lines of the output time that is nearest: between two of them only the particles move. */
function drawSurface(context, surfaces, projection, { frame, part }, theme) {
  if (!surfaces) return;
  context.strokeStyle = theme.ink;
  context.lineWidth = 1.2;
  for (const loop of surfaces.at(part > 0.5 ? frame + 1 : frame)) {
    context.beginPath();
    for (const place of loop) context.lineTo(...projection.point(place));
    context.closePath();
    context.stroke();
  }
}
