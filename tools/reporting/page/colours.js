// Colours of numbers, round numbers for scales, numbers as text.
"use strict";

/** 17 colours from low to high, from matplotlib: perceptually uniform ones, then those with a middle; colours that
 *  stand for names. */
const colourMaps = {
  viridis:
    `440154 48186a 472d7b 424086 3b528b 33638d 2c728e 26828e 21918c
    1fa088 28ae80 3fbc73 5ec962 84d44b addc30 d8e219 fde725`,
  cividis:
    `00224e 002e6a 1a386f 32436d 434e6c 535a6d 61656f 6f7073 7d7c78
    8c8878 9b9476 aba072 bcae6c cdbb63 dec958 f0d846 fee838`,
  magma:
    `000004 0a0822 1d1147 36106b 51127c 6a1c81 832681 9c2e7f b73779
    d0416f e75263 f56b5c fc8961 fea772 fec488 fde2a3 fcfdbf`,
  turbo:
    `30123b 4040a2 466be3 4294ff 28bceb 18ddc2 32f298 6dfe62 a4fc3c
    cdec34 eecf3a fdac34 fb7e21 eb500e d02f05 a91601 7a0403`,
  "blue-red":
    `3b4cc0 4e68d8 6282ea 779af7 8db0fe a3c2fe b9d0f9 ccd9ed dddcdc
    ecd3c5 f5c4ac f7b093 f4987a eb7d62 dd5f4b ca3b37 b40426`,
  "purple-orange":
    `2d004b 451871 5f3a91 7b6aa8 9990bf b7b1d5 cfcfe5 e4e5f0 f7f7f6
    fce8cd fed59f fdbc6b ee9b39 d97b12 bd6109 9e4c07 7f3b08`,
  distinct: `0072b2 d55e00 009e73 cc79a7 e69f00 56b4e9`,
};

/** 256 colours, red, green, blue and alpha of each; of `classes` alike parts, if there are classes. */
function colourTable(name, classes) {
  const stops = colourMaps[name].split(/\s+/).map((hex) => [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16)));
  const table = new Uint8Array(4 * 256);
  for (let k = 0; k < 256; ++k) {
    const at = classes ? Math.floor((k / 256) * classes) % stops.length : (k / 255) * (stops.length - 1);
    const below = Math.min(Math.floor(at), stops.length - 2);
    for (let c = 0; c < 3; ++c)
      table[4 * k + c] = stops[below][c] + (at - below) * (stops[below + 1][c] - stops[below][c]);
    table[4 * k + 3] = 255;
  }
  return table;
}

/** The colours of so many classes, with sharp edges. */
const stepsOf = (name, classes) =>
  `linear-gradient(to right, ${Array.from({ length: classes }, (_, k) => {
    const stops = colourMaps[name].split(/\s+/);
    return `#${stops[k % stops.length]} ${(100 * k) / classes}% ${(100 * (k + 1)) / classes}%`;
  }).join(", ")})`;

const gradientOf = (name) =>
  `linear-gradient(to right, ${colourMaps[name]
    .split(/\s+/)
    .map((hex) => `#${hex}`)
    .join(", ")})`;

/** A step of 1, 2 or 5 times a power of ten, so that a range has about `count` of them. */
function roundStep(range, count) {
  const raw = range / count || 1;
  const power = 10 ** Math.floor(Math.log10(raw));
  return [1, 2, 5, 10].find((factor) => factor * power >= raw * 0.999) * power;
}

/** Round numbers within low ... high. */
function ticks(low, high, count) {
  const step = roundStep(high - low, count);
  const first = Math.ceil(low / step - 1e-6);
  const found = [];
  for (let k = first; k * step <= high + 1e-6 * step; ++k) found.push(Number((k * step).toPrecision(12)));
  return found;
}

/** The range of a scale: a little wider than asked, round, from zero where that is near. */
function roundRange(low, high, signed) {
  if (signed) {
    const most = Math.max(Math.abs(low), Math.abs(high)) || 1;
    const step = roundStep(most, 5);
    const end = Number((Math.ceil(most / step - 1e-6) * step).toPrecision(12));
    return [-end, end];
  }
  if (low > -0.05 * Math.abs(high) && low < 0.3 * high) low = 0;
  if (!(high > low)) high = low + (Math.abs(low) || 1);
  const step = roundStep(high - low, 5);
  return [Math.floor(low / step + 1e-6), Math.ceil(high / step - 1e-6)].map((k) => Number((k * step).toPrecision(12)));
}

const superscripts = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/** A number as it is read: 0.0012, 153 000, 1.2·10⁻⁷. */
function shown(value, digits = 4) {
  if (value === 0 || value === undefined || value === null || !Number.isFinite(value)) return value === 0 ? "0" : "–";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-3) {
    const [mantissa, power] = value.toExponential(Math.min(digits - 1, 3)).split("e");
    const raised = [...power.replace("+", "")].map((c) => (c === "-" ? "⁻" : superscripts[c])).join("");
    const front = mantissa.replace(/\.?0+$/, "").replace("-", "−");
    return front === "1" ? `10${raised}` : `${front}·10${raised}`;
  }
  return String(Number(value.toPrecision(digits))).replace("-", "−");
}

const withUnit = (text, unit) => (unit ? `${text} ${unit}` : text);
