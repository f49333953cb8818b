"""Runs minamo's experiments and writes scenes/validation: pictures, curves, README.md.

tools/validate --experiments DIR              all of them
tools/validate --experiments DIR swayed_tank  one; the rest of the page stays as it is
tools/validate --list                         names them
"""

from __future__ import annotations

import argparse
import csv
import difflib
import json
import signal
import sys
from pathlib import Path
from typing import Any

try:
    import matplotlib  # noqa: F401
    import numpy as np
except ModuleNotFoundError as missing:
    sys.exit(f"tools/validate needs the python module {missing.name}. Type this line, then call it again:\n"
             "  sudo apt-get install --yes --no-install-recommends python3-matplotlib")

from case import Case, Points, Result
from cases import CASES
from page import page
from picture import draw
from runs import SCENES, computed, measured, run, scene_file

ROWS = 200  # of the files of our curves


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="tools/validate", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="experiments; default: all")
    parser.add_argument("--experiments", type=Path, metavar="DIR", help="data of the experiments, CSV files")
    parser.add_argument("--out", type=Path, default=SCENES, metavar="DIR", help="default: scenes/validation")
    parser.add_argument("--threads", type=int, default=2, metavar="N", help="of a run; default: 2")
    parser.add_argument("--list", action="store_true", help="names the experiments and runs nothing")
    parser.add_argument("--check", action="store_true", help="reads the arguments and runs nothing")
    options = parser.parse_args()
    known = [case.name for case in CASES]
    problems = []
    for name in options.names:
        if name not in known:
            closest = difflib.get_close_matches(name, known, 1)
            problems.append(f'no experiment "{name}"; ' + (f'closest "{closest[0]}"' if closest else
                                                         f"there are {', '.join(known)}"))
    if not options.list:
        problems += missing_files(options)
    if problems:
        parser.exit(2, "".join(f"tools/validate: {problem}\n" for problem in problems))
    return options


def chosen(options: argparse.Namespace) -> list[Case]:
    return [case for case in CASES if not options.names or case.name in options.names]


def missing_files(options: argparse.Namespace) -> list[str]:
    if options.experiments is None:
        return ["--experiments DIR is missing: where the data of the experiments are, scenes/validation/README.md names "
                "them"]
    files = sorted({curve.file for case in chosen(options) for curve in case.curves})
    return [f"{options.experiments / file}: no such file" for file in files
            if not (options.experiments / file).is_file()]


def write_curves(case: Case, results: list[Result], file: Path) -> None:
    names = [f"{curve.name}, {result.resolution}" for curve in case.curves for result in results]
    points = [result.curves[curve.name] for curve in case.curves for result in results]
    x = np.linspace(0, max(curve.x[-1] for curve in points), ROWS)
    with open(file, "w", newline="") as table:
        rows = csv.writer(table, lineterminator="\n")
        rows.writerow([case.x_label, *names])
        for value in x:
            rows.writerow([f"{value:.5g}", *(f"{mean_around(curve, value, x[1]):.5g}" for curve in points)])


def mean_around(curve: Points, x: float, width: float) -> float:
    """Of the steps within half a row of x, or in between of those next to it."""
    near = np.abs(curve.x - x) <= width / 2
    return float(curve.y[near].mean()) if near.any() else float(np.interp(x, curve.x, curve.y))


def machine() -> str:
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    return ""


def finite(value: float) -> float | None:
    return round(value, 3) if np.isfinite(value) else None


def validate(case: Case, options: argparse.Namespace) -> dict[str, Any]:
    results = []
    points = {curve.name: measured(curve, options.experiments) for curve in case.curves}
    for label, changes in case.resolutions:
        print(f"{case.name}, {label}", flush=True)
        results.append(run(case, label, changes, options.threads))
    beside = {label: computed(case, file) for label, file in case.beside}
    draw(case, results, beside, points, options.out / f"{case.name}.png")
    write_curves(case, results, options.out / f"{case.name}.csv")

    def figures(curves: dict[str, Points]) -> list[float | None]:
        return [finite(figure.of(curves[figure.curve], points[figure.curve])) for figure in case.figures]

    ours = {result.resolution: {"figures": figures(result.curves), "particles": result.particles,
                                "steps": result.steps, "cpu_s": round(result.cpu_s, 2), "machine": machine()}
            for result in results}
    return ours | {label: {"figures": figures(curves)} for label, curves in beside.items()}


def without_stale(stored: dict[str, Any]) -> dict[str, Any]:
    """Results of resolutions that a case no longer has are left out until it is run again."""
    kept = {}
    for case in CASES:
        of_case = stored.get(case.name)
        if of_case is None:
            continue
        if set(of_case) == {label for label, _ in (*case.resolutions, *case.beside)}:
            kept[case.name] = of_case
        else:
            print(f"{case.name}: its results are of other resolutions; left out until it is run again")
    return kept


def main() -> None:
    options = arguments()
    if options.list:
        for case in CASES:
            print(f"{case.name:24}{case.title}")
        return
    if options.check:
        return
    options.out.mkdir(parents=True, exist_ok=True)
    numbers = options.out / "results.json"
    stored = without_stale(json.loads(numbers.read_text()) if numbers.exists() else {})
    for case in chosen(options):
        stored[case.name] = validate(case, options)
        numbers.write_text(json.dumps(stored, indent=1) + "\n")
        (options.out / "README.md").write_text(page(stored, scene_file))
    print(f"written: {options.out / 'README.md'}")


if __name__ == "__main__":
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # into `head`, which reads no further
    main()
