"""RESULTS.md from results.json and results_conforming.json: what was kept, what was broken, by whom and how far."""

from __future__ import annotations

import subprocess
from collections import Counter
from pathlib import Path
from typing import Any

from case import Case, Check
from catalogue import ABOUT, CASES, SECTIONS
from judge import NOTHING, Judged
from methods import DISCRETIZATIONS, METHODS, SCHEMES, listed
from reasons import REASONS, reason

Results = dict[str, dict[str, Any]]  # by discretization and case: version, wall_s, methods (name: Judged)
TITLES = {"equal_order": "Equal order", "conforming": "Conforming"}
BY_NAME = {method.name: method for method in METHODS}


def version(program: Path) -> str:
    """Without the facts of the build, which stand in the lines below."""
    said = subprocess.run([str(program.resolve()), "--version"], text=True, capture_output=True, check=False).stdout
    return said.partition("\n")[0].removeprefix("minamo ")


def shown(value: float) -> str:
    return "no bound" if value >= NOTHING else f"{value:.3g}"


def worst_of(check: Check, of_method: dict[str, Judged]) -> float:
    return max(judged.values.get(check.name, 0.0) for judged in of_method.values())


def broken_lines(case: Case, of_method: dict[str, Judged]) -> list[str]:
    """A sentence per check that some method broke."""
    lines = []
    for check in case.checks:
        broken = {name: judged for name, judged in of_method.items() if check.name in judged.broken}
        if broken:
            methods = listed(BY_NAME[name] for name in broken)
            lines.append(f"{methods}: {check.broken}, {shown(worst_of(check, broken))} {check.unit} "
                         f"(limit {check.limit:g})")
    return lines


def ending_lines(case: Case, of_method: dict[str, Judged]) -> list[str]:
    """A sentence per way to end that is not the end of the scene."""
    lines = []
    for ended in ("stopped", "crashed", "hung"):
        some = {name: judged for name, judged in of_method.items() if ended in judged.ended}
        if some:
            said = next(iter(some.values())).said
            lines.append(f"{listed(BY_NAME[name] for name in some)}: {ended}, \"{said}\"")
    return lines


def lines_of(case: Case, of_method: dict[str, Judged]) -> list[str]:
    lines = ending_lines(case, of_method) + broken_lines(case, of_method)
    silent = [BY_NAME[name] for name, judged in of_method.items() if judged.silent]
    if silent:
        lines.append(f"in silence: {listed(silent)}")
    return lines


HEAD = """# Robustness tests

Hard cases with both discretizations and every transfer scheme, integrator and volume correction: what they kept, and
what they broke.
`tools/stability` ran them and wrote this page; `tools/stability NAME...` replaces single cases or sections,
`tools/stability --list` names them. The checks, and the reasons for their limits, are in
[checks.py](../../tools/hard_cases/checks.py).

- A number counts the methods with this scheme that kept everything the case asks for: newmark and midpoint, each with
  volume correction none, delta and projection, six in all; with the conforming discretization none and projection, four
  in all, and two with bodies, which move with the midpoint rule. Below the table stands what the others broke.
- *In silence*: the program reported success, but its results are not finite, have lost particles, have an absurd speed or
  pressure or have gained more than 1 % of energy.
- *Stopped*: the program ended by itself, with exit code 3, a message and a checkpoint.
- *Squeezed* is checked with delta and projection only; without a volume correction nothing keeps particles apart.
"""


def cell(scheme: str, of_method: dict[str, Judged]) -> str:
    """How many methods with a scheme kept everything, of how many."""
    some = [judged for name, judged in of_method.items() if BY_NAME[name].scheme == scheme]
    if not some:
        return ""
    kept = sum(judged.kept_all for judged in some)
    return f"{kept}" if kept == len(some) else f"**{kept} of {len(some)}**"


def row(case: Case, result: dict[str, Any]) -> str:
    of_method = result["methods"]
    worst = ", ".join(f"{check.name} {shown(worst_of(check, of_method))}" for check in case.checks
                      if check.limit > 0 and check.name not in ("speed", "pressure"))
    columns = [case.name, case.what, *(cell(scheme, of_method) for scheme in SCHEMES), worst]
    return "| " + " | ".join(columns) + " |\n"


