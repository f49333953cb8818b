"""report.html: one file with tables and pictures, nothing to load."""

from __future__ import annotations

import base64
import json
from html import escape
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from figuring.layout import png
from figuring.plots import draw_history, draw_systems
from figuring.strips import Strip, draw_strip
from reporting.runs import Run, labels

STYLE = """
body { font: 15px/1.45 system-ui, "DejaVu Sans", sans-serif; color: #222;
       max-width: 1040px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.5em; margin: 0 0 .2em; }
h2 { font-size: 1.1em; margin: 1.8em 0 .5em; padding-bottom: .2em; border-bottom: 1px solid #ddd; }
h3 { font-size: 1em; margin: 1em 0 .2em; }
img { width: 100%; }
table { border-collapse: collapse; width: 100%; font-size: .92em; }
th, td { text-align: left; padding: .22em 1.2em .22em 0; border-bottom: 1px solid #eee; vertical-align: top; }
th { font-weight: 600; }
td.number { text-align: right; font-variant-numeric: tabular-nums; }
th.number { text-align: right; }
tr.differs td { background: #fff6e0; }
.facts { columns: 2; column-gap: 3em; }
.facts div { break-inside: avoid; border-bottom: 1px solid #eee; display: flex; padding: .2em 0; }
.facts b { flex: 0 0 9em; font-weight: 600; }
.key { color: #555; }
.done { color: #177a3d; } .failed, .interrupted, .unknown { color: #b3261e; }
pre { background: #f6f6f6; padding: .8em; overflow-x: auto; font-size: .85em; }
summary { cursor: pointer; color: #555; }
"""


def write_page(path: Path, runs: list[Run], strips: list[Strip]) -> None:
    """Writes the page on these runs."""
    title = runs[0].title if len(runs) == 1 else "Comparison: " + ", ".join(labels(runs))
    parts = [f"<h1>{escape(title)}</h1>", *map(_headline, runs), *_failures(runs), "<h2>Scene</h2>", _scene(runs),
             *_pictures(strips), *_section("History", draw_history(runs)), "<h2>Start and end</h2>", _balance(runs),
             *_section("Wall time of the systems", draw_systems(runs)), *_files(runs)]
    path.write_text("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
                    f"<title>{escape(title)}</title>\n<style>{STYLE}</style></head>\n<body>\n" + "\n".join(parts)
                    + "\n</body></html>\n", encoding="utf-8")


def _headline(run: Run) -> str:
    """The run in a line."""
    summary, kind = run.summary, run.status if run.status in ("done", "failed", "interrupted") else "unknown"
    words = [f"<b class=\"{kind}\">{escape(run.status)}</b>", escape(str(run.folder))]
    if summary:
        words += [f"{summary['time']:.4g} s in {summary['steps']} steps", f"{summary['particles']} particles",
                  f"{duration(summary['wall_s'])} on {summary['threads']} thread{'s'[:summary['threads'] != 1]}"]
    return f"<div class=\"key\">{' · '.join(words)}</div>"


def _failures(runs: list[Run]) -> list[str]:
    messages = [run.summary["message"] for run in runs if run.summary.get("message")]
    return [f"<pre class=\"failed\">{escape(message)}</pre>" for message in messages]


