// Rigid bodies: surfaces that are where the run has them, filled in 2-D and in slices, in 3-D lit triangles.
"use strict";

/** The columns of a packed table, each of `count` numbers. */
async function columnsOf(key, count) {
  const numbers = floatsOf(await unpack(key));
  return Array.from({ length: count }, (_, k) =>
    numbers.subarray((k * numbers.length) / count, ((k + 1) * numbers.length) / count),
  );
}

class Body {
  constructor(described, dimension) {
    Object.assign(this, { described, dimension });
    this.pivot = described.pivot;
  }

  async load() {
    const { described, dimension } = this;
    this.points = await columnsOf(described.points, dimension);
    this.elements = await columnsOf(described.elements, dimension);
    this.position = await columnsOf(described.position, dimension);
    this.rotation = await columnsOf(described.rotation, dimension ** 2);
    this.angle = await columnsOf(described.angle, dimension === 2 ? 1 : 3);
    return this;
  }

  /** Places of all points at a moment. [m] */
  placesAt({ frame, part }) {
    const frames = framesAround(frame, this.position[0].length),
      weights = catmullRom(part);
    const between = (column) => frames.reduce((sum, k, j) => sum + weights[j] * column[k], 0);
    const at = this.position.map(between);
    const turned = this.dimension === 2 ? planeRotation(between(this.angle[0])) : this.turnedTo(frame, part);
    return Array.from(this.points[0], (_, p) =>
      at.map((x, d) =>
        turned[d].reduce((sum, entry, e) => sum + entry * (this.points[e][p] - this.pivot[e]), x),
      ),
    );
  }

  /** In 3-D: about the axis of the turn from one frame to the next. */
  turnedTo(frame, part) {
    const here = this.rotationOf(frame);
    if (part === 0) return here;
    const next = this.rotationOf(Math.min(frame + 1, this.position[0].length - 1));
    return times(rotationAbout(turnBetween(here, next).map((x) => x * part)), here);
  }

  rotationOf(frame) {
    return [0, 1, 2].map((row) => [0, 1, 2].map((column) => this.rotation[3 * row + column][frame]));
  }
}

async function loadBodies(run) {
  const bodies = run.bodies.map((described) => new Body(described, run.dimension));
  for (const body of bodies) await body.load();
  return bodies;
}

const planeRotation = (angle) => [
  [Math.cos(angle), -Math.sin(angle)],
  [Math.sin(angle), Math.cos(angle)],
];

const times = (a, b) => a.map((row) => [0, 1, 2].map((k) => row.reduce((sum, x, j) => sum + x * b[j][k], 0)));

