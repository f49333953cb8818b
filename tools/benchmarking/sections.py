"""What stands below the table of a section: ratios, fits, comparison with other programs."""

from __future__ import annotations

from math import log
from typing import Any

from layout import digits, table

Row = dict[str, Any]

TITLES = {
    "both": "Conforming and equal order",
    "size": "Cost against size",
    "space": "Three dimensions",
    "solvers": "Block solver and UMFPACK",
    "assembly": "Assembly against particles per cell",
    "kernels": "Kernels",
}

# CPU seconds per simulated second of the same dam break, 4 particles per cell, on one core of an AMD EPYC (Zen 4).
PEERS = {
    "40": {"interFoam": 2.4, "apic2d": 0.060, "MLS-MPM": 0.077},
    "80": {"interFoam": 23, "apic2d": 0.32, "MLS-MPM": 0.61},
}
PEERS_TEXT = """\
CPU seconds per simulated second of conforming, compared with three other codes with as many cells and particles: OpenFOAM's
interFoam, apic2d (APIC, projection, CFL number 3, float) and an explicit, weakly compressible MLS-MPM (CFL number 0.7).
Theirs were measured once, on one core of an AMD EPYC (Zen 4). A ratio above 1 means that theirs takes longer. More
codes are in [scenes/COMPARISON.md](../../scenes/COMPARISON.md).
"""
DISTANCE_TEXT = """\
Distance from interFoam on 160 x 160 cells (`tools/compare_interfoam.py`: the area that is water in only one of the two,
over the area of the water), at output times within 2 ms of the reference's:
"""
SYSTEMS_TEXT = """
Where a step of {run} goes: time of a system per particle and step, while others may run on other threads; bytes of the
columns that it declares, twice of those that it updates; and these over its time. What memory can do is *triad* among
the kernels below: a system near it wants fewer bytes, one far from it less arithmetic.

"""
# Of these the systems that a run has.
ASSEMBLY = ("find_full_nodes", "find_filled_nodes", "moments", "moments_mixed", "divergence_matrix", "laplacian_matrix",
            "viscosity_matrix", "right_hand_side", "add_inertia_correction")
METHODS = ("conforming", "equal order")


def per_simulated_second(row: Row) -> float:
    return row["cpu_s"] / row["time"]


def pairs(rows: list[Row]) -> list[tuple[str, Row, Row]]:
    """Label, row of conforming and row of equal order of each case."""
    return [(conforming["label"].removesuffix(", conforming"), conforming, equal)
            for conforming, equal in zip(rows[::2], rows[1::2])]


def thread_lines(rows: list[Row], what: str, name: str) -> str:
    """How much faster a step is on two threads, for runs whose labels differ in the number of threads alone.

    `what` begins the labels, `name` is for the reader.
    """
    by_label = {row["label"]: row for row in rows}
    lines = []
    for method in METHODS:
        pair = [by_label.get(f"{what}, {threads}, {method}") for threads in ("1 thread", "2 threads")]
        if all(pair):
            lines.append(f"\nWith {method} a step of {name} is {pair[0]['step_s'] / pair[1]['step_s']:.2f} times as fast "
                         "on two threads as on one.\n")
    return "".join(lines)


def ratios(rows: list[Row]) -> str:
    lines = [[label, *(digits(per_simulated_second(row)) for row in (conforming, equal)),
              *(f"{equal[key] / conforming[key]:.1f}" for key in ("cpu_s", "step_s"))]
             for label, conforming, equal in pairs(rows)]
    head = ["run", "conforming: CPU per simulated second [s]", "equal order", "ratio", "ratio of a step"]
    return ("Conforming compared with equal order. The ratios are by how many times equal order takes longer: CPU time of the run with\n"
            "start and output, wall time of a step.\n\n"
            + table(head, lines))


def beside_peers(rows: list[Row]) -> str:
    lines = []
    for label, conforming, _ in pairs(rows):
        peers = PEERS.get(label.split()[0])
        if peers is None:
            continue
        ours = per_simulated_second(conforming)
        lines.append([label, digits(ours)] + [f"{digits(theirs)}: {digits(theirs / ours)}"
                                              for theirs in peers.values()])
    head = ["run", "minamo [s]", "interFoam: ratio", "apic2d: ratio", "MLS-MPM: ratio"]
    return f"\n{PEERS_TEXT}\n" + table(head, lines) if lines else ""


def from_interfoam(rows: list[Row]) -> str:
    compared = [row for row in rows if row.get("distances")]
    times = sorted({time for row in compared for time in row["distances"]}, key=float)
    if not times:
        return ""
    lines = [[row["label"], *(f"{row['distances'][time]:.3f}" if time in row["distances"] else "" for time in times)]
             for row in compared]
    return f"\n{DISTANCE_TEXT}\n" + table(["run", *(f"{time} s" for time in times)], lines)


