"""What was computed, how, and what it took: the words and tables of the page."""

from __future__ import annotations

import json
from html import escape
from typing import Any

from reporting.runs import Run, labels

KINDS = ("done", "failed", "interrupted")
NOTHING = "–"


def headline(run: Run) -> str:
    """The run in a line."""
    summary, kind = run.summary, run.status if run.status in KINDS else "unfinished"
    words = [f"<b class=\"{kind}\">{escape(run.status)}</b>", escape(str(run.folder))]
    if summary:
        words += [f"{summary['time']:.4g} s in {summary['steps']} steps", f"{summary['particles']} particles",
                  f"{duration(summary['wall_s'])} on {_threads(summary)}"]
    return f"<div class=\"headline\">{' · '.join(words)}</div>"


def messages(runs: list[Run]) -> str:
    """What went wrong, in the words of the program, and what is not there."""
    found = []
    for run in runs:
        if run.summary.get("message"):
            found.append(f"<pre class=\"failed\">{escape(str(run.folder))}: {escape(run.summary['message'])}</pre>")
        missing = [*run.problems]
        if not run.summary:
            missing.append("no summary.json: the run is still going on, or was killed")
        if len(run.times) == 0 and not run.problems:
            missing.append("no frame in fields.h5: no particles to show")
        if not run.history:
            missing.append("no rows in history.csv: no histories")
        found += [f"<p class=\"failed\">{escape(str(run.folder))}: {escape(text)}.</p>" for text in missing]
    return "\n".join(found)