/** The vector along the axis, as long as the angle, of the rotation from one to another; less than half a turn. */
function turnBetween(from, to) {
  const turn = times(to, from[0].map((_, k) => from.map((row) => row[k])));
  const axis = [turn[2][1] - turn[1][2], turn[0][2] - turn[2][0], turn[1][0] - turn[0][1]];
  const sine = Math.hypot(...axis) / 2,
    cosine = (turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2;
  const scale = sine > 1e-9 ? Math.atan2(sine, cosine) / (2 * sine) : 0.5;
  return axis.map((x) => x * scale);
}

/** Rodrigues' formula. */
function rotationAbout(turn) {
  const angle = Math.hypot(...turn);
  const [x, y, z] = turn.map((t) => t / (angle || 1));
  const [c, s, rest] = [Math.cos(angle), Math.sin(angle), 1 - Math.cos(angle)];
  return [
    [c + x * x * rest, x * y * rest - z * s, x * z * rest + y * s],
    [y * x * rest + z * s, c + y * y * rest, y * z * rest - x * s],
    [z * x * rest - y * s, z * y * rest + x * s, c + z * z * rest],
  ];
}

/** Loops of places in 2-D, or where a body is cut across an axis. */
function loopsOf(body, places, slice) {
  const next = new Map(),
    place = new Map();
  const link = (from, to, ends) => {
    next.set(from, to);
    ends.forEach(([name, at]) => place.set(name, at));
  };
  for (let k = 0; k < body.elements[0].length; ++k) {
    const corners = body.elements.map((column) => column[k]);
    if (body.dimension === 2) link(corners[0], corners[1], [[corners[0], places[corners[0]]]]);
    else cutTriangle(corners, places, slice, link);
  }
  const loops = [];
  while (next.size) {
    const loop = [];
    for (let at = next.keys().next().value; next.has(at); ) {
      const after = next.get(at);
      loop.push(place.get(at));
      next.delete(at);
      at = after;
    }
    loops.push(loop);
  }
  return loops;
}

/** Where a triangle crosses the middle of a slice: from one of its edges to another, which neighbours share. */
function cutTriangle(corners, places, slice, link) {
  const middle = (slice.low + slice.high) / 2;
  const height = corners.map((p) => places[p][slice.axis] - middle || 1e-300);
  const ends = {};
  for (let k = 0; k < 3; ++k) {
    const after = (k + 1) % 3;
    if (height[k] > 0 === height[after] > 0) continue;
    const share = height[k] / (height[k] - height[after]);
    const [a, b] = [corners[k], corners[after]];
    const name = a < b ? `${a} ${b}` : `${b} ${a}`;
    ends[height[k] > 0 ? "to" : "from"] = [name, places[a].map((x, d) => x + share * (places[b][d] - x))];
  }
  if (ends.from) link(ends.from[0], ends.to[0], [ends.from, ends.to]);
}

/** The loops of all bodies that lie in the picture, as paths; in 3-D without a slice there are none. */
function bodyPaths(bodies, projection, moment, slice, dimension) {
  if (dimension === 3 && !slice) return [];
  return bodies.map((body) => {
    const path = new Path2D();
    for (const loop of loopsOf(body, body.placesAt(moment), slice)) {
      loop.forEach((at, k) => (k ? path.lineTo(...projection.point(at)) : path.moveTo(...projection.point(at))));
      path.closePath();
    }
    return path;
  });
}

/** Draws into what of the picture is box; in 3-D everywhere. */
function inTheBox(context, run, projection, draw) {
  context.save();
  if (run.dimension === 2) {
    const [left, bottom] = projection.point(run.box.low),
      [right, top] = projection.point(run.box.high);
    context.beginPath();
    context.rect(left, top, right - left, bottom - top);
    context.clip();
  }
  draw();
  context.restore();
}

/** Triangles that face the eye, lit from the left above, into a picture of pixels; the nearest surface is seen. */
function paintBodies(picture, bodies, { projection, pixels, frame, part }, [red, green, blue]) {
  for (const body of bodies) {
    const seen = body.placesAt({ frame, part }).map((place) => [
      ...projection.point(place).map((x) => x * pixels),
      projection.distance(place) * projection.scale * pixels,
    ]);
    for (let k = 0; k < body.elements[0].length; ++k) {
      const [a, b, c] = body.elements.map((column) => seen[column[k]]);
      const u = b.map((x, d) => x - a[d]),
        v = c.map((x, d) => x - a[d]);
      const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      // Pixels count downwards, and depth away from the eye, which leaves the triangles turning as they do.
      if (normal[2] >= 0) continue;
      const length = Math.hypot(...normal);
      const light = 0.4 + 0.6 * Math.max(0, (-0.3 * normal[0] - 0.5 * normal[1] - 0.8 * normal[2]) / length);
      const shade = (part) => Math.min(255, Math.round(part * light));
      const word = (255 << 24) | (shade(blue) << 16) | (shade(green) << 8) | shade(red);
      fillTriangle(picture, a, b, c, normal, word);
    }
  }
}

function fillTriangle({ words, depths, width, height }, a, b, c, normal, word) {
  const top = Math.max(Math.ceil(Math.min(a[1], b[1], c[1]) - 0.5), 0),
    bottom = Math.min(Math.floor(Math.max(a[1], b[1], c[1]) - 0.5), height - 1);
  for (let row = top; row <= bottom; ++row) {
    const y = row + 0.5;
    let left = Infinity,
      right = -Infinity;
    for (const [from, to] of [
      [a, b],
      [b, c],
      [c, a],
    ]) {
      if (y < Math.min(from[1], to[1]) || y > Math.max(from[1], to[1]) || from[1] === to[1]) continue;
      const x = from[0] + ((y - from[1]) / (to[1] - from[1])) * (to[0] - from[0]);
      left = Math.min(left, x);
      right = Math.max(right, x);
    }
    const last = Math.min(Math.floor(right), width - 1);
    for (let column = Math.max(Math.floor(left), 0); column <= last; ++column) {
      const depth = a[2] - ((column + 0.5 - a[0]) * normal[0] + (y - a[1]) * normal[1]) / normal[2];
      const at = row * width + column;
      if (depths[at] <= depth) continue;
      depths[at] = depth;
      words[at] = word;
    }
  }
}
