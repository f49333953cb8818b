"""Compares finished runs with the last one: scenes, cost, histories, where the liquid is.

  tools/compare out/coarse out/fine             prints tables, writes compare.png and compare.csv into out/fine/compare
  tools/compare out/a out/b out/c               of three grids also order, extrapolated value, grid convergence index
  tools/compare out/a out/b --columns gate_pressure,max_speed --at 0.4

Differences are taken over the time that all runs have, in parts of the range (largest less smallest value) of the
column in the last run, which should be the finest. The misplaced area S is that of tools/compare_interfoam.py: the area
that is liquid in one of two runs and not in the other, over that of the liquid, at all frames that the runs have in
common. Liquid is where the volume fraction, smoothed by a B-spline as wide as the widest cell of the runs, exceeds 1/2.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

from comparing.checks import read_finished
from comparing.comparison import compare
from comparing.picture import picture
from comparing.tables import text_of, write_csv
from reporting.closed_pipes import readers_may_go
from reporting.runs import NoResults


def words(text: str) -> list[str]:
    """Words with commas between them."""
    return text.split(",")


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="tools/compare", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", metavar="DIR", help="what `minamo run --out DIR` wrote; the finest last")
    parser.add_argument("--out", type=Path, metavar="DIR", help="default: `compare` in the last DIR")
    parser.add_argument("--columns", type=words, metavar="NAME,NAME,...",
                        help="of history.csv; default: all that all runs have but those of the grid and the solver")
    parser.add_argument("--at", type=float, metavar="T",
                        help="of the particles and of the figures of three grids [s]; default: the last common time")
    options = parser.parse_args()
    if len(options.folders) < 2:
        parser.error("expected two runs or more, the finest last")
    return options


def main() -> None:
    options = arguments()
    comparison = compare([read_finished(folder) for folder in options.folders], options.columns, options.at)
    print(text_of(comparison), end="\n\n")
    out = options.out or comparison.last.folder / "compare"
    out.mkdir(parents=True, exist_ok=True)
    write_csv(out / "compare.csv", comparison)
    (out / "compare.png").write_bytes(picture(comparison))
    print(out / "compare.png")
    print(out / "compare.csv")


if __name__ == "__main__":
    np.seterr(all="ignore")  # of columns that are always zero
    try:
        with readers_may_go():
            main()
    except (NoResults, OSError) as problem:
        print(problem, file=sys.stderr)
        sys.exit(2)