def duration(seconds: float) -> str:
    """Seconds as they are read: 0.21 s, 19 s, 3 min 20 s, 2 h 5 min."""
    if seconds < 100:
        return f"{seconds:.3g} s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes < 100 else f"{minutes // 60} h {minutes % 60} min"


def _threads(summary: dict[str, Any]) -> str:
    return f"{summary['threads']} thread{'s'[:summary['threads'] != 1]}"


def liquid(of: dict[str, Any]) -> str:
    flow = f"{of['viscosity']:g} Pa s" if "viscosity" in of else " ".join(of["rheology"].keys() - {"iterations"})
    return f"{of['density']:g} kg/m³, {flow}"


def liquids(scene: dict[str, Any]) -> str:
    """The liquid, or the several by name."""
    if "fluid" in scene:
        return liquid(scene["fluid"])
    return "; ".join(f"{name}: {liquid(of)}" for name, of in scene["fluids"].items())


def facts(run: Run) -> dict[str, str]:
    """Name and value of what is worth telling."""
    scene, summary = run.scene, run.summary
    cells = " × ".join(str(count) for count in scene["grid"]["cells"])
    found = {"Status": run.status}
    found |= {name: scheme(scene.get(name.lower(), {}))
              for name in ("Transfer", "Integrator", "Stabilization", "Volume", "Solver")}
    found |= {
        "Grid": f"{cells} cells of {1e3 * run.spacing:.4g} mm",
        "Walls": short(scene.get("walls", "")),
        "Liquid": liquids(scene),
        "Body force": f"{short(scene.get('body_force', ''))} m/s²",
        "Time step": f"{scene['time']['step']:g} s" if "step" in scene["time"] else f"CFL {scene['time']['cfl']:g}",
    }
    return found | (_cost(run) if summary else {})


def _cost(run: Run) -> dict[str, str]:
    summary = run.summary
    wall, steps = summary["wall_s"], summary["steps"]
    particles = f"{summary['particles']}{' at the end' if run.scene.get('openings') else ''}"
    return {
        "Simulated": f"{summary['time']:.6g} s in {steps} steps",
        "Particles": f"{particles}, {run.per_cell} per cell and direction",
        "Unknowns": f"at most {summary['unknowns_max']}",
        "Wall time": f"{duration(wall)}, {1e3 * wall / max(1, steps):.3g} ms per step",
        "CPU time": f"{duration(summary['cpu_s'])} on {_threads(summary)}",
        "CPU": summary["cpu_model"],
        "Memory": f"{summary['peak_memory_bytes'] / 2**20:.0f} MiB",
        "Version": summary["version"],
    }


def scheme(block: dict[str, Any]) -> str:
    options = ", ".join(f"{key} {short(value)}" for key, value in block.items() if key != "scheme")
    return block.get("scheme", "") + (f" ({options})" if options else "")


def short(value: Any) -> str:
    """A value of the scene without the marks of JSON."""
    if isinstance(value, dict):
        return ", ".join(f"{key}: {short(entry)}" for key, entry in value.items())
    if isinstance(value, list):
        return "(" + ", ".join(short(entry) for entry in value) + ")"
    return f"{value:g}" if isinstance(value, float) else str(value)


def facts_list(run: Run) -> str:
    """The facts on one run, to stand next to its picture."""
    rows = "".join(f"<div><b>{name}</b><span>{escape(value)}</span></div>" for name, value in facts(run).items())
    return f"<div class=\"facts\">{rows}</div>"


def comparison_section(runs: list[Run]) -> str:
    """Of several runs: all keys of the scenes that differ, then facts, a column per run, rows that differ marked."""
    differing = differing_keys(runs)
    keys = table(["key of the scene", *labels(runs)], differing) if differing else "<p>The scenes are the same.</p>"
    columns = [facts(run) for run in runs]
    names = dict.fromkeys(name for column in columns for name in column)
    rows = [[name, *(column.get(name, NOTHING) for column in columns)] for name in names]
    return (f"<h2>What differs</h2><div id=\"differences\">{keys}</div>"
            f"<h2>Scenes</h2>{table(['', *labels(runs)], rows, mark=True)}")


def table(head: list[str], rows: list[list[str]], mark: bool = False) -> str:
    """A table; `mark` marks the rows whose values differ."""
    marked = [" class=\"differs\"" if mark and len(set(row[1:])) > 1 else "" for row in rows]
    lines = ["<tr>" + "".join(f"<th>{escape(name)}</th>" for name in head) + "</tr>"]
    for each, (name, *values) in zip(marked, rows):
        cells = "".join(f"<td>{escape(value)}</td>" for value in values)
        lines.append(f"<tr{each}><th>{escape(name)}</th>{cells}</tr>")
    return f"<div class=\"wide\"><table>{''.join(lines)}</table></div>"


def differing_keys(runs: list[Run]) -> list[list[str]]:
    """Pointer and values of every key whose value is not the same in all scenes."""
    flat = [dict(_leaves(run.scene, "")) for run in runs]
    pointers = dict.fromkeys(pointer for leaves in flat for pointer in leaves)
    rows = [[pointer, *(leaves.get(pointer, NOTHING) for leaves in flat)] for pointer in pointers]
    return [row for row in rows if len(set(row[1:])) > 1]


def _leaves(value: Any, pointer: str) -> list[tuple[str, str]]:
    """Pointers and values; a list of numbers or words is one value."""
    if isinstance(value, dict):
        return [leaf for key, entry in value.items() for leaf in _leaves(entry, f"{pointer}/{key}")]
    if isinstance(value, list) and any(isinstance(entry, (dict, list)) for entry in value):
        return [leaf for k, entry in enumerate(value) for leaf in _leaves(entry, f"{pointer}/{k}")]
    return [(pointer, json.dumps(value))]


def balance_section(runs: list[Run]) -> str:
    """What is conserved but for walls, body force and viscosity: at the start, at the end, the difference; errors."""
    head = "<th></th><th></th>" + "".join(f"<th class=\"number\">{name}</th>" for name in ("start", "end", "change"))
    names = labels(runs) if len(runs) > 1 else [""]
    rows = "".join(_balance_rows(run, name) for run, name in zip(runs, names) if run.summary.get("conservation"))
    if not rows:
        return ""
    return f"<h2>Start and end</h2><div class=\"wide\" id=\"balance\"><table><tr>{head}</tr>{rows}</table></div>"


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
    rows += [(f"error of the {field}, against the exact solution", "", None, value)
             for field, value in run.summary.get("errors", {}).items()]
    return "".join(_balance_row(label if k == 0 else "", *row) for k, row in enumerate(rows))


def _balance_row(label: str, name: str, unit: str, start: float | None, end: float | None) -> str:
    cells = ["" if value is None else f"{value:.6g}" for value in (start, end)]
    cells.append("" if start is None or end is None else f"{end - start:+.3g}")
    numbers = "".join(f"<td class=\"number\">{cell}</td>" for cell in cells)
    return f"<tr><th>{escape(label)}</th><td>{name}{f' [{unit}]' if unit else ''}</td>{numbers}</tr>"


def scene_files(runs: list[Run]) -> str:
    return "<h2>Scene files as run</h2>" + "".join(
        f"<details><summary>{escape(str(run.folder))}/scene.json</summary>"
        f"<pre>{escape(json.dumps(run.scene, indent=1, ensure_ascii=False))}</pre></details>" for run in runs)
