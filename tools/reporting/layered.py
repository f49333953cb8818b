"""A graph as SVG without Graphviz: layer under layer, with the names and nesting of dot, so that a page takes both."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import Any

WARM = "#e66100"
ROW, GAP, LINE, LETTER = 58, 16, 13, 6.4  # between layers, between nodes, of a line of text, of a letter [pixels]


@dataclass(frozen=True)
class Node:
    """A system in the drawing."""

    name: str
    lines: list[str]
    tooltip: str
    warmth: float  # 0 ... 1

    @property
    def width(self) -> float:
        return 16 + LETTER * max(map(len, self.lines))

    @property
    def height(self) -> float:
        return 8 + LINE * len(self.lines)


def draw_layered(nodes: list[Node], edges: list[dict[str, Any]]) -> str:
    """Nodes as deep as the longest way to them; edges lead from earlier to later nodes, as those of a schedule do."""
    pairs = [(edge["from"], edge["to"]) for edge in edges]
    layers = _ordered(_layers(len(nodes), pairs), pairs)
    widths = [sum(nodes[k].width + GAP for k in layer) for layer in layers]
    place: dict[int, tuple[float, float]] = {}
    for depth, (layer, width) in enumerate(zip(layers, widths)):
        x = 0.5 * (max(widths) - width)
        for k in layer:
            place[k] = x + 0.5 * (nodes[k].width + GAP), ROW * (depth + 0.5)
            x += nodes[k].width + GAP
    size = f"{max(widths):.0f} {ROW * len(layers)}"
    width, height = size.split()
    parts = [f'<svg width="{width}" height="{height}" viewBox="0 0 {size}"><g class="graph">']
    parts += [_edge(edge, nodes, place) for edge in edges]
    parts += [_node(k, node, *place[k]) for k, node in enumerate(nodes)]
    return "".join([*parts, "</g></svg>"])


def _layers(count: int, pairs: list[tuple[int, int]]) -> list[list[int]]:
    depth = [0] * count
    for start, end in sorted(pairs):
        depth[end] = max(depth[end], depth[start] + 1)
    return [[k for k in range(count) if depth[k] == layer] for layer in range(max(depth, default=0) + 1)]


def _ordered(layers: list[list[int]], pairs: list[tuple[int, int]]) -> list[list[int]]:
    """Every node near the mean place of those it has edges with; a few sweeps settle that."""
    near: dict[int, list[int]] = {k: [] for layer in layers for k in layer}
    for start, end in pairs:
        near[start].append(end)
        near[end].append(start)
    place = {k: (at + 0.5) / len(layer) for layer in layers for at, k in enumerate(layer)}
    for _ in range(8):
        for layer in layers:
            layer.sort(key=lambda k: sum(place[other] for other in near[k]) / len(near[k]) if near[k] else place[k])
            place |= {k: (at + 0.5) / len(layer) for at, k in enumerate(layer)}
    return layers


def _node(index: int, node: Node, x: float, y: float) -> str:
    box = (f'x="{x - node.width / 2:.1f}" y="{y - node.height / 2:.1f}" width="{node.width:.1f}" '
           f'height="{node.height:.1f}" rx="5"')
    first = y - LINE * (len(node.lines) - 1) / 2 + 4
    texts = "".join(f'<text text-anchor="middle" x="{x:.1f}" y="{first + LINE * k:.1f}" font-size="11">'
                    f"{escape(line)}</text>" for k, line in enumerate(node.lines))
    return (f'<g id="{escape(node.name)}" class="node system"><title>s{index}</title>'
            f'<a xlink:title="{escape(node.tooltip)}"><rect class="paper" {box}/>'
            f'<rect class="box" fill="{WARM}" fill-opacity="{node.warmth:.3f}" {box}/>'
            f"{texts}</a></g>")


def _edge(edge: dict[str, Any], nodes: list[Node], place: dict[int, tuple[float, float]]) -> str:
    start, end = edge["from"], edge["to"]
    (x0, y0), (x1, y1) = place[start], place[end]
    y0, y1 = y0 + nodes[start].height / 2, y1 - nodes[end].height / 2
    bend, data = 0.4 * (y1 - y0), ", ".join(edge["components"])
    curve = f"M{x0:.1f},{y0:.1f}C{x0:.1f},{y0 + bend:.1f} {x1:.1f},{y1 - bend:.1f} {x1:.1f},{y1 - 6:.1f}"
    return (f'<g class="edge data"><title>s{start}-&gt;s{end}</title><a xlink:title="{escape(data)}">'
            f'<path fill="none" d="{curve}"/>'
            f'<polygon points="{x1 - 3:.1f},{y1 - 7:.1f} {x1 + 3:.1f},{y1 - 7:.1f} {x1:.1f},{y1:.1f}"/></a></g>')
