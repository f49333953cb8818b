"""What ranks compute and send in a step, from the summaries of two runs of different length."""

from __future__ import annotations

import csv
import json
import os
import shutil
import subprocess
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
STEPS = (3, 11)  # of the two runs: what differs are steps without the start of a run
SOLVER = ("solve_multipliers_petsc", "solve_multipliers")
COUNTS = ("messages", "bytes", "collectives")


class ScalingFailed(Exception):
    """A run ended otherwise than it should."""


@dataclass(frozen=True)
class Case:
    series: str
    scene: str
    ranks: int
    cells: int = 0  # along z; 0: those of the scene

    def options(self) -> list[str]:
        return ["--set", f"/grid/cells=[{self.cells}, {self.cells // 2}, {self.cells}]"] if self.cells else []


DAM, BODIES = "dam_break_3d", "validation/box_in_the_way"
CASES = ([Case("weak", DAM, ranks, cells) for ranks, cells in ((1, 32), (2, 40), (4, 50), (8, 64))]
         + [Case("strong", DAM, ranks, 64) for ranks in (1, 2, 4, 8)]
         + [Case("bodies", BODIES, ranks) for ranks in (1, 2, 4, 8)]
         + [Case("two", DAM, 2, cells) for cells in (32, 40, 50, 64, 80)])


def command(program: Path, case: Case, steps: int, folder: Path) -> list[str]:
    as_root = ["--allow-run-as-root"] if os.geteuid() == 0 else []
    # On one rank minamo-mpi is the ordinary program.
    mpi = [shutil.which("mpiexec") or "mpirun", "-n", str(case.ranks), "--oversubscribe", *as_root] if case.ranks > 1 else []
    return [*mpi, str(program), "run", f"{ROOT}/scenes/{case.scene}.json", "--steps", str(steps), "--threads", "1",
            "--quiet", "--overwrite", "--out", str(folder), "--set", "/output/every=1e9", *case.options()]


def run(program: Path, case: Case, steps: int, folder: Path) -> dict[str, Any]:
    # More ranks than processors take turns; and containers may forbid a process to read another's memory.
    environment = os.environ | {"OMPI_MCA_mpi_yield_when_idle": "1", "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
                                "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(command(program, case, steps, folder), env=environment, capture_output=True, text=True,
                          check=False)
    if done.returncode != 0:
        raise ScalingFailed(f"{case}: exit code {done.returncode}\n{done.stderr.strip()}")
    return json.loads((folder / "summary.json").read_text(encoding="utf8"))


def efforts(summary: dict[str, Any]) -> dict[str, dict[str, float]]:
    """Of all ranks: the solver's, and that of everything else. Compute is that of systems: what a start takes varies."""
    systems = summary["systems"]
    if "ranks" not in summary:
        systems = [dict.fromkeys(COUNTS, 0.0) | row | {"compute_s": row["seconds"]} for row in systems]
    every = {"compute_s": sum(row["compute_s"] for row in systems)}
    every |= {key: summary.get("ranks", {}).get(key, 0.0) for key in COUNTS}
    of_solver = {key: sum(row[key] for row in systems if row["name"] in SOLVER) for key in every}
    return {"solver": of_solver, "rest": {key: every[key] - of_solver[key] for key in every}}


def iterations(folder: Path) -> float:
    with open(folder / "history.csv", encoding="utf8") as file:
        rows = [float(row["iterations"]) for row in csv.DictReader(file)]
    return sum(rows[STEPS[0] + 1:]) / (STEPS[1] - STEPS[0])


def measure(program: Path, case: Case) -> dict[str, Any]:
    """What a rank does in a step, on average."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        short = run(program, case, STEPS[0], folder / "short")
        long = run(program, case, STEPS[1], folder / "long")
        shares = 1.0 / (case.ranks * (STEPS[1] - STEPS[0]))
        before, after = efforts(short), efforts(long)
        found = {part: {key: (after[part][key] - before[part][key]) * shares for key in after[part]} for part in after}
        return asdict(case) | found | {"particles": long["particles"], "unknowns": long["unknowns_max"],
                                       "iterations": iterations(folder / "long"),
                                       "version": long["version"], "cpu_model": long["cpu_model"]}
