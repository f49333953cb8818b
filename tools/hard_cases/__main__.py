"""Runs hard cases with every method and writes tests/stability/RESULTS.md.

tools/stability                          all cases but the long ones, every method
tools/stability --long                   the long ones alone, some minutes each
tools/stability impact drops_cfl_2       sections and cases; the rest of the page stays as it is
tools/stability --discretization conforming    the numbers of one discretization; those of the other stay as they are
tools/stability drops_cfl_2 --scheme flip --volume none --keep out/drops    some methods, nothing written but the runs
"""

from __future__ import annotations

import argparse
import difflib
import json
import os
import signal
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

try:
    import h5py  # noqa: F401
    import numpy as np
except ModuleNotFoundError as missing:
    sys.exit(f"tools/stability needs the python module {missing.name}. Type this line, then call it again:\n"
             "  sudo apt-get install --yes --no-install-recommends python3-h5py")

from case import Case
from catalogue import CASES, SECTIONS
from judge import Judged, judge, packed, unpacked
from methods import DISCRETIZATIONS, INTEGRATORS, METHODS, SCHEMES, VOLUMES, VOLUMES_OF, Method
from page import Results, lines_of, page, version
from runs import ROOT, SuiteFailed

RESULTS = ROOT / "tests/stability/RESULTS.md"
NUMBERS = {"equal_order": ROOT / "tests/stability/results.json",
           "conforming": ROOT / "tests/stability/results_conforming.json"}


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="tools/stability", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="cases or sections; default: all")
    for option, choices in (("--scheme", SCHEMES), ("--integrator", INTEGRATORS), ("--volume", VOLUMES)):
        parser.add_argument(option, choices=choices, help="these methods alone; prints and leaves RESULTS.md as it is")
    parser.add_argument("--discretization", choices=DISCRETIZATIONS,
                        help="this one alone; the numbers of the others stay as they are")
    parser.add_argument("--long", action="store_true", help="the cases that take minutes, by default left out")
    parser.add_argument("--list", action="store_true", help="names the cases and runs nothing")
    parser.add_argument("--check", action="store_true", help="reads the arguments and runs nothing")
    parser.add_argument("--keep", type=Path, metavar="DIR", help="keeps the runs there, for tools/report")
    parser.add_argument("--program", type=Path, default=ROOT / "build/minamo", metavar="FILE",
                        help="that runs the scenes; default: build/minamo")
    options = parser.parse_args()
    if options.discretization and options.volume not in (None, *VOLUMES_OF[options.discretization]):
        parser.exit(2, f"tools/stability: no volume correction \"{options.volume}\" with {options.discretization}; "
                       f"there are {', '.join(VOLUMES_OF[options.discretization])}\n")
    known = [*SECTIONS, *(case.name for case in CASES)]
    for name in options.names:
        if name not in known:
            nearest = difflib.get_close_matches(name, known, n=1, cutoff=0)[0]
            parser.exit(2, f"tools/stability: unknown name \"{name}\"; nearest: {nearest}; all: tools/stability --list\n")
    return options


def list_cases() -> None:
    for section in SECTIONS:
        print(section)
        for case in CASES:
            if case.section == section:
                print(f"  {case.name:26} {case.what}{' (--long)' if case.long else ''}")


def chosen(options: argparse.Namespace) -> list[Case]:
    """Named ones, or all that are as long as asked for."""
    if options.names:
        return [case for case in CASES if {case.name, case.section} & set(options.names)]
    return [case for case in CASES if case.long == options.long]


def methods(case: Case, options: argparse.Namespace) -> list[Method]:
    return [method for method in METHODS if method in case.methods
            and options.scheme in (None, method.scheme) and options.integrator in (None, method.integrator)
            and options.volume in (None, method.volume) and options.discretization in (None, method.discretization)]


def judge_all(cases: list[Case], options: argparse.Namespace, folder: Path) -> Results:
    results: Results = {name: {} for name in DISCRETIZATIONS}
    for case in cases:
        for discretization in DISCRETIZATIONS:
            begin = time.monotonic()
            of_method: dict[str, Judged] = {}
            for method in methods(case, options):
                if method.discretization == discretization:
                    of_method[method.name] = judge(case, method, options.program.resolve(), folder)
            if not of_method:
                continue
            wall_s = round(time.monotonic() - begin, 1)
            results[discretization][case.name] = {"version": version(options.program), "methods": of_method,
                                                  "wall_s": wall_s}
            print(f"{case.name}, {discretization} ({wall_s:.1f} s)", *lines_of(case, of_method), sep="\n  ",
                  file=sys.stderr, flush=True)
    return results


def load() -> Results:
    """The numbers of each discretization, if there are any."""
    known = {name: json.loads(file.read_text()) if file.is_file() else {} for name, file in NUMBERS.items()}
    for results in known.values():
        for result in results.values():
            result["methods"] = {name: unpacked(entry) for name, entry in result["methods"].items()}
    return known


def merged(known: Results, results: Results) -> Results:
    """In the order of the page; a case that has run replaces what was known of it with the same discretization."""
    return {name: {case.name: (known[name] | results[name])[case.name] for case in CASES
                   if case.name in known[name] | results[name]} for name in DISCRETIZATIONS}


def dump(results: dict[str, Any]) -> str:
    """A line per case and method."""
    lines = []
    for case, result in results.items():
        methods = ",\n".join(f"  {json.dumps(name)}: {json.dumps(packed(judged))}"
                             for name, judged in result["methods"].items())
        head = json.dumps({key: result[key] for key in ("version", "wall_s")})[1:-1]
        lines.append(f"{json.dumps(case)}: {{{head}, \"methods\": {{\n{methods}}}}}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def write(path: Path, text: str) -> None:
    """All or nothing."""
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_name(path.name + ".new")
    new.write_text(text)
    os.replace(new, path)


def main() -> None:
    options = arguments()
    if options.list:
        list_cases()
    if options.list or options.check:
        return
    np.seterr(all="ignore")  # garbage is what this suite looks for
    with tempfile.TemporaryDirectory(prefix="minamo_stability_") as folder:
        results = judge_all(chosen(options), options, options.keep.resolve() if options.keep else Path(folder))
    if options.scheme or options.integrator or options.volume:
        return
    results = merged(load(), results)
    for name, file in NUMBERS.items():
        if results[name]:
            write(file, dump(results[name]))
    write(RESULTS, page(results))
    print(RESULTS.relative_to(ROOT))


if __name__ == "__main__":
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # into `head`, which reads no further
    try:
        main()
    except SuiteFailed as problem:
        sys.exit(f"tools/stability: {problem}\n{RESULTS.relative_to(ROOT)} is as it was.")
    except (FileNotFoundError, PermissionError) as problem:  # no program
        sys.exit(f"tools/stability: {problem.filename}: {problem.strerror}\n{RESULTS.relative_to(ROOT)} is as it was.")
    except KeyboardInterrupt:
        print(f"interrupted; {RESULTS.relative_to(ROOT)} is as it was", file=sys.stderr)
        sys.exit(130)
