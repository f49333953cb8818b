"""RESULTS.md from results.json: what was kept, what was broken, by whom and how far."""

from __future__ import annotations

import subprocess
from collections import Counter
from pathlib import Path
from typing import Any

from case import Case, Check
from catalogue import ABOUT, CASES, SECTIONS
from judge import NOTHING, Judged
from methods import METHODS, SCHEMES, listed
from reasons import REASONS, reason

Results = dict[str, Any]  # by case: version, wall_s, methods (name: Judged)
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

Hard cases with every transfer scheme, integrator and volume correction: what they kept, and what they broke.
`tools/stability` ran them and wrote this page; `tools/stability NAME...` replaces single cases or sections,
`tools/stability --list` names them. The checks, and the reasons for their limits, are in
[checks.py](../../tools/hard_cases/checks.py).

- A number counts the methods with this scheme (newmark and midpoint, each with volume correction none, delta and
  projection) that kept everything the case asks for. Below the table stands what the others broke.
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
    """Empty if nothing of it has run."""
    cases = [case for case in CASES if case.section == name and case.name in results]
    if not cases:
        return ""
    text = f"\n## {name.replace('_', ' ').capitalize()}\n\n{ABOUT[name]}\n\n"
    text += "| case | | " + " | ".join(SCHEMES) + " | largest values |\n" + "| --- " * (len(SCHEMES) + 3) + "|\n"
    text += "".join(row(case, results[case.name]) for case in cases)
    said = [f"- `{case.name}`, {line}.\n" for case in cases
            for line in [*lines_of(case, results[case.name]["methods"]), *note_lines(case, results[case.name]["methods"])]]
    return text + ("\n" + "".join(said) if said else "")


def totals(results: Results) -> str:
    """Runs and their ends, over all cases."""
    all_judged = [judged for result in results.values() for judged in result["methods"].values()]
    ended = [end for judged in all_judged for end in judged.ended]
    finite = sum(judged.values.get("finite", 0) > 0 for judged in all_judged)
    lines = [("cases", len(results)), ("cases with a method", len(all_judged)),
             ("... that kept everything", sum(judged.kept_all for judged in all_judged)),
             ("... that failed in silence", sum(judged.silent for judged in all_judged)),
             ("... that left values that are not finite", finite),
             ("... that lost particles", sum("particles" in judged.broken for judged in all_judged)),
             ("runs", len(ended)), ("runs that stopped and said so", ended.count("stopped")),
             ("runs that crashed", ended.count("crashed")), ("runs that did not end in time", ended.count("hung")),
             ("steps", sum(judged.steps for judged in all_judged)),
             ("steps taken back and repeated", sum(judged.rejected for judged in all_judged))]
    table = "".join(f"| {name} | {count} |\n" for name, count in lines)
    versions = sorted({result["version"] for result in results.values()})
    seconds = sum(result["wall_s"] for result in results.values())
    return (f"\nVersion {', '.join(versions)}; {seconds / 60:.0f} minutes on one core.\n\n"
            f"| in all | |\n| --- | ---: |\n{table}")


def reasons(results: Results) -> str:
    """How many exceptions have which cause."""
    counts = Counter(reason(case, check, BY_NAME[name]) for case in CASES if case.name in results
                     for check in case.checks for name, judged in results[case.name]["methods"].items()
                     if check.name in judged.broken)
    text = ("\n## What the exceptions have in common\n\nSorted by case and method; that each has this cause alone has not "
            "been shown.\n\n")
    text += "".join(f"- {REASONS[k].text} {counts[k]} of the exceptions below.\n" for k in sorted(
        k for k in counts if k is not None))
    return text + f"- Others: {counts[None]}.\n"


def page(results: Results) -> str:
    return HEAD + totals(results) + reasons(results) + "".join(section(name, results) for name in SECTIONS)
