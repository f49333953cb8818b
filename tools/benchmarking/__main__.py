"""Measures the speed of minamo and writes tests/bench/RESULTS.md.

tools/bench                      all cases, three runs each
tools/bench --runs 1 size_40     one run of one case; the rest of the page stays as it is
tools/bench solvers              all cases of a section
tools/bench --quick              a few steps of everything, printed and not kept: does it work?
"""

from __future__ import annotations

import argparse
import difflib
import json
import os
import signal
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

from cases import CASES, KERNELS, SECTIONS, Case
from machine import machine
from measure import ROOT, BenchmarkFailed, measure, measure_kernels
from page import page

RESULTS = ROOT / "tests/bench/RESULTS.md"
NUMBERS = ROOT / "tests/bench/results.json"
QUICK_STEPS = 3


def positive(text: str) -> int:
    """A whole number above 0."""
    if not text.isdigit() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"expected a whole number above 0, got \"{text}\"")
    return int(text)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="tools/bench", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="cases or sections; default: all")
    parser.add_argument("--runs", type=positive, default=3, metavar="N",
                        help="of every case, for the median; default: 3")
    parser.add_argument("--list", action="store_true", help="names the cases and runs nothing")
    parser.add_argument("--quick", action="store_true",
                        help=f"one run of {QUICK_STEPS} steps each; prints the page and leaves RESULTS.md as it is")
    parser.add_argument("--check", action="store_true", help="reads the arguments and runs nothing")
    parser.add_argument("--build", type=Path, default=ROOT / "build", metavar="DIR",
                        help="folder with the programs; default: build")
    options = parser.parse_args()
    unknown = [name for name in options.names if name not in names_of_all()]
    if unknown:
        parser.exit(2, "".join(f"tools/bench: {unknown_name(name)}\n" for name in unknown))
    return options


def names_of_all() -> list[str]:
    return [*SECTIONS, *(case.name for case in CASES)]


def unknown_name(name: str) -> str:
    nearest = difflib.get_close_matches(name, names_of_all(), n=1, cutoff=0)
    return f"unknown name \"{name}\"; nearest: {nearest[0]}; all: tools/bench --list"


def list_cases() -> None:
    for section in SECTIONS:
        print(section)
        for case in CASES:
            if case.section == section and case.name != section:
                print(f"  {case.name:20}", "; ".join(run.label for run in case.runs))


def chosen(options: argparse.Namespace) -> list[Case]:
    cases = [case for case in CASES if not options.names or {case.name, case.section} & set(options.names)]
    if options.quick:
        cases = [replace(case, runs=[run.shortened(QUICK_STEPS) for run in case.runs]) for case in cases]
    return cases


def load() -> dict:
    """results.json, if there is one."""
    return json.loads(NUMBERS.read_text()) if NUMBERS.is_file() else {}


def write(path: Path, text: str) -> None:
    """All or nothing."""
    new = path.with_name(path.name + ".new")
    new.write_text(text)
    os.replace(new, path)


def keep(results: dict) -> None:
    """Puts cases in the place of those before, on the page, too."""
    known = load() | results
    known = {case.name: known[case.name] for case in CASES if case.name in known}
    write(NUMBERS, json.dumps(known, indent=1) + "\n")
    write(RESULTS, page(known))


def measure_all(cases: list[Case], options: argparse.Namespace) -> dict:
    """Every case is kept as soon as it is measured."""
    results = {}
    with tempfile.TemporaryDirectory(prefix="minamo_bench_") as folder:
        for case in cases:
            print(case.name, file=sys.stderr, flush=True)
            load_before = os.getloadavg()[0]
            if case.name == KERNELS:
                rows = measure_kernels(options.build / "minamo_bench", options.quick)
            else:
                rows = measure(case, options.build / "minamo", 1 if options.quick else options.runs, Path(folder))
            results[case.name] = {"machine": machine(options.build), "load": load_before,
                                  "rows": rows}
            if not options.quick:
                keep(results)
    return results


def main() -> None:
    options = arguments()
    if options.list:
        list_cases()
    if options.list or options.check:
        return
    results = measure_all(chosen(options), options)
    if options.quick:
        print(page(results), end="")
    else:
        print(RESULTS.relative_to(ROOT))


if __name__ == "__main__":
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # into `head`, which reads no further
    try:
        main()
    except BenchmarkFailed as problem:
        sys.exit(f"tools/bench: {problem}\n{RESULTS.relative_to(ROOT)} has the cases before.")
    except (FileNotFoundError, PermissionError) as problem:  # no program
        sys.exit(f"tools/bench: {problem.filename}: {problem.strerror}\n{RESULTS.relative_to(ROOT)} is as it was.")
    except KeyboardInterrupt:
        print(f"interrupted; {RESULTS.relative_to(ROOT)} has the cases before", file=sys.stderr)
        sys.exit(130)
