// Histories: small plots by uPlot, values under the pointer, a line where the animation is.
"use strict";

class Plots {
  constructor(app) {
    this.app = app;
    this.element = document.getElementById("plots");
    this.drawn = [];
  }

  /** Makes all plots from the histories of the runs; null where a run has none. */
  show(histories) {
    this.histories = histories;
    this.redraw();
    let width = this.element.clientWidth;
    new ResizeObserver(() => {
      if (this.element.clientWidth === width) return;
      width = this.element.clientWidth;
      for (const plot of this.drawn) plot.setSize(this.sizeIn(plot.root.parentElement));
      this.showTime(this.app.time);
    }).observe(this.element);
  }

  /** Anew, as after a change of the theme. */
  redraw() {
    for (const plot of this.drawn) plot.destroy();
    this.element.replaceChildren();
    this.drawn = report.plots.map((plot) => this.make(plot));
    this.showTime(this.app.time);
  }

  make(plot) {
    const holder = document.createElement("figure");
    const caption = document.createElement("figcaption");
    caption.textContent = plot.title + (plot.unit ? ` [${plot.unit}]` : "");
    holder.append(caption);
    this.element.append(holder);
    const { data, series } = this.curves(plot);
    const drawn = new uPlot(this.options(plot, series, holder), data, holder);
    drawn.cursorLine = document.createElement("div");
    drawn.cursorLine.className = "now";
    drawn.over.append(drawn.cursorLine);
    drawn.over.addEventListener("click", () => this.app.player?.jump(drawn.posToVal(drawn.cursor.left, "x")));
    return drawn;
  }

  curves(plot) {
    const tables = [],
      series = [{}];
    const several = this.histories.length > 1;
    this.histories.forEach((history, k) => {
      const columns = Object.keys(plot.columns).filter((name) => history?.has(name));
      if (columns.length === 0) return;
      tables.push([history.get("time"), ...columns.map((name) => positive(history.get(name), plot.logarithmic))]);
      columns.forEach((name) => {
        const at = several ? k : Object.keys(plot.columns).indexOf(name);
        const label = several ? report.runs[k].label : plot.columns[name] || plot.title;
        series.push({
          label,
          stroke: this.app.theme.curves[at % curveCount],
          width: 1.2,
          spanGaps: true,
          points: { show: false },
          dash: at >= curveCount ? [6, 3] : undefined,
          value: (_, value) => shown(value, 5),
        });
      });
    });
    return { data: tables.length > 1 ? uPlot.join(tables) : tables[0], series };
  }

  options(plot, series, holder) {
    const theme = this.app.theme;
    const axis = {
      stroke: theme.ink,
      grid: { stroke: theme.grid, width: 1 },
      ticks: { stroke: theme.grid, width: 1, size: 4 },
      font: "11px system-ui, sans-serif",
      gap: 3,
    };
    series[0] = { label: "t", value: (_, value) => (value === null ? "–" : `${shown(value, 5)} s`) };
    return {
      ...this.sizeIn(holder),
      series,
      legend: { live: true, isolate: true },
      scales: {
        x: { time: false },
        y: { distr: plot.logarithmic ? 3 : 1, range: plot.logarithmic ? undefined : comfortable },
      },
      axes: [
        { ...axis, size: 24, values: (_, values) => values.map((v) => shown(v)) },
        {
          ...axis,
          size: widthOfLabels,
          values: (_, values) => values.map((v) => (v === null ? "" : shown(v, 5))),
          ...(plot.logarithmic && { filter: decades, grid: { ...axis.grid, filter: decades } }),
        },
      ],
      cursor: {
        sync: { key: "histories", setSeries: false },
        y: false,
        points: { size: 5 },
        drag: { x: true, y: false, dist: 5 },
      },
      hooks: { setCursor: [(u) => this.pointed(u)], setScale: [(u, key) => key === "x" && this.zoomed(u)] },
    };
  }

  sizeIn(holder) {
    return { width: holder.clientWidth, height: 170 };
  }

  /** Away from the plots the values are those of the animation's time. */
  pointed(plot) {
    if (plot.cursor.left < 0) this.showValues(plot);
  }

  showValues(plot) {
    const times = plot.data[0];
    if (times.length) plot.setLegend({ idx: nearest(times, this.app.time) }, false);
  }

  /** All plots show the same span of time. */
  zoomed(source) {
    if (this.zooming) return;
    this.zooming = true;
    const { min, max } = source.scales.x;
    for (const plot of this.drawn) if (plot !== source) plot.setScale("x", { min, max });
    this.zooming = false;
    this.showTime(this.app.time);
  }

  showTime(time) {
    const now = performance.now();
    const withValues = !this.app.playing || now - (this.valuesAt ?? 0) > 150; // text costs more than a line
    if (withValues) this.valuesAt = now;
    for (const plot of this.drawn) {
      const { min, max } = plot.scales.x;
      plot.cursorLine.hidden = !(time >= min && time <= max);
      plot.cursorLine.style.transform = `translateX(${plot.valToPos(time, "x")}px)`;
      if (withValues && !(plot.cursor.left >= 0)) this.showValues(plot);
    }
  }
}

/** A logarithm has no place for zero. */
const positive = (values, logarithmic) =>
  logarithmic
    ? Array.from(values, (v) => (v > 0 ? v : null))
    : Array.from(values, (v) => (Number.isFinite(v) ? v : null));

/** Values closer than this, relative to their size, are the same: marks between them need some of the 16 digits. */
const sameValue = 1e-12;

/** Room above and below; something to see where all values are the same. */
function comfortable(_, low, high) {
  if (low === null) return [0, 1];
  const size = Math.max(Math.abs(low), Math.abs(high));
  const room = high - low > sameValue * size ? 0.06 * (high - low) : size * 0.1 || 1;
  return [low - room, high + room];
}

/** Of the marks of a logarithmic axis, the powers of ten; if there are none, all. */
function decades(_, values) {
  const isPower = (value) => Math.abs(Math.log10(value) - Math.round(Math.log10(value))) < 1e-6;
  return values.some(isPower) ? values.map((value) => (isPower(value) ? value : null)) : values;
}

/** Of the numbers next to an axis, in pixels. */
function widthOfLabels(plot, values) {
  const longest = (values ?? []).reduce((most, text) => Math.max(most, text.length), 0);
  return 14 + 6.3 * longest;
}
