"""Functions and classes of a parsed source as a reader calls them."""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass

WIDTH = 100

#: Members that are called by an operator.
_operators = {"__getitem__": "{of}[name] -> {result}", "__setitem__": "{of}[name] = {value}",
              "__contains__": "name in {of}", "__iter__": "for name in {of}", "__len__": "len({of}) -> {result}",
              "__call__": "{of}(...)"}


def parameters(node: ast.FunctionDef) -> list[str]:
    """The names of all parameters."""
    of = node.args
    alone = [each for each in (of.vararg, of.kwarg) if each]
    return [each.arg for each in (*of.posonlyargs, *of.args, *of.kwonlyargs, *alone)]


def _type(annotation: ast.expr | None) -> str:
    return ast.unparse(annotation).replace("builtins.", "") if annotation else "None"


def _parameter(each: ast.arg, default: ast.expr | None) -> str:
    text = each.arg + (f": {_type(each.annotation)}" if each.annotation else "")
    if default is None:
        return text
    value = ast.unparse(default).replace("'", '"')
    return f"{text} = {value}" if each.annotation else f"{text}={value}"


def _all_parameters(node: ast.FunctionDef, first: int) -> list[str]:
    """As they stand in the source, from the `first` on."""
    of = node.args
    defaults = [None] * (len(of.args) - len(of.defaults)) + of.defaults
    texts = [_parameter(each, default) for each, default in zip(of.args, defaults)][first:]
    if of.kwonlyargs:
        texts.append("*")
    texts += [_parameter(each, default) for each, default in zip(of.kwonlyargs, of.kw_defaults)]
    if of.kwarg:
        texts.append("**" + _parameter(of.kwarg, None))
    return texts


def call(name: str, node: ast.FunctionDef, first: int = 0, result: bool = True) -> str:
    """The call with types and defaults, on several lines where it is long."""
    texts = _all_parameters(node, first)
    end = f") -> {_type(node.returns)}" if result and node.returns else ")"
    line = f"{name}({', '.join(texts)}{end}"
    if len(line) <= WIDTH:
        return line
    return f"{name}(\n    " + ",\n    ".join(texts) + "\n" + end


def fields(node: ast.ClassDef, source: list[str]) -> list[str]:
    """Rows of a table: the fields of a NamedTuple or dataclass, with what `#:` says behind them."""
    rows = []
    for each in node.body:
        if not isinstance(each, ast.AnnAssign):
            continue
        said = re.search(r"#: (.*)", source[each.lineno - 1])
        default = f" = {ast.unparse(each.value)}" if each.value else ""
        kind = f"{_type(each.annotation)}{default}".replace("|", "or").replace("'", '"')
        rows.append(f"| `{each.target.id}` | `{kind}` | {said[1] if said else ''} |")
    return rows


@dataclass(frozen=True)
class Member:
    """A method or a property."""

    node: ast.FunctionDef

    def title(self, of: str) -> str:
        """How it is called for an object `of`."""
        name = self.node.name
        if name in _operators:
            return _operators[name].format(of=of, value=self.node.args.args[-1].arg, result=_type(self.node.returns))
        if any(getattr(each, "id", None) in ("property", "cached_property") for each in self.node.decorator_list):
            return f"{of}.{name} -> {_type(self.node.returns)}"
        return " ".join(call(f"{of}.{name}", self.node, first=1).split())


def members(node: ast.ClassDef) -> list[Member]:
    """What is public, in the order of the source."""
    functions = [each for each in node.body if isinstance(each, ast.FunctionDef)]
    return [Member(each) for each in functions if not each.name.startswith("_") or each.name in _operators]
