// Where the eye is: one camera for all panels, in terms of what a panel shows when nothing was moved.
"use strict";

const degrees = Math.PI / 180;

/** Turned, tilted, zoomed and moved. In 2-D it only zooms and moves. */
class Camera {
  constructor() {
    this.reset();
  }

  reset() {
    this.zoom = 1;
    this.move = [0, 0]; // of the middle, in widths of the panel
    this.turn = 25 * degrees;
    this.tilt = 22 * degrees;
  }

  /** Zooms by a factor and keeps a point of the panel, in widths from its middle, where it is. */
  zoomAt(factor, [x, y]) {
    const zoom = Math.min(Math.max(this.zoom * factor, 0.2), 200);
    const change = zoom / this.zoom;
    this.move = [x + (this.move[0] - x) * change, y + (this.move[1] - y) * change];
    this.zoom = zoom;
  }

  shift(x, y) {
    this.move = [this.move[0] + x, this.move[1] + y];
  }

  orbit(turn, tilt) {
    this.turn += turn;
    this.tilt = Math.min(Math.max(this.tilt + tilt, -90 * degrees), 90 * degrees);
  }

  get isMoved() {
    return this.zoom !== 1 || this.move[0] !== 0 || this.move[1] !== 0;
  }

  /** Rows: to the right, upwards, away from the eye. */
  directions(run) {
    if (run.dimension === 2)
      return [
        [1, 0, 0],
        [0, 1, 0],
        [0, 0, 1],
      ];
    const right = unit(run.up === 0 ? 1 : 0),
      up = unit(run.up);
    const into = [
      up[1] * right[2] - up[2] * right[1],
      up[2] * right[0] - up[0] * right[2],
      up[0] * right[1] - up[1] * right[0],
    ];
    const [ct, st, ch, sh] = [Math.cos(this.turn), Math.sin(this.turn), Math.cos(this.tilt), Math.sin(this.tilt)];
    const across = right.map((r, d) => ct * r + st * into[d]);
    const away = right.map((r, d) => ct * into[d] - st * r);
    return [across, up.map((u, d) => ch * u + sh * away[d]), away.map((a, d) => ch * a - sh * up[d])];
  }

  /** How a panel of `width` x `height` pixels shows a run; `below` is left free for the scale. */
  projection(run, width, height, below = 0) {
    const rows = this.directions(run);
    const [low, high] = run.view;
    const middle = low.map((l, d) => (l + high[d]) / 2);
    const [across, up] = extentOf(run);
    const scale = this.zoom * Math.min((width - 2 * margin) / across, (height - 2 * margin - below) / up);
    const centre = [width / 2 + this.move[0] * width, (height - below) / 2 - this.move[1] * width];
    return new Projection(rows, middle, scale, centre);
  }
}

const margin = 10; // around what is shown, in pixels of the page

const unit = (axis) => [0, 1, 2].map((d) => (d === axis ? 1 : 0));

/** Width and height of what is shown when nothing was moved. [m] */
function extentOf(run) {
  const [low, high] = run.view;
  const size = low.map((l, d) => high[d] - l);
  if (run.dimension === 2) return size;
  const rows = new Camera().directions(run);
  return [0, 1].map((k) => size.reduce((sum, s, d) => sum + s * Math.abs(rows[k][d]), 0));
}

/** From metres to pixels of a panel, y downwards, and to a distance from the eye. */
class Projection {
  constructor(rows, middle, scale, centre) {
    Object.assign(this, { rows, middle, scale, centre });
  }

  point(place) {
    const [x, y] = [0, 1].map((k) =>
      this.rows[k].reduce((sum, r, d) => sum + r * ((place[d] ?? 0) - (this.middle[d] ?? 0)), 0),
    );
    return [this.centre[0] + this.scale * x, this.centre[1] - this.scale * y];
  }

  distance(place) {
    return this.rows[2].reduce((sum, r, d) => sum + r * ((place[d] ?? 0) - (this.middle[d] ?? 0)), 0);
  }

  /** The point of the plane under a pixel. [m] */
  placeAt([x, y]) {
    return [this.middle[0] + (x - this.centre[0]) / this.scale, this.middle[1] - (y - this.centre[1]) / this.scale];
  }
}