def below_both(rows: list[Row]) -> str:
    return ratios(rows) + thread_lines(rows, "large", "the large tank") + beside_peers(rows) + from_interfoam(rows)


def below_solvers(rows: list[Row]) -> str:
    lines = []
    for block, direct in zip(rows[::2], rows[1::2]):
        difference = direct["difference"]
        lines.append([block["label"].removesuffix(", block"), digits(1e3 * block["step_s"]),
                      digits(1e3 * direct["step_s"]), f"{direct['step_s'] / block['step_s']:.2f}",
                      f"{difference['kinetic_energy']:.1e}", f"{difference['potential_energy']:.1e}"])
    return ("Ratio of the medians of whole steps, and largest relative difference of the energies in history.csv:\n\n"
            + table(["run", "block [ms]", "UMFPACK [ms]", "ratio", "kinetic", "potential"], lines))


def slope(points: list[tuple[float, float]]) -> float:
    """Exponent of the power law nearest to the points, by least squares of the logarithms."""
    x, y = ([log(point[k]) for point in points] for k in (0, 1))
    x_mean, y_mean = sum(x) / len(x), sum(y) / len(y)
    return sum((a - x_mean) * (b - y_mean) for a, b in zip(x, y)) / sum((a - x_mean) ** 2 for a in x)


def below_size(rows: list[Row]) -> str:
    lines = []
    for method, of_method in zip(METHODS, (rows[::2], rows[1::2])):
        if len(of_method) < 2:
            continue
        points = [(row["unknowns_max"], row["step_s"]) for row in of_method]
        least, most = of_method[0], of_method[-1]
        added = (most["peak_memory_bytes"] - least["peak_memory_bytes"]) / (most["particles"] - least["particles"])
        lines.append(f"With {method} a step costs as (unknowns)^{slope(points):.2f}, fitted over all sizes; "
                     f"^{slope(points[-2:]):.2f} over the two largest. Memory that a particle adds: {added:.0f} bytes.\n")
    return "\n".join(lines)


def below_assembly(rows: list[Row]) -> str:
    if len(rows) < 2:
        return ""
    names = [name for name in ASSEMBLY if name in rows[0]["systems"]]
    lines = []
    for name in [*names, "all"]:
        costs = [sum(row["systems"][n] for n in (names if name == "all" else [name])) / row["steps"] for row in rows]
        lines.append([name, *(digits(1e6 * cost) for cost in costs), f"{costs[1] / costs[0]:.2f}"])
    return ("Microseconds per step, and the ratio for nine times as many particles on the same cells:\n\n"
            + table(["system", "2 x 2", "6 x 6", "ratio"], lines))


def systems_of(row: Row) -> str:
    """What every system of a step takes, and how fast the columns come that it declares; empty for older results."""
    if "declared_bytes" not in row:
        return ""
    calls = row["particles"] * row["steps"]
    lines = [[name, digits(1e9 * seconds / calls), digits(row["declared_bytes"][name] / calls),
              digits(1e-9 * row["declared_bytes"][name] / seconds)]
             for name, seconds in sorted(row["systems"].items(), key=lambda one: -one[1]) if seconds > 0.005 * row["wall_s"]]
    return SYSTEMS_TEXT.format(run=row["label"]) + table(["system", "ns", "bytes", "GB/s"], lines)


def below_space(rows: list[Row]) -> str:
    lines = [[row["label"], str(row["particles"]), digits(row["step_s"]), digits(1e6 * row["step_s"] / row["particles"])]
             for row in rows]
    grids = dict.fromkeys(row["label"].split(",")[0] for row in rows)
    return (table(["run", "particles", "seconds per step", "us per particle and step"], lines)
            + "".join(thread_lines(rows, grid, grid) for grid in grids)
            + systems_of(max((row for row in rows if row["label"].endswith("conforming")), key=lambda row: row["particles"])))


BELOW = {"both": below_both, "size": below_size, "space": below_space, "solvers": below_solvers,
         "assembly": below_assembly}
KERNEL_HEAD = """
The bytes and operations that a kernel needs at least, by the formulas in [work.hpp](work.hpp), over its time. *Of
triad*: share of the bandwidth of a = b + s c over as many bytes. *Of peak*: share of the peak of fused multiply-adds.
Both are measured in the same run on as many threads. Kernels multiply and add separately, so they can reach half of that peak.
*Rows* are particles for transfers and moments, nodes for matrices and the solve.
"""