def duration(seconds: float) -> str:
    """Seconds as they are read: 0.21 s, 19 s, 3 min 20 s, 2 h 5 min."""
    if seconds < 100:
        return f"{seconds:.3g} s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes < 100 else f"{minutes // 60} h {minutes % 60} min"


def facts(run: Run) -> dict[str, str]:
    """What was computed, how, and what it took."""
    scene, summary = run.scene, run.summary
    cells = " × ".join(str(count) for count in scene["grid"]["cells"])
    found = {
        "Status": run.status,
        "Transfer": _scheme(scene.get("transfer", {})),
        "Integrator": _scheme(scene.get("integrator", {})),
        "Stabilization": _scheme(scene.get("stabilization", {})),
        "Volume": _scheme(scene.get("volume", {})),
        "Solver": _scheme(scene.get("solver", {})),
        "Grid": f"{cells} cells of {1e3 * run.spacing:.4g} mm",
        "Walls": _short(scene.get("walls", "")),
        "Liquid": f"{scene['fluid']['density']:g} kg/m³, {scene['fluid']['viscosity']:g} Pa s",
        "Body force": f"{_short(scene.get('body_force', ''))} m/s²",
        "Time step": _time_step(scene["time"]),
    }
    if not summary:
        return found
    wall, steps = summary["wall_s"], summary["steps"]
    return found | {
        "Simulated": f"{summary['time']:.6g} s in {steps} steps",
        "Particles": f"{summary['particles']}, {scene['particles'][0].get('per_cell')} per cell and direction",
        "Unknowns": f"at most {summary['unknowns_max']}",
        "Wall time": f"{duration(wall)}, {1e3 * wall / max(1, steps):.3g} ms per step",
        "CPU time": f"{duration(summary['cpu_s'])} on {summary['threads']} thread{'s'[:summary['threads'] != 1]}",
        "CPU": summary["cpu_model"],
        "Memory": f"{summary['peak_memory_bytes'] / 2**20:.0f} MiB",
        "Version": summary["version"],
    }


def _scheme(block: dict[str, Any]) -> str:
    options = ", ".join(f"{key} {_short(value)}" for key, value in block.items() if key != "scheme")
    return block.get("scheme", "") + (f" ({options})" if options else "")


def _short(value: Any) -> str:
    """A value of the scene without the marks of JSON."""
    if isinstance(value, dict):
        return ", ".join(f"{key}: {_short(entry)}" for key, entry in value.items())
    if isinstance(value, list):
        return "(" + ", ".join(_short(entry) for entry in value) + ")"
    return f"{value:g}" if isinstance(value, float) else str(value)


def _time_step(time: dict[str, Any]) -> str:
    return f"{time['step']:g} s" if "step" in time else f"CFL {time['cfl']:g}"


def _scene(runs: list[Run]) -> str:
    """One run: facts in two columns. Several: a column each, rows that differ marked."""
    if len(runs) == 1:
        rows = "".join(f"<div><b>{name}</b><span>{escape(value)}</span></div>"
                       for name, value in facts(runs[0]).items())
        return f"<div class=\"facts\">{rows}</div>"
    columns = [facts(run) for run in runs]
    names = dict.fromkeys(name for column in columns for name in column)
    head = "".join(f"<th>{escape(label)}</th>" for label in labels(runs))
    return f"<table><tr><th></th>{head}</tr>{''.join(_row(name, columns) for name in names)}</table>"


def _row(name: str, columns: list[dict[str, str]]) -> str:
    values = [column.get(name, "") for column in columns]
    mark = " class=\"differs\"" if len(set(values)) > 1 else ""
    return f"<tr{mark}><th>{name}</th>{''.join(f'<td>{escape(value)}</td>' for value in values)}</tr>"


def _pictures(strips: list[Strip]) -> list[str]:
    if all(len(run.times) == 0 for run in strips[0].runs):
        return []
    found = ["<h2>Particles</h2>"]
    for strip in strips:
        caption = f"Coloured by {strip.field.name}"
        found += [f"<h3>{caption}</h3>", _image(draw_strip(strip), caption)]
    return found


def _section(title: str, figure: Figure | None) -> list[str]:
    return [f"<h2>{title}</h2>", _image(figure, title)] if figure else []


def _image(figure: Figure, text: str) -> str:
    return f"<img alt=\"{escape(text)}\" src=\"data:image/png;base64,{base64.b64encode(png(figure)).decode()}\">"


def _balance(runs: list[Run]) -> str:
    """What is conserved but for walls, body force and viscosity: at the start, at the end, the difference."""
    head = "<th></th><th></th>" + "".join(f"<th class=\"number\">{name}</th>" for name in ("start", "end", "change"))
    names = labels(runs) if len(runs) > 1 else [""]
    rows = "".join(_balance_rows(run, name) for run, name in zip(runs, names) if run.summary)
    return f"<table><tr>{head}</tr>{rows}</table>" if rows else "<p>No summary.json yet.</p>"


def _balance_rows(run: Run, label: str) -> str:
    balance, per_metre = run.summary["conservation"], "/m" if run.dimension == 2 else ""
    rows = [("mass", f"kg{per_metre}", None, balance["mass"]),
            ("energy", f"J{per_metre}", balance["initial"]["energy"], balance["energy"])]
    rows += [(f"momentum {axis}", f"N s{per_metre}", start, end) for axis, start, end in
             list(zip("xyz", balance["initial"]["momentum"], balance["momentum"]))[:run.dimension]]
    turning = ["angular momentum"] if run.dimension == 2 else [f"angular momentum {axis}" for axis in "xyz"]
    rows += [(name, f"J s{per_metre}", start, end) for name, start, end in
             zip(turning, balance["initial"]["angular_momentum"], balance["angular_momentum"])]
    rows += [("largest overlap / volume", "1", None, balance["overlap_max"])]
    rows += [(f"error of the {field}", "", None, value) for field, value in run.summary.get("errors", {}).items()]
    return "".join(_balance_row(label if k == 0 else "", *row) for k, row in enumerate(rows))


def _balance_row(label: str, name: str, unit: str, start: float | None, end: float) -> str:
    cells = ["" if value is None else f"{value:.6g}" for value in (start, end)]
    cells.append("" if start is None else f"{end - start:+.3g}")
    numbers = "".join(f"<td class=\"number\">{cell}</td>" for cell in cells)
    return f"<tr><th>{escape(label)}</th><td>{name}{f' [{unit}]' if unit else ''}</td>{numbers}</tr>"


def _files(runs: list[Run]) -> list[str]:
    return ["<h2>Scene files as run</h2>"] + [
        f"<details><summary>{escape(str(run.folder))}/scene.json</summary>"
        f"<pre>{escape(json.dumps(run.scene, indent=1))}</pre></details>" for run in runs]
