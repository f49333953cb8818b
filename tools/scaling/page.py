"""systems/ranks/SCALING.md from counts."""

from __future__ import annotations

from functools import cache

import numpy as np

from measure import STEPS
from model import (FACES_INSIDE, FACES_OF_OCTANT, NEIGHBOURS, Line, Machine, Measured, Model, fit, on_paper, played,
                   steps_of)

SIDES = (1, 2, 10, 22, 46)  # of cubes of ranks
SHARES = (100_000, 1_000_000)
WHOLE = 1_000_000_000
SERIES = {"weak": "weak scaling, dam_break_3d", "strong": "strong scaling, dam_break_3d",
          "bodies": "validation/box_in_the_way, bodies", "two": "two ranks, dam_break_3d"}

HEAD = """# Cost on many ranks

What a rank computes and sends in a step, counted on 1 to 8 ranks of one machine, and a model made from the counts for
10^3 to 10^5. `tools/scale` wrote this page; `tools/scale --again --latency SECONDS --bandwidth BYTES_PER_S` models another
network from the same counts. How ranks share a step is told [next to it](README.md).

## What is counted

Per rank and step, the mean of steps {first} to {last} of a run. *Compute* is processor time outside of MPI: it does not
depend on who waits for whom, so that eight ranks on two cores show it, if with caches that they share. *Messages*, their
*MB*, and *collectives* (sums, broadcasts, barriers) are all calls of MPI, those of PETSc and hypre among them. *Solver* is
the projection (E79) with its multigrid; *rest* is everything else.

{machine}

| | particles | ranks | iterations | compute, rest | solver | messages, rest | solver | MB, rest | solver | collectives, rest | solver |
|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|
"""


def counted(measured: Measured) -> list[str]:
    lines, last = [], ""
    for row in measured:
        name = SERIES[row["series"]] if row["series"] != last else ""
        last = row["series"]
        rest, solver = row["rest"], row["solver"]
        cells = [name, str(row["particles"]), str(row["ranks"]), f"{row['iterations']:.1f}"]
        cells += [f"{1e3 * part['compute_s']:.3g} ms" for part in (rest, solver)]
        cells += [f"{part['messages']:.0f}" for part in (rest, solver)]
        cells += [f"{1e-6 * part['bytes']:.2f}" for part in (rest, solver)]
        cells += [f"{part['collectives']:.0f}" for part in (rest, solver)]
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def of_line(line: Line) -> str:
    return f"{line.at_one:.3g} {'-' if line.slope < 0 else '+'} {abs(line.slope):.3g} log8 n"


def terms(model: Model) -> list[str]:
    us = 1e6
    rows = [
        ("compute of one process", f"{us * model.alone:.3g} us a particle"),
        ("compute of the rest", f"{us * model.per_particle:.3g} us a particle, {1e9 * model.per_byte:.2g} ns for a byte "
                                "that is sent"),
        ("compute of the solver", f"{us * model.per_unknown:.3g} us an unknown, {us * model.per_exchange:.3g} us an exchange"),
        ("unknowns", f"{model.unknowns:.3g} a particle"),
        ("iterations", of_line(model.iterations)),
        ("bytes of the rest", f"{model.shell:.3g} N^(2/3) of N particles"),
        ("bytes of the solver", f"{model.solver_shell:.3g} N^(2/3) an iteration"),
        ("exchanges with the ranks around", f"{model.exchanges:.0f}, of the solver {of_line(model.solver_exchanges)}"),
        ("collectives", f"{model.collectives:.0f}, of the solver {of_line(model.solver_collectives)}")]
    return ["| term | a rank and step |", "|---|---|", *[f"| {name} | {text} |" for name, text in rows]]


@cache  # seconds, for many ranks
def row_of(model: Model, machine: Machine, side: int, particles: float) -> dict[str, float]:
    ranks = side ** 3
    parts = steps_of(model, ranks, particles)
    paper = [on_paper(part, machine, ranks) for part in parts.values()]
    found = {key: sum(part[key] for part in paper) for key in paper[0]}
    rng = np.random.default_rng(1)
    found["played"] = sum(played(part, machine, side, rng) for part in parts.values())
    return found


def table(model: Model, machine: Machine, sizes: list[tuple[int, float]]) -> list[str]:
    lines = ["| ranks | particles of a rank | compute | messages | bytes | collectives | sum | played | efficiency |",
             "|---:|---:|---:|---:|---:|---:|---:|---:|---:|"]
    for side, particles in sizes:
        found = row_of(model, machine, side, particles)
        paper = [found[key] for key in ("compute", "messages", "bytes", "collectives")]
        seconds = [f"{value:.3f} s" for value in (*paper, sum(paper), found["played"])]
        lines.append(f"| {side ** 3} | {particles:.3g} | " + " | ".join(seconds)
                     + f" | {100 * model.alone * particles / found['played']:.0f} % |")
    return lines


