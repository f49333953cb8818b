// Particles as discs, in 3-D as balls, written pixel by pixel: 30 000 of them take a few milliseconds on any machine,
// with or without a graphics card, and look the same everywhere.
"use strict";

const lights = 32; // shades of a ball from its rim to its middle

class Painter {
  constructor() {
    this.canvas = document.createElement("canvas");
    this.context = this.canvas.getContext("2d", { willReadFrequently: true });
  }

  /** Colours by value, and by value and light. */
  setColours(table) {
    const word = (k, light) =>
      (255 << 24) | ((table[4 * k + 2] * light) << 16) | ((table[4 * k + 1] * light) << 8) | (table[4 * k] * light);
    this.colours = Int32Array.from({ length: 256 }, (_, k) => word(k, 1));
    this.lit = Int32Array.from({ length: 256 * lights }, (_, k) =>
      word(Math.floor(k / lights), 0.45 + (0.55 * (k % lights)) / (lights - 1)),
    );
  }

  /** Paints a moment of a run over a panel's context. */
  paint(context, view) {
    const { width, height } = context.canvas;
    const picture = this.blank(width, height, view.particles.dimension === 3);
    const radius = (view.diameter * view.pixels) / 2;
    const stamp =
      radius < 1.25
        ? dotStamp(picture, this.colours, radius)
        : view.particles.dimension === 3
          ? ballStamp(picture, this.lit, radius)
          : discStamp(picture, this.colours, radius);
    forEachSeen(view, radius, width, height, stamp);
    if (view.particles.dimension === 3 && !view.slice) paintBodies(picture, view.particles.bodies, view, view.solid);
    this.context.putImageData(picture.image, 0, 0);
    context.drawImage(this.canvas, 0, 0, width, height, 0, 0, width, height);
  }

  /** An empty picture, of the size of the last one if that fits. */
  blank(width, height, deep) {
    if (this.picture?.width !== width || this.picture?.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
      const image = this.context.createImageData(width, height);
      this.picture = { width, height, image, words: new Int32Array(image.data.buffer), depths: null };
    }
    this.picture.words.fill(0);
    if (deep) (this.picture.depths ??= new Float32Array(width * height)).fill(Infinity);
    return this.picture;
  }
}

/** Calls stamp(x, y, colour 0 ... 255, depth) [pixels of the device] for every particle that is in the picture. */
function forEachSeen(
  { particles, projection, pixels, slice, frame, part, field, range },
  radius,
  width,
  height,
  stamp,
) {
  const { places, ids, rows, dimension } = particles;
  const toPixels = linearIn(particles, (place) => [
    ...projection.point(place).map((x) => x * pixels),
    projection.distance(place) * projection.scale * pixels,
  ]);
  const along = slice && linearIn(particles, (place) => [place[slice.axis]]);
  const frames = framesAround(frame, particles.frames).map((k) => k * rows);
  const ways = waysBetween(part);
  const colourOf = colourIn(field, range, part);
  const code = [0, 0, 0];
  for (let p = 0; p < rows; ++p) {
    const who = whoIs(ids, frames, p);
    const weights = ways[who];
    if (!weights) continue;
    for (let d = 0; d < dimension; ++d) code[d] = codeBetween(places, frames, weights, p, dimension, d, part);
    if (isOutside(code[0]) || isOutside(code[1]) || isOutside(code[2])) {
      if ((who & isWhole) !== isWhole) continue; // it has left, or is not there yet
      for (let d = 0; d < dimension; ++d) code[d] = Math.min(Math.max(code[d], 0), 65535); // a curve may swing
    }
    if (slice) {
      const at = along[0](code);
      if (at < slice.low || at > slice.high) continue;
    }
    const x = toPixels[0](code),
      y = toPixels[1](code);
    if (x < -radius || y < -radius || x > width + radius || y > height + radius) continue;
    const here = frames[who & isHere ? 1 : 2] + p,
      next = frames[who & isNext ? 2 : 1] + p;
    stamp(x, y, colourOf(here, next), dimension === 3 ? toPixels[2](code) : 0);
  }
}

/** What is linear in the place of a particle, as functions of the codes of that place. */
function linearIn(particles, values) {
  const zero = values(particles.low);
  const slopes = particles.low.map((_, axis) => {
    const moved = values(particles.low.map((low, d) => (d === axis ? low + particles.span[d] : low)));
    return moved.map((value, k) => (value - zero[k]) / 65535);
  });
  return zero.map((start, k) => {
    const [x, y, z] = [0, 1, 2].map((d) => slopes[d]?.[k] ?? 0);
    return (code) => start + x * code[0] + y * code[1] + z * code[2];
  });
}

const framesAround = (frame, count) => [-1, 0, 1, 2].map((off) => Math.min(Math.max(frame + off, 0), count - 1));

/** Weights of four frames in a row for a moment between the middle ones: a curve through all frames, without kinks. */
function catmullRom(part) {
  const [t, t2, t3] = [part, part ** 2, part ** 3];
  return [-t + 2 * t2 - t3, 2 - 5 * t2 + 3 * t3, t + 4 * t2 - 3 * t3, t3 - t2].map((w) => w / 2);
}

const isHere = 0b0100, // at the second of four frames
  isNext = 0b0010, // at the third
  isWhole = isHere | isNext;

/**
 * At which of four frames there is a particle in a row, a bit for each. A row is empty for a frame between one particle
 * and the next, so neighbouring frames have the same one.
 */