def note_lines(case: Case, of_method: dict[str, Judged]) -> list[str]:
    """From the least to the most of what has no limit."""
    lines = []
    for name in case.notes:
        values = [judged.notes.get(name, 0.0) for judged in of_method.values()]
        lines.append(f"{name}: {shown(min(values))} to {shown(max(values))}")
    rejected = sum(judged.rejected for judged in of_method.values())
    return lines + ([f"steps taken back and repeated with a shorter one: {rejected}"] if rejected else [])


def section(name: str, results: Results) -> str:
    """A table per discretization; empty if nothing of it has run."""
    tables = "".join(table(name, discretization, results[discretization]) for discretization in DISCRETIZATIONS)
    return f"\n## {name.replace('_', ' ').capitalize()}\n\n{ABOUT[name]}\n{tables}" if tables else ""


def table(section_name: str, discretization: str, results: dict[str, Any]) -> str:
    cases = [case for case in CASES if case.section == section_name and case.name in results]
    if not cases:
        return ""
    text = f"\n| {TITLES[discretization]} | | " + " | ".join(SCHEMES) + " | largest values |\n"
    text += "| --- " * (len(SCHEMES) + 3) + "|\n"
    text += "".join(row(case, results[case.name]) for case in cases)
    said = [f"- `{case.name}`, {line}.\n" for case in cases
            for line in [*lines_of(case, results[case.name]["methods"]), *note_lines(case, results[case.name]["methods"])]]
    return text + ("\n" + "".join(said) if said else "")


def counted(results: dict[str, Any]) -> dict[str, int]:
    """Runs and their ends, over all cases with a discretization."""
    all_judged = [judged for result in results.values() for judged in result["methods"].values()]
    ended = [end for judged in all_judged for end in judged.ended]
    finite = sum(judged.values.get("finite", 0) > 0 for judged in all_judged)
    return {"cases": len(results), "cases with a method": len(all_judged),
            "... that kept everything": sum(judged.kept_all for judged in all_judged),
            "... that failed in silence": sum(judged.silent for judged in all_judged),
            "... that left values that are not finite": finite,
            "... that lost particles": sum("particles" in judged.broken for judged in all_judged),
            "runs": len(ended), "runs that stopped and said so": ended.count("stopped"),
            "runs that crashed": ended.count("crashed"), "runs that did not end in time": ended.count("hung"),
            "steps": sum(judged.steps for judged in all_judged),
            "steps taken back and repeated": sum(judged.rejected for judged in all_judged)}


def kept(results: Results) -> str:
    """Cases with a method that kept everything, by scheme."""
    text = "\n| kept everything | " + " | ".join(SCHEMES) + " |\n| --- " + "| ---: " * len(SCHEMES) + "|\n"
    for discretization in DISCRETIZATIONS:
        columns = []
        for scheme in SCHEMES:
            some = [judged for result in results[discretization].values() for name, judged in result["methods"].items()
                    if BY_NAME[name].scheme == scheme]
            columns.append(f"{sum(judged.kept_all for judged in some)} of {len(some)}" if some else "")
        text += f"| {TITLES[discretization]} | " + " | ".join(columns) + " |\n"
    return text


def totals(results: Results) -> str:
    counts = [counted(results[name]) for name in DISCRETIZATIONS]
    rows = "".join(f"| {name} | " + " | ".join(str(count[name]) for count in counts) + " |\n" for name in counts[0])
    all_results = [result for of_case in results.values() for result in of_case.values()]
    versions = sorted({result["version"] for result in all_results})
    seconds = sum(result["wall_s"] for result in all_results)
    return (f"\nVersion {', '.join(versions)}; {seconds / 60:.0f} minutes on one core.\n\n"
            "| in all | " + " | ".join(TITLES[name] for name in DISCRETIZATIONS) + " |\n"
            "| --- " + "| ---: " * len(DISCRETIZATIONS) + f"|\n{rows}" + kept(results))


def reasons(results: Results) -> str:
    """How many exceptions have which cause."""
    counts = Counter(reason(case, check, BY_NAME[name]) for of_case in results.values() for case in CASES
                     if case.name in of_case for check in case.checks
                     for name, judged in of_case[case.name]["methods"].items() if check.name in judged.broken)
    text = ("\n## What the exceptions have in common\n\nSorted by case and method; that each has this cause alone has not "
            "been shown.\n\n")
    text += "".join(f"- {REASONS[k].text} {counts[k]} of the exceptions below.\n" for k in sorted(
        k for k in counts if k is not None))
    return text + f"- Others: {counts[None]}.\n"


def page(results: Results) -> str:
    return HEAD + totals(results) + reasons(results) + "".join(section(name, results) for name in SECTIONS)
