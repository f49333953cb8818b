// A picture of a run at a moment: walls, bodies, particles, what they are compared with, a scale.
"use strict";

/** Which frame is shown at a time, and which part of the way to the next one. */
function momentOf(particles, time, smooth) {
  const times = particles.run.times;
  const frame = particles.frameAt(time);
  if (!smooth || particles.run.periodic) return { frame, part: 0 };
  const before = times[frame] > time && frame > 0 ? frame - 1 : frame;
  if (before === times.length - 1 || time <= times[before]) return { frame: before, part: 0 };
  return { frame: before, part: (time - times[before]) / (times[before + 1] - times[before]) };
}

const finest = 1.8; // of a particle, in pixels of the page: two pixels of the device at least

/** Of the device per pixel of the page; more than 2 cost time and show nothing. */
const devicePixels = () => Math.min(window.devicePixelRatio || 1, 2);

/** Draws into a context, `width` x `height` pixels of the page, `look` says how; returns the projection. */
function drawRun(context, width, height, particles, time, look) {
  const { run } = particles;
  const pixels = context.canvas.width / width;
  const projection = look.camera.projection(run, width, height, look.scale ? scaleHeight : 0);
  const moment = momentOf(particles, time, look.smooth);
  const edges = boxEdges(run, projection);
  const slice = sliceOf(run, look.slice);
  const paths = bodyPaths(particles.bodies, projection, moment, slice, run.dimension);
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.fillStyle = look.theme.canvas;
  context.fillRect(0, 0, context.canvas.width, context.canvas.height);
  inPagePixels(context, pixels, () => {
    drawEdges(
      context,
      edges.filter((edge) => edge.behind),
      projection,
      look.theme,
    );
    context.fillStyle = look.theme.solid;
    inTheBox(context, run, projection, () => paths.forEach((path) => context.fill(path, "evenodd")));
  });
  const diameter = Math.max(overlap(run) * run.particle_size * crowding(run) * projection.scale, finest);
  look.painter.paint(context, {
    particles,
    projection,
    pixels,
    diameter,
    field: particles.fields.get(look.field),
    range: look.range,
    slice,
    solid: rgbOf(look.theme.solid),
    ...moment,
  });
  inPagePixels(context, pixels, () => {
    context.strokeStyle = look.theme.wall;
    context.lineWidth = 1;
    inTheBox(context, run, projection, () => paths.forEach((path) => context.stroke(path)));
    drawEdges(
      context,
      edges.filter((edge) => !edge.behind),
      projection,
      look.theme,
    );
    drawSurface(context, particles.surfaces, projection, moment, look.theme);
    drawReferences(context, run, projection, time, look.theme);
    drawCorners(context, run, projection, moment.part ? time : run.times[moment.frame], look.theme);
    if (look.scale) drawScale(context, projection, height, look.theme);
  });
  return projection;
}

/** Red, green and blue of "#rrggbb". */
const rgbOf = (colour) => [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16));

function inPagePixels(context, pixels, draw) {
  context.save();
  context.setTransform(pixels, 0, 0, pixels, 0, 0);
  draw();
  context.restore();
}

/** Discs hide the gaps of a lattice, but not those of a flow that tears; balls just touch. */
const overlap = (run) => (run.dimension === 2 ? 1.3 : 1.1);

/** Fewer particles in the page than in the run are drawn larger. */
const crowding = (run) => (1 / run.particles.share) ** (1 / run.dimension);

/** The slab of two particles' thickness around the chosen place, or nothing. */
function sliceOf(run, slice) {
  if (!slice || run.dimension !== 3) return null;
  const low = run.box.low[slice.axis],
    high = run.box.high[slice.axis];
  const middle = low + slice.at * (high - low),
    half = Math.max(run.particle_size, run.spacing / 2) * crowding(run);
  return { axis: slice.axis, low: middle - half, high: middle + half };
}