function whoIs(ids, frames, p) {
  let who = 0;
  for (let k = 0; k < 4; ++k) who = 2 * who + (ids[frames[k] + p] >= 0 ? 1 : 0);
  return who;
}

/** Weights of four frames by who is at them: at a frame that does not have it a particle went on evenly. */
function waysBetween(part) {
  const curve = catmullRom(part);
  const [a, b, c, d] = curve;
  const ways = new Array(16);
  ways[0b1111] = curve;
  ways[0b0111] = [0, b + 2 * a, c - a, d];
  ways[0b1110] = [a, b - d, c + 2 * d, 0];
  ways[0b0110] = [0, 1 - part, part, 0];
  ways[0b1100] = ways[0b1101] = [-part, 1 + part, 0, 0];
  ways[0b0100] = ways[0b0101] = [0, 1, 0, 0];
  if (part === 0) return ways; // what comes later is not there
  ways[0b0011] = ways[0b1011] = [0, 0, 2 - part, part - 1];
  ways[0b0010] = ways[0b1010] = [0, 0, 1, 0];
  return ways;
}

/** Beyond the range of the places at all frames. */
const isOutside = (code) => code < 0 || code > 65535;

function codeBetween(places, frames, weights, p, dimension, d, part) {
  const at = p * dimension + d;
  if (part === 0) return places[frames[1] * dimension + at];
  return (
    weights[0] * places[frames[0] * dimension + at] +
    weights[1] * places[frames[1] * dimension + at] +
    weights[2] * places[frames[2] * dimension + at] +
    weights[3] * places[frames[3] * dimension + at]
  );
}

/** Colour 0 ... 255 of a particle between two frames, whose codes are at `here` and `next`. */
function colourIn(field, range, part) {
  const { codes, low, high, bits } = field;
  const perCode = (255 * (high - low)) / (2 ** bits - 1) / (range[1] - range[0]);
  const start = (255 * (low - range[0])) / (range[1] - range[0]);
  return (here, next) => {
    const code = codes[here] + part * (codes[next] - codes[here]);
    const colour = Math.round(start + perCode * code);
    return colour < 0 ? 0 : colour > 255 ? 255 : colour;
  };
}

/** Squares of whole pixels, for particles of two pixels or less. */
function dotStamp({ words, depths, width, height }, colours, radius) {
  const side = Math.max(1, Math.round(2 * radius));
  return (x, y, colour, depth) => {
    const left = Math.round(x - side / 2),
      top = Math.round(y - side / 2);
    for (let row = Math.max(top, 0); row < Math.min(top + side, height); ++row) {
      for (let column = Math.max(left, 0); column < Math.min(left + side, width); ++column) {
        const at = row * width + column;
        if (depths && depths[at] <= depth) continue;
        if (depths) depths[at] = depth;
        words[at] = colours[colour];
      }
    }
  };
}

/** Discs, later ones over earlier ones: a run of pixels per row, whose ends are covered in part. */
function discStamp({ words, width, height }, colours, radius) {
  return (x, y, colour) => {
    const word = colours[colour];
    const top = Math.max(Math.floor(y - radius), 0),
      bottom = Math.min(Math.ceil(y + radius), height);
    for (let row = top; row < bottom; ++row) {
      const square = radius * radius - (row + 0.5 - y) ** 2;
      if (square <= 0) continue;
      const left = Math.max(x - Math.sqrt(square), 0),
        right = Math.min(x + Math.sqrt(square), width);
      const first = Math.ceil(left),
        last = Math.floor(right),
        start = row * width;
      if (first > last) continue; // no pixel has an edge within
      for (let at = start + first; at < start + last; ++at) words[at] = word;
      if (first > left) words[start + first - 1] = over(words[start + first - 1], word, first - left);
      if (right > last) words[start + last] = over(words[start + last], word, right - last);
    }
  };
}

/** A colour that covers part of a pixel: mixed into what is there, or thinner where nothing is. */
function over(below, colour, share) {
  const alpha = below >>> 24;
  if (alpha < 255) return (Math.max(alpha, Math.round(255 * share)) << 24) | (colour & 0xffffff);
  const part = Math.round(256 * share),
    rest = 256 - part;
  const redBlue = ((colour & 0xff00ff) * part + (below & 0xff00ff) * rest) >>> 8;
  const green = ((colour & 0x00ff00) * part + (below & 0x00ff00) * rest) >>> 8;
  return (255 << 24) | (redBlue & 0xff00ff) | (green & 0x00ff00);
}

/** Balls lit from the eye; the nearest surface is seen. */
function ballStamp({ words, depths, width, height }, lit, radius) {
  return (x, y, colour, depth) => {
    const top = Math.max(Math.round(y - radius), 0),
      bottom = Math.min(Math.round(y + radius), height);
    const left = Math.max(Math.round(x - radius), 0),
      right = Math.min(Math.round(x + radius), width);
    for (let row = top; row < bottom; ++row) {
      const dy = (row + 0.5 - y) ** 2;
      for (let column = left; column < right; ++column) {
        const square = radius * radius - dy - (column + 0.5 - x) ** 2;
        if (square <= 0) continue;
        const bulge = Math.sqrt(square),
          at = row * width + column;
        if (depths[at] <= depth - bulge) continue;
        depths[at] = depth - bulge;
        words[at] = lit[colour * lights + Math.floor((bulge / radius) * (lights - 0.01))];
      }
    }
  };
}
