"""scenes/validation/README.md from results.json."""

from __future__ import annotations

from typing import Any

from cases import CASES

HEAD = """# Experiments

minamo against what others measured: our curves over their points, errors as numbers, the cost of each.
`tools/validate --experiments DIR` ran the scenes of this folder and wrote this page; `tools/validate --experiments DIR NAME`
replaces an experiment. The data are their authors' and not part of minamo: what DIR must hold stands below each picture.

- All settings but the cells are the defaults, or stand in the scene. Two were chosen with the measurements in view: the
  floor of the dry columns holds the water, and the pitched tank has 3 x 3 particles a cell and steps of 10 ms.
- *rms* is the root mean square of the difference over the largest measured value. Other figures are what ours is over
  theirs, less one; a delay is in units of the picture's axis.
- Curves are means over 1/200 of the time shown; pressures of single steps are noisier.
- Air is not computed: a cavity is empty, and closes without a cushion.
- *CPU time* is of all threads together, on the machine that is named with it.
"""


def number(value: float | None, unit: str) -> str:
    if value is None:
        return "none"
    return f"{value:+.1f} {unit}" if unit else f"{value:+.2f}"


def section(case: Any, stored: dict[str, Any], scene: str) -> list[str]:
    ours = [label for label, _ in case.resolutions]
    labels = ours + [label for label, _ in case.beside]
    name = scene.rpartition("/")[2].removesuffix(".json")
    lines = [f"## {case.title}", "", f"[{name}]({scene}). {case.paper}.", "", case.text, "",
             f"![{case.title}: computed and measured]({case.name}.png)", "",
             "| | " + " | ".join(labels) + " |", "|---" * (len(labels) + 1) + "|"]
    for k, figure in enumerate(case.figures):
        values = [number(stored[label]["figures"][k], figure.unit) for label in labels]
        lines.append(f"| {figure.curve}: {figure.what} | " + " | ".join(values) + " |")
    elsewhere = " |" * len(case.beside)
    for name, of in (("particles", lambda r: f"{r['particles']}"), ("steps", lambda r: f"{r['steps']}"),
                     (f"CPU time, {stored[ours[0]]['machine']}", lambda r: f"{r['cpu_s']:.3g} s")):
        lines.append(f"| {name} | " + " | ".join(of(stored[label]) for label in ours) + " |" + elsewhere)
    files = sorted({curve.file for curve in case.curves})
    return [*lines, "", "Our curves: [" + f"{case.name}.csv]({case.name}.csv). Measured: "
            + ", ".join(f"`{file}`" for file in files) + ".", ""]


def page(results: dict[str, Any], scene_of: Any) -> str:
    lines = [HEAD]
    for case in CASES:
        if case.name in results:
            lines += section(case, results[case.name], scene_of(case))
    return "\n".join(lines)