/** The sides of the box in 2-D, its edges in 3-D; those behind the liquid are drawn first. */
function boxEdges(run, projection) {
  const { low, high } = run.box;
  const count = 2 ** run.dimension;
  const corner = (k) => low.map((l, d) => ((k >> d) & 1 ? high[d] : l));
  const away = Array.from({ length: count }, (_, k) => projection.distance(corner(k)));
  const farthest = away.indexOf(Math.max(...away));
  const edges = [];
  for (let a = 0; a < count; ++a) {
    for (let d = 0; d < run.dimension; ++d) {
      const b = a | (1 << d);
      if (b === a) continue;
      const solid = run.dimension === 3;
      edges.push({
        ends: [corner(a), corner(b)],
        behind: solid && (a === farthest || b === farthest),
        solid,
        wall: solid ? "slip" : run.walls[1 - d][(a >> (1 - d)) & 1],
      });
    }
  }
  return edges;
}

function drawEdges(context, edges, projection, theme) {
  for (const { ends, behind, solid, wall } of edges) {
    context.strokeStyle = behind ? theme.faint : theme.wall;
    context.lineWidth = solid ? 0.8 : wall === "no_slip" ? 2.5 : 1.2;
    context.setLineDash(wall === "periodic" ? [2, 4] : []);
    line(
      context,
      ends.map((end) => projection.point(end)),
    );
  }
  context.setLineDash([]);
}

function line(context, points) {
  context.beginPath();
  points.forEach(([x, y], k) => (k ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.stroke();
}

/** The reference nearest to a time, and how plainly it is seen: fully at its own time, fading next to it. */
function referenceAt(run, time) {
  const times = run.references.map((curves) => curves.time);
  if (times.length === 0) return null;
  const curves = run.references[nearest(times, time)];
  const off = Math.abs(curves.time - time),
    duration = run.times[run.times.length - 1];
  const strength = off < 0.002 * duration ? 1 : 1 - off / (0.02 * duration);
  return strength > 0 ? { curves, strength } : null;
}

function drawReferences(context, run, projection, time, theme) {
  const found = referenceAt(run, time);
  if (!found) return;
  context.globalAlpha = found.strength;
  context.strokeStyle = theme.reference;
  context.lineWidth = 1.6;
  for (const segment of found.curves.segments)
    line(
      context,
      segment.map((place) => projection.point(place)),
    );
  context.globalAlpha = 1;
}

/** Exact places of corners, and the way there, as long as they are in the box. */
function drawCorners(context, run, projection, time, theme) {
  if (!run.corners) return;
  const { start, velocity, acceleration } = run.corners;
  const inside = (place) => place.every((x, d) => x >= run.box.low[d] && x <= run.box.high[d]);
  context.strokeStyle = theme.reference;
  start.forEach((x, k) => {
    const at = (t) => x.map((x0, d) => x0 + t * velocity[k][d] + 0.5 * t * t * acceleration[d]);
    const path = Array.from({ length: 33 }, (_, j) => at((j / 32) * time)).filter(inside);
    context.lineWidth = 0.9;
    context.setLineDash([3, 3]);
    line(
      context,
      path.map((place) => projection.point(place)),
    );
    context.setLineDash([]);
    if (inside(at(time))) drawCross(context, projection.point(at(time)));
  });
}

function drawCross(context, [x, y]) {
  context.lineWidth = 1.6;
  line(context, [
    [x - 5, y - 5],
    [x + 5, y + 5],
  ]);
  line(context, [
    [x - 5, y + 5],
    [x + 5, y - 5],
  ]);
}

const scaleHeight = 24; // pixels of the page

/** A bar of a round length, below the picture. */
function drawScale(context, projection, height, theme) {
  const length = roundStep(110 / projection.scale, finest);
  const wide = length * projection.scale;
  const text = length < 0.01 ? `${shown(length * 1e3)} mm` : `${shown(length)} m`;
  context.font = "11px system-ui, sans-serif";
  context.fillStyle = theme.canvas;
  context.globalAlpha = 0.8;
  context.fillRect(0, height - scaleHeight, wide + 34 + context.measureText(text).width, scaleHeight);
  context.globalAlpha = 1;
  context.fillStyle = context.strokeStyle = theme.ink;
  context.lineWidth = 1;
  line(context, [
    [12, height - 15],
    [12, height - 9],
    [12 + wide, height - 9],
    [12 + wide, height - 15],
  ]);
  context.fillText(text, 20 + wide, height - 8);
}
