"""Counts what 1 to 8 ranks compute and send, and writes systems/ranks/SCALING.md with a model for many.

tools/scale                                 counts (about ten minutes on two cores) and writes
tools/scale --again --latency 1e-6          writes from the last counts, systems/ranks/scaling.json
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

try:
    import numpy  # noqa: F401
except ModuleNotFoundError as missing:
    sys.exit(f"tools/scale needs the python module {missing.name}. Type this line, then call it again:\n"
             "  sudo apt-get install --yes --no-install-recommends python3-numpy")

from measure import CASES, ROOT, ScalingFailed, measure
from model import Machine
from page import page

FOLDER = ROOT / "systems/ranks"


def positive(text: str) -> float:
    value = float(text)
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"expected a number above 0, got {text}")
    return value


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="tools/scale", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--latency", type=positive, default=Machine.latency, metavar="S", help="of a message; %(default)g s")
    parser.add_argument("--bandwidth", type=positive, default=Machine.bandwidth, metavar="BYTES_PER_S",
                        help="of a rank while all send; %(default)g")
    parser.add_argument("--again", action="store_true", help="models from the last counts")
    parser.add_argument("--program", type=Path, default=ROOT / "build/minamo-mpi", help="default: build/minamo-mpi")
    parser.add_argument("--out", type=Path, default=FOLDER, metavar="DIR", help="default: systems/ranks")
    parser.add_argument("--check", action="store_true", help="reads the arguments and runs nothing")
    options = parser.parse_args()
    if options.again and not counts_file(options).exists():
        parser.exit(2, f"tools/scale: --again: there is no {counts_file(options)}; without --again it is made\n")
    return options


def counts_file(options: argparse.Namespace) -> Path:
    return options.out / "scaling.json"


def main() -> None:
    options = arguments()
    if options.check:
        return
    if not options.again:
        measured = []
        for case in CASES:
            print(f"{case.series}: {case.scene}, {case.cells or 'its'} cells, {case.ranks} ranks", file=sys.stderr, flush=True)
            measured.append(measure(options.program, case))
        counts_file(options).write_text("[\n" + ",\n".join(json.dumps(row) for row in measured) + "\n]\n", encoding="utf8")
    measured = json.loads(counts_file(options).read_text(encoding="utf8"))
    machine = Machine(latency=options.latency, bandwidth=options.bandwidth)
    (options.out / "SCALING.md").write_text(page(measured, machine), encoding="utf8")
    print(options.out / "SCALING.md")


if __name__ == "__main__":
    try:
        main()
    except ScalingFailed as failure:
        sys.exit(f"tools/scale: {failure}")
