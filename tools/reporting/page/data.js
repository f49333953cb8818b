// What tools/reporting/packing.py has packed, unpacked: particles by frame, columns of the history.
"use strict";

/** Numbers of a report: everything but the packed columns. */
const report = JSON.parse(document.getElementById("report").textContent);

/** The bytes of a packed column; its text is given free. */
async function unpack(key) {
  const holder = document.getElementById(`packed-${key}`);
  const text = atob(holder.textContent);
  holder.textContent = "";
  const bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; ++k) bytes[k] = text.charCodeAt(k);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Codes of 16 bits, frame after frame, from byte planes of folded differences of an order in time. */
function codesOf(bytes, frames, order) {
  const count = bytes.length / 2;
  const rows = count / frames;
  const codes = new Uint16Array(count);
  for (let k = 0; k < count; ++k) {
    const folded = bytes[k] | (bytes[count + k] << 8);
    codes[k] = (folded >>> 1) ^ -(folded & 1);
  }
  for (; order > 0; --order) {
    for (let k = rows; k < count; ++k) codes[k] += codes[k - rows];
  }
  return codes;
}

/** Floats of 8 bytes from byte planes. */
function floatsOf(bytes) {
  const count = bytes.length / 8;
  const ordered = new Uint8Array(bytes.length);
  for (let plane = 0; plane < 8; ++plane) {
    for (let k = 0; k < count; ++k) ordered[8 * k + plane] = bytes[plane * count + k];
  }
  return new Float64Array(ordered.buffer);
}

/** Who is at [frame*rows + row], from who is in which row from which frame to which. */
function idsOf([row, first, last, id], frames, rows) {
  const ids = new Int32Array(frames * rows).fill(-1);
  id.forEach((own, k) => {
    for (let frame = first[k]; frame <= last[k]; ++frame) ids[frame * rows + row[k]] = own;
  });
  return ids;
}

/** The particles of a run. */
class Particles {
  constructor(run) {
    this.run = run;
    this.rows = run.particles.rows;
    this.frames = run.times.length;
    this.dimension = run.dimension;
    this.low = run.particles.position.low;
    this.span = this.low.map((low, d) => run.particles.position.high[d] - low);
    this.fields = new Map(run.particles.fields.map((field) => [field.name, { ...field, codes: null }]));
  }

  /**
   * Places are at [(frame*rows + row)*dimension + axis], 0 ... 65535 from low to low + span; ids at [frame*rows + row],
   * -1 where nobody is.
   */
  async loadPlaces() {
    this.ids = idsOf(await columnsOf(this.run.particles.stays, 4), this.frames, this.rows);
    this.bodies = await loadBodies(this.run);
    this.surfaces = await loadSurfaces(this.run);
    const axes = [];
    for (const key of this.run.particles.position.keys) axes.push(codesOf(await unpack(key), this.frames, 2));
    this.places = new Uint16Array(axes[0].length * this.dimension);
    axes.forEach((axis, d) => {
      for (let k = 0; k < axis.length; ++k) this.places[k * this.dimension + d] = axis[k];
    });
  }

  /** Codes of a field are at [frame*rows + row], 0 ... 2^bits - 1. */
  load(name) {
    const field = this.fields.get(name);
    field.loading ??= unpack(field.key).then((bytes) => {
      field.codes = codesOf(bytes, this.frames, 1);
      return field;
    });
    return field.loading;
  }

  place(frame, p) {
    const at = (frame * this.rows + p) * this.dimension;
    return this.low.map((low, d) => low + (this.places[at + d] / 65535) * this.span[d]);
  }

  /** Value of a field that is loaded, else undefined. */
  value(name, frame, p) {
    const field = this.fields.get(name);
    if (!field?.codes) return undefined;
    return field.low + (field.codes[frame * this.rows + p] / (2 ** field.bits - 1)) * (field.high - field.low);
  }

  /** The id of the particle in a row, negative if there is none. */
  id(frame, p) {
    return this.ids[frame * this.rows + p];
  }

  /** The frame whose time is nearest. */
  frameAt(time) {
    return nearest(this.run.times, time);
  }
}

/** Index of the entry of an ascending list that is nearest to a value. */
function nearest(list, value) {
  let low = 0,
    high = list.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (list[middle] <= value) low = middle;
    else high = middle;
  }
  return value - list[low] <= list[high] - value ? low : high;
}

/** The history of a run as a map from column to its numbers. */
async function loadHistory(history) {
  const numbers = floatsOf(await unpack(history.key));
  return new Map(history.columns.map((name, k) => [name, numbers.subarray(k * history.rows, (k + 1) * history.rows)]));
}
