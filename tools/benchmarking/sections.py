"""What stands below the table of a section: ratios, fits, comparison with other programs."""

from __future__ import annotations

from math import log
from typing import Any

from layout import digits, table

Row = dict[str, Any]

TITLES = {
    "both": "Conforming and equal order",
    "dam_break": "Dam break with equal order, beside other codes",
    "threads": "Two threads",
    "solvers": "Block solver and UMFPACK",
    "size": "Cost against size",
    "assembly": "Assembly against particles per cell",
    "space": "Three dimensions",
    "kernels": "Kernels",
}

# CPU seconds per simulated second of the same dam break, 4 particles per cell, on one core of an AMD EPYC (Zen 4).
PEERS = {
    "40": {"interFoam": 2.4, "apic2d": 0.060, "MLS-MPM": 0.077},
    "80": {"interFoam": 23, "apic2d": 0.32, "MLS-MPM": 0.61},
}
PEERS_TEXT = """\
CPU seconds per simulated second, beside three other codes with as many cells and particles: OpenFOAM's interFoam,
apic2d (APIC, projection, CFL number 3, float) and an explicit, weakly compressible MLS-MPM (CFL number 0.7). Theirs were
measured once, on one core of an AMD EPYC (Zen 4). A ratio above 1 means that theirs takes longer. More codes are in
[scenes/COMPARISON.md](../../scenes/COMPARISON.md).
"""
DISTANCE_TEXT = """\
Distance from interFoam on 160 x 160 cells (`tools/compare_interfoam.py`: the area that is water in only one of the two,
over the area of the water), at output times within 2 ms of the reference's:
"""
# Of these the systems that a run has.
ASSEMBLY = ("find_full_nodes", "find_filled_nodes", "moments", "moments_mixed", "divergence_matrix", "laplacian_matrix",
            "viscosity_matrix", "stabilize_pspg", "right_hand_side", "right_hand_side_viscous",
            "add_inertia_correction")


def per_simulated_second(row: Row) -> float:
    return row["cpu_s"] / row["time"]


def below_both(rows: list[Row]) -> str:
    lines = []
    for conforming, equal in zip(rows[::2], rows[1::2]):
        times = sorted(set(conforming.get("distances", {})) & set(equal.get("distances", {})), key=float)
        at = "0.8" if "0.8" in times else None
        lines.append([conforming["label"].removesuffix(", conforming"),
                      *(digits(per_simulated_second(row)) for row in (conforming, equal)),
                      *(f"{equal[key] / conforming[key]:.1f}" for key in ("cpu_s", "step_s")),
                      *(f"{row['distances'][at]:.3f}" if at else "" for row in (conforming, equal))])
    head = ["run", "conforming: CPU per simulated second [s]", "equal order", "ratio", "ratio of a step",
            "conforming: distance from interFoam at 0.8 s", "equal order"]
    text = ("Conforming beside equal order. The ratios are by how many times equal order takes longer: CPU time of the run with\n"
            "start and output, wall time of a step.\n\n"
            + table(head, lines))
    by_label = {row["label"]: row for row in rows}
    for name in ("conforming", "equal order"):
        pair = [by_label.get(f"large, {threads}, {name}") for threads in ("1 thread", "2 threads")]
        if all(pair):
            text += (f"\nWith {name} a step of the large tank is {pair[0]['step_s'] / pair[1]['step_s']:.2f} times as "
                     "fast on two threads as on one.\n")
    return text


def below_dam_break(rows: list[Row]) -> str:
    lines = []
    for row in rows:
        peers = PEERS[row["label"].split()[0]]
        ours = per_simulated_second(row)
        lines.append([row["label"], digits(ours)] + [f"{digits(theirs)}: {digits(theirs / ours)}"
                                                     for theirs in peers.values()])
    head = ["run", "minamo [s]", "interFoam: ratio", "apic2d: ratio", "MLS-MPM: ratio"]
    text = f"{PEERS_TEXT}\n" + table(head, lines)
    compared = [row for row in rows if row.get("distances")]
    times = sorted({time for row in compared for time in row["distances"]}, key=float)
    if times:
        shares = [[f"{row['distances'][time]:.3f}" if time in row["distances"] else "" for time in times]
                  for row in compared]
        text += f"\n{DISTANCE_TEXT}\n" + table(["run", *(f"{time} s" for time in times)],
                                              ([row["label"], *share] for row, share in zip(compared, shares)))
    return text


def below_threads(rows: list[Row]) -> str:
    one, two = ([row for row in rows if row["threads"] == n and row["steps"] <= 250] for n in (1, 2))
    if not one or not two:
        return ""
    differ = any(two[0]["difference"].values())
    return (f"A step on two threads is {one[0]['step_s'] / two[0]['step_s']:.2f} times as fast as on one. "
            f"Energies in history.csv {'differ' if differ else 'are the same to the last digit'}.\n")


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
    if len(rows) < 2:
        return ""
    exponent = slope([(row["unknowns_max"], row["step_s"]) for row in rows])
    last = slope([(row["unknowns_max"], row["step_s"]) for row in rows[-2:]])
    most = rows[-1]
    added = (most["peak_memory_bytes"] - rows[0]["peak_memory_bytes"]) / (most["particles"] - rows[0]["particles"])
    return (f"A step costs as (unknowns)^{exponent:.2f}, fitted over all sizes; ^{last:.2f} over the two largest. "
            f"Memory that a particle adds: {added:.0f} bytes.\n")


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


def below_space(rows: list[Row]) -> str:
    lines = [[row["label"], str(row["particles"]), f"{row['step_s']:.3f}",
              digits(1e6 * row["step_s"] / row["particles"])] for row in rows]
    return table(["run", "particles", "seconds per step", "us per particle and step"], lines)


BELOW = {"both": below_both, "dam_break": below_dam_break, "threads": below_threads, "solvers": below_solvers,
         "size": below_size, "assembly": below_assembly, "space": below_space}
KERNEL_HEAD = """
The bytes and operations that a kernel needs at least, by the formulas in [work.hpp](work.hpp), over its time. *Of
triad*: share of the bandwidth of a = b + s c over as many bytes. *Of peak*: share of the peak of fused multiply-adds.
Both are measured in the same run on as many threads. Kernels multiply and add separately, so they can reach half of that peak.
*Rows* are particles for transfers and moments, nodes for matrices and the solve.
"""
