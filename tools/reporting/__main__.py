"""Shows the results of runs: a page with moving particles, histories, times and balances.

  tools/report out/dam_break                      writes out/dam_break/report.html
  tools/report out/dam_break out/honey            the same, runs side by side, in the first folder
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from reporting.closed_pipes import readers_may_go
from reporting.graph import find_program
from reporting.page import write_page
from reporting.runs import NoResults, Run


def numbers(text: str) -> list[float]:
    """Numbers with commas between them."""
    return [float(part) for part in text.split(",")]


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="tools/report", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", metavar="DIR", help="what `minamo run --out DIR` wrote")
    parser.add_argument("--out", type=Path, metavar="FILE.html", help="the page; default: report.html in the first DIR")
    parser.add_argument("--times", type=numbers, metavar="T,T,...",
                        help="output times of the strip [s]; default: those of a reference that fits, else those "
                             "between which the liquid moves equally far")
    parser.add_argument("--program", type=Path, metavar="FILE",
                        help="the minamo that tells the graph of the systems; default: build/minamo or "
                             "build/test/minamo of this tree, else minamo of the PATH")
    return parser.parse_args()


def main() -> None:
    options = arguments()
    runs = [Run(folder) for folder in options.folders]
    page = options.out or runs[0].folder / "report.html"
    write_page(page, runs, options.times, find_program(options.program))
    print(page)
    for run in runs:
        run.require_whole()  # the page has what there is


if __name__ == "__main__":
    try:
        with readers_may_go():
            main()
    except (NoResults, OSError) as problem:
        print(problem, file=sys.stderr)
        sys.exit(2)
