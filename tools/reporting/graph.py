"""The graph of the systems of a run as SVG: `minamo graph` says what it is, Graphviz' dot, if any, where things go."""

from __future__ import annotations

import json
import shutil
import subprocess
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

from reporting.layered import WARM, Node, draw_layered
from reporting.runs import Run

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("build", "build/test")  # of tools/run and of tools/test
WARMEST = 0.3  # share of the wall time that gets the full colour


@dataclass(frozen=True)
class Drawing:
    """The graph, or why there is none."""

    svg: str = ""
    systems: tuple[dict[str, Any], ...] = ()  # name, access
    sentence: str = ""


def find_program(given: Path | None) -> Path | None:
    """What was given; else build/minamo, then build/test/minamo, next to tools/; else minamo of the PATH."""
    if given:
        return given
    built = [ROOT / folder / "minamo" for folder in FOLDERS]
    on_path = shutil.which("minamo")
    return next((program for program in built if program.is_file()), Path(on_path) if on_path else None)


def draw_graph(run: Run, program: Path | None) -> Drawing:
    """The graph of the systems of run's scene.json."""
    if program is None:
        return Drawing(sentence="No graph of the systems: there is no program at build/minamo, at build/test/minamo or "
                                "in the PATH. Call tools/run, or name the program with --program.")
    try:
        graph = json.loads(_output([str(program), "graph", str(run.folder / "scene.json"), "--format", "json"]))
    except (OSError, subprocess.CalledProcessError, json.JSONDecodeError) as problem:
        said = getattr(problem, "stderr", "") or str(problem)
        return Drawing(sentence=f"No graph of the systems: {program} graph says: {said.strip()}")
    draw = _by_dot if shutil.which("dot") else draw_layered
    return Drawing(draw(_nodes(graph, run), graph["edges"]), tuple(graph["systems"]))


def _output(command: list[str], text: str = "") -> str:
    return subprocess.run(command, input=text, capture_output=True, text=True, check=True, timeout=60).stdout


def _nodes(graph: dict[str, Any], run: Run) -> list[Node]:
    shares = {row["name"]: row["share"] for row in run.summary.get("systems", [])}
    return [_node(system, shares.get(system["name"])) for system in graph["systems"]]


def _node(system: dict[str, Any], share: float | None) -> Node:
    name = system["name"]
    lines = [name] if share is None else [name, f"{100 * share:.1f} %"]
    return Node(f"system-{name}", lines, describe(system), min(1.0, (share or 0.0) / WARMEST))


def _by_dot(nodes: list[Node], edges: list[dict[str, Any]]) -> str:
    """Colours come from page.css, by class; the warmth of a node from here."""
    lines = ["digraph systems {", "bgcolor=transparent; nodesep=0.18; ranksep=0.32;",
             'node [shape=box style="rounded,filled" fontname="Helvetica" fontsize=11 height=0.3 margin="0.1,0.04"];',
             "edge [arrowsize=0.6];"]
    lines += [f's{k} [id={_quoted(node.name)} class=system label={_quoted(chr(10).join(node.lines))} '
              f'tooltip={_quoted(node.tooltip)} fillcolor="{WARM}{round(255 * node.warmth):02x}"];'
              for k, node in enumerate(nodes)]
    lines += [f's{edge["from"]} -> s{edge["to"]} [class=data tooltip={_quoted(", ".join(edge["components"]))}];'
              for edge in edges]
    svg = _output(["dot", "-Tsvg"], "\n".join([*lines, "}"]))
    return svg[svg.index("<svg"):]


def describe(system: dict[str, Any]) -> str:
    """What a system reads and writes, a line per mode."""
    by_mode: dict[str, list[str]] = {}
    for access in system["access"]:
        by_mode.setdefault(access["mode"], []).append(access["component"] or f"rows of {access['table']}")
    return "\n".join([system["name"]] + [f"{mode}: {', '.join(names)}" for mode, names in by_mode.items()])


def _quoted(text: str) -> str:
    return '"' + escape(text, quote=False).replace('"', '\\"').replace("\n", "\\n") + '"'
