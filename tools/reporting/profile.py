"""Where the wall time went: a bar per system and run."""

from __future__ import annotations

from html import escape
from typing import Any

from reporting.runs import Run, labels

MOST = 14  # bars; the other systems share the last one
COLOURS = 7  # --curve-0 ... of page/page.css


def profile_section(runs: list[Run]) -> str:
    """The dearest systems first, in seconds and as a share of the wall time of their run."""
    rows = [{row["name"]: row for row in run.summary.get("systems", [])} for run in runs]
    if not any(rows):
        return ""
    names = sorted({name for each in rows for name in each}, key=lambda name: -max(_seconds(e, name) for e in rows))
    groups = [(name, [name]) for name in names[:MOST]]
    if names[MOST:]:
        groups.append((f"{len(names) - MOST} others", names[MOST:]))
    groups.append(("outside of all systems", []))
    bars = [[_bar(run, each, members) for run, each in zip(runs, rows)] for _, members in groups]
    most = max(seconds for group in bars for seconds, _ in group) or 1.0
    body = "".join(_group(name, group, most) for (name, _), group in zip(groups, bars))
    return f"<h2>Wall time of the systems</h2>{_legend(runs)}<table class=\"profile\">{body}</table>"


def _seconds(rows: dict[str, Any], name: str) -> float:
    return rows[name]["seconds"] if name in rows else 0.0


def _bar(run: Run, rows: dict[str, Any], members: list[str]) -> tuple[float, float]:
    """Seconds and share of some systems; of no system, what is left of the wall time."""
    wall = run.summary.get("wall_s", 0.0)
    if members:
        seconds = sum(_seconds(rows, name) for name in members)
    else:
        seconds = max(0.0, wall - sum(row["seconds"] for row in rows.values()))
    return seconds, seconds / wall if wall > 0 else 0.0


def _group(name: str, bars: list[tuple[float, float]], most: float) -> str:
    lines = []
    for k, (seconds, share) in enumerate(bars):
        first = f"<td rowspan=\"{len(bars)}\">{escape(name)}</td>" if k == 0 else ""
        colour = f"background:var(--curve-{k % COLOURS})"
        bar = f"<div class=\"bar\" style=\"width:{100 * seconds / most:.2f}%;{colour}\"></div>"
        numbers = f"<td class=\"number\">{seconds:.3g} s</td><td class=\"number\">{100 * share:.1f} %</td>"
        lines.append(f"<tr>{first}{numbers}<td class=\"bars\">{bar}</td></tr>")
    return "".join(lines)


def _legend(runs: list[Run]) -> str:
    if len(runs) == 1:
        return ""
    marks = [f"<span style=\"color:var(--curve-{k % COLOURS})\">■</span> {escape(label)}"
             for k, label in enumerate(labels(runs))]
    return f"<p>{' &nbsp; '.join(marks)}</p>"