MODEL = """
## A model of it

n is the number of unknowns of all ranks. Compute of the rest is fitted to both series of dam breaks. All of the solver is
fitted to the five sizes on two ranks, where an exchange is one message and each rank has a core; what it computes on eight
ranks and two cores is more than that, for they empty each other's caches. Of eight ranks each has {octant} faces to others;
of many, as here, it has {inside}, and {neighbours} ranks around.

"""

TABLES = """
The network: {latency:.3g} us for a message, {bandwidth:.3g} MB/s for a rank while all send. A sum over P ranks takes 2 log2 P
messages that follow one another. *Sum* is on paper, if nobody waits. *Played* is the same step played rank by rank, in a
cube of so many: each does its pieces of compute one after the other, the fullest {imbalance:.2f} times the mean and each
piece up to {jitter:.0f} % longer at random, and goes on when all ranks around it have come as far, or all ranks where there is
a sum. *Efficiency* is what one process, with its own multigrid, takes for as many
particles over that.

Weak scaling:

"""

STRONG = """
Strong scaling, {whole:.0e} particles:

"""

TAIL = """
## Where it stops, and why

{verdict}
- *What this leaves out.* The cut of the curve, when a rank has a tenth too many, passes through rank 0, 16 bytes for every
  block of 2^3 cells: {cut:.0f} MB for 10^3 ranks of {share:.0e} particles, {cut_large:.0f} GB for 10^5: there it is the first thing to
  break. Coarse levels of the multigrid are priced as messages to the ranks around, though few ranks have them and these
  lie further apart. Bodies send more: what is counted above for box_in_the_way is not in the model. Nor are files.
"""


def verdict(model: Model, machine: Machine, measured: Measured) -> str:
    side = SIDES[-1]
    small, large = (row_of(model, machine, side, share) for share in SHARES)
    parts = steps_of(model, side ** 3, SHARES[0])
    exchanges = parts["solver"].exchanges + parts["rest"].exchanges
    own = next(row for row in measured if row["series"] == "strong")
    own_multigrid = own["solver"]["compute_s"] / own["unknowns"]
    latency = 1e3 * (small["messages"] + small["collectives"])
    return "\n".join([
        f"- *Latency.* A step on {side ** 3} ranks has {exchanges} exchanges, {parts['solver'].exchanges} of them in the solver,"
        " nearly all on levels of its",
        f"  multigrid that hold next to nothing: {latency:.0f} ms, whatever a rank has. Below some 10^5 particles of a rank more",
        "  ranks bring little. The sources of (E79) are solved for one after the other; all at once would send a half to a",
        "  third of the messages.",
        f"- *hypre.* Its set-up and cycles compute {1e6 * model.per_unknown:.2g} us an unknown and step; the multigrid that one"
        f" process has takes {1e6 * own_multigrid:.2g}.",
        "  That is most of what is lost between one rank and eight.",
        f"- *Bytes.* {100 * large['bytes'] / large['played']:.0f} % of a step with {SHARES[1]:.0e} particles on a rank. `systems` in"
        " summary.json tells who sends what",
        "  the solver does not."])


def page(measured: Measured, machine: Machine) -> str:
    model = fit(measured)
    head = HEAD.format(first=STEPS[0] + 1, last=STEPS[1], machine=f"{measured[0]['cpu_model']}, minamo {measured[0]['version']}.")
    lines = [head.rstrip("\n"), *counted(measured),
             MODEL.format(octant=FACES_OF_OCTANT, inside=FACES_INSIDE, neighbours=NEIGHBOURS).rstrip("\n"), "", *terms(model),
             TABLES.format(latency=1e6 * machine.latency, bandwidth=1e-6 * machine.bandwidth, imbalance=machine.imbalance,
                           jitter=100 * machine.jitter).rstrip("\n"), ""]
    for share in SHARES:
        lines += [*table(model, machine, [(side, share) for side in SIDES]), ""]
    lines += [STRONG.strip("\n").format(whole=WHOLE), ""]
    lines += table(model, machine, [(side, WHOLE / side ** 3) for side in SIDES if side >= 10])
    blocks = SHARES[-1] / 27 / 8  # 3 x 3 x 3 particles a cell
    lines.append(TAIL.format(verdict=verdict(model, machine, measured), share=SHARES[-1], cut=1e3 * blocks * 16 * 1e-6,
                             cut_large=1e5 * blocks * 16 * 1e-9).rstrip("\n"))
    return "\n".join(lines) + "\n"
