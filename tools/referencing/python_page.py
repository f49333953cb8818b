"""The reference of the Python module: what the package minamo has, from its signatures and docstrings."""

from __future__ import annotations

import ast
from pathlib import Path

from referencing.docstrings import as_markdown, described_parameters, docstring
from referencing.signatures import call, fields, members, parameters

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "tools/python/package/minamo"

#: Headings, each with a file and the names in it; none: those that the package exports, in the order of the file.
SECTIONS = {
    "Simulations, runs, scenes": ("simulation.py", None),
    "Results": ("results.py", None),
    "Systems, columns, parts": ("systems.py", None),
    "What a system gets in addition to columns": ("_minamo.pyi", ("Clock", "HistoryColumns")),
    "Errors": ("errors.py", None),
}
#: How a variable of a class is called in its members.
INSTANCES = {"Simulation": "sim", "Run": "run", "Clock": "clock", "HistoryColumns": "columns", "System": "system"}


class Undocumented(Exception):
    """A line per fault."""


def exported() -> list[str]:
    """The names of `__all__`."""
    for statement in ast.parse((PACKAGE / "__init__.py").read_text()).body:
        if isinstance(statement, ast.Assign) and statement.targets[0].id == "__all__":
            return ast.literal_eval(statement.value)
    return []


class Page:
    """The page as it grows, and what is wrong with the docstrings."""

    def __init__(self):
        self.lines: list[str] = []
        self.faults: list[str] = []
        self.file = Path()

    def add(self, text: str) -> None:
        """A block of lines and an empty one."""
        self.lines += [text, ""]

    def docstring(self, node: ast.AST, name: str, known: list[str]) -> str:
        """That of a function or class; notes a fault if there is none, or if it tells of other parameters."""
        where = f"{self.file.relative_to(ROOT)}:{node.lineno}"
        text = docstring(node)
        if not text:
            self.faults.append(f"{where}: {name} has no docstring")
        for parameter in described_parameters(text):
            if parameter not in known:
                self.faults.append(f"{where}: the docstring of {name} describes {parameter}, "
                                   "which is no parameter of it")
        return text

    def function(self, node: ast.FunctionDef) -> None:
        """A function of the package."""
        self.add(f"### {node.name}")
        self.add(f"```py\n{call('minamo.' + node.name, node)}\n```")
        self.add(as_markdown(self.docstring(node, node.name, parameters(node))))

    def class_(self, node: ast.ClassDef, source: list[str]) -> None:
        """A class: how it is made, its fields, its members."""
        init = next((each for each in node.body if isinstance(each, ast.FunctionDef) and each.name == "__init__"), None)
        bases = [ast.unparse(base).removeprefix("_minamo.") for base in node.bases]
        bases = [base for base in bases if base not in ("NamedTuple", "DescribedColumn")]
        self.add(f"### {node.name}" + (f" ({', '.join(bases)})" if bases else ""))
        if init and not bases and self.file.suffix == ".py":
            self.add(f"```py\n{call('minamo.' + node.name, init, first=1, result=False)}\n```")
        self.add(as_markdown(self.docstring(node, node.name, parameters(init) if init else [])))
        if rows := fields(node, source):
            self.add("\n".join(["| field | type | |", "|---|---|---|", *rows]))
        for member in members(node):
            title = member.title(INSTANCES.get(node.name, node.name))
            text = self.docstring(member.node, f"{node.name}.{member.node.name}", parameters(member.node))
            self.add(f"#### {title}")
            self.add(as_markdown(text))

    def section(self, heading: str, file: str, names: list[str]) -> list[str]:
        """Everything of a file that is named; returns the names that were there."""
        self.file = PACKAGE / file
        source = self.file.read_text()
        self.add(f"## {heading}")
        described = []
        for node in ast.parse(source).body:
            if isinstance(node, ast.FunctionDef) and node.name in names:
                self.function(node)
            elif isinstance(node, ast.ClassDef) and node.name in names:
                self.class_(node, source.splitlines())
            elif isinstance(node, ast.Assign) and node.targets[0].id in names:
                self.add(f"### {node.targets[0].id}")
                self.add(f"`minamo.{node.targets[0].id}` is `minamo.{ast.unparse(node.value)}`.")
            else:
                continue
            described.append(node.targets[0].id if isinstance(node, ast.Assign) else node.name)
        return described


def page() -> str:
    """The whole text.

    :raises Undocumented: with every fault
    """
    names = exported()
    written = Page()
    written.add("# Reference of the Python module")
    written.add("<!-- Written by tools/reference from the docstrings in tools/python/package. -->")
    written.add(as_markdown(docstring(ast.parse((PACKAGE / "__init__.py").read_text()))))
    described = []
    for heading, (file, of_file) in SECTIONS.items():
        described += written.section(heading, file, of_file or names)
    faults = written.faults + [f"{PACKAGE.relative_to(ROOT)}/__init__.py: exports {name}, which no section of the "
                               "reference has" for name in names if name not in described]
    if faults:
        raise Undocumented("\n".join(faults))
    return "\n".join(written.lines).rstrip("\n") + "\n"
