// What colours mean: field, map and range, and the bar that shows them.
"use strict";

class ColourBar {
  constructor(app) {
    this.app = app;
    this.element = document.getElementById("colour-bar");
    this.fieldChoice = document.getElementById("field");
    this.mapChoice = document.getElementById("map");
    this.ends = ["range-low", "range-high"].map((id) => document.getElementById(id));
    this.fields = this.commonFields();
    fillChoice(this.fieldChoice, [...this.fields.keys()]);
    fillChoice(this.mapChoice, Object.keys(colourMaps));
    this.fieldChoice.addEventListener("change", () => this.chooseField(this.fieldChoice.value));
    this.mapChoice.addEventListener("change", () => this.chooseMap(this.mapChoice.value));
    for (const end of this.ends)
      end.addEventListener("change", () => this.setRange(this.ends.map((input) => Number(input.value))));
    document.getElementById("range-usual").addEventListener("click", () => this.setRange(this.usualRange()));
    document.getElementById("range-full").addEventListener("click", () => this.setRange(this.fullRange()));
  }

  /** Fields that every run has, with the union of their ranges. */
  commonFields() {
    const [first, ...others] = this.app.shownRuns().map((run) => run.particles.fields);
    const found = new Map();
    for (const field of first) {
      const all = [field, ...others.map((fields) => fields.find((other) => other.name === field.name))];
      if (all.includes(undefined)) continue;
      const least = (pick) => Math.min(...all.map(pick)),
        most = (pick) => Math.max(...all.map(pick));
      found.set(field.name, {
        ...field,
        least: least((f) => f.least),
        most: most((f) => f.most),
        usual: [least((f) => f.usual[0]), most((f) => f.usual[1])],
        step: most((f) => (f.high - f.low) / (2 ** f.bits - 1)),
      });
    }
    return found;
  }

  get field() {
    return this.fields.get(this.app.field);
  }

  async chooseField(name) {
    await this.app.loadField(name);
    this.app.field = this.fieldChoice.value = name;
    // Names have no range.
    for (const control of [...this.ends, ...this.element.querySelectorAll("button")])
      control.hidden = Boolean(this.field.classes);
    this.chooseMap(this.field.classes ? "distinct" : this.field.signed ? "blue-red" : name === "pressure" ? "cividis" : "viridis");
    this.setRange(this.usualRange());
  }

  chooseMap(name) {
    this.mapChoice.value = name;
    const classes = this.field.classes?.length;
    this.app.painter.setColours(colourTable(name, classes));
    this.element.querySelector(".bar").style.background = classes ? stepsOf(name, classes) : gradientOf(name);
    this.app.recoloured();
  }

  usualRange() {
    if (this.field.classes) return [-0.5, this.field.classes.length - 0.5];
    return roundRange(...this.field.usual, this.field.signed);
  }

  fullRange() {
    if (this.field.classes) return this.usualRange();
    return this.field.most > this.field.least ? [this.field.least, this.field.most] : this.usualRange();
  }

  setRange([low, high]) {
    const valid = Number.isFinite(low) && Number.isFinite(high) && high > low;
    this.ends.forEach((input) => input.setCustomValidity(valid ? "" : "the upper end must be above the lower one"));
    if (!valid) return this.ends[0].reportValidity();
    this.app.range = [low, high];
    [low, high].forEach((end, k) => (this.ends[k].value = Number(end.toPrecision(6))));
    this.showTicks(low, high);
    this.app.recoloured();
  }

  showTicks(low, high) {
    const { name, unit, least, most, step, classes } = this.field;
    this.element.querySelector(".title").textContent = `${name}${unit ? ` [${unit}]` : ""}`;
    const marks = (classes ? classes.map((_, k) => k) : ticks(low, high, 6)).map((value) => {
      const mark = document.createElement("span");
      mark.style.left = `${(100 * (value - low)) / (high - low)}%`;
      mark.textContent = classes ? classes[value] : shown(value);
      return mark;
    });
    this.element.querySelector(".ticks").replaceChildren(...marks);
    const margin = 0.02 * (high - low);
    this.element.classList.toggle("beyond-low", least < low - margin);
    this.element.classList.toggle("beyond-high", most > high + margin);
    const [mostText, stepText] = [shown(most), shown(step, 2)].map((text) => withUnit(text, unit));
    this.element.querySelector(".true-range span").textContent = classes ? "" :
      `all particles and times: ${shown(least)} … ${mostText} · stored to ${stepText}`;
  }
}

function fillChoice(choice, names) {
  choice.replaceChildren(...names.map((name) => new Option(name, name)));
}
