"""Docstrings as Markdown: paragraphs, indented examples, `:param x:` and `:raises X:`."""

from __future__ import annotations

import ast
import re

_field = re.compile(r":(param|raises) (\w+): ?(.*)")


def docstring(node: ast.AST) -> str:
    """That of a module, class or function, without the indentation of the source; empty if there is none."""
    text = ast.get_docstring(node, clean=False)
    if text is None:
        return ""
    # Not cleandoc(): where there is nothing but an example below the first line it takes that for the margin.
    first, _, rest = text.partition("\n")
    margin = " " * node.body[0].col_offset
    lines = [line.removeprefix(margin).rstrip() for line in rest.split("\n")]
    return "\n".join([first, *lines]).strip("\n")


def described_parameters(text: str) -> list[str]:
    """The names that `:param x:` tells of."""
    return [match[2] for match in map(_field.match, text.splitlines()) if match and match[1] == "param"]


def _plain(text: str) -> str:
    """Roles as code: :meth:`step` becomes `.step()`."""
    text = re.sub(r":meth:`([^`.]+)`", r"`.\1()`", text)
    text = re.sub(r":(?:meth|func):`([^`]+)`", r"`\1()`", text)
    return re.sub(r":(?:class|attr):`([^`]+)`", r"`\1`", text)


def _blocks(text: str) -> list[list[str]]:
    """Lines that belong together: a paragraph, an example with its empty lines, a field with what goes on below it."""
    blocks: list[list[str]] = []
    previous = ""
    for line in text.splitlines():
        is_example = bool(blocks) and blocks[-1][0].startswith("    ")
        goes_on = line.startswith("    ") or not line
        if is_example and goes_on:
            blocks[-1].append(line)
        elif line:
            is_new = not previous or _field.match(line)
            if is_new:
                blocks.append([line])
            else:
                blocks[-1].append(line)
        previous = line
    return blocks


def _as_code(lines: list[str]) -> str:
    """An example without its indentation."""
    text = "\n".join(line[4:] for line in lines).rstrip("\n")
    return f"```python\n{text}\n```"


def _as_item(lines: list[str]) -> str:
    """A field as an item of a list."""
    kind, name, rest = _field.match(lines[0]).groups()
    text = "\n".join([rest, *("  " + line.strip() for line in lines[1:])])
    return f"- raises `{name}` {text}" if kind == "raises" else f"- `{name}`: {text}"


def as_markdown(text: str) -> str:
    """The docstring, as ast.get_docstring() has it, as Markdown."""
    parts, items = [], []
    for block in _blocks(text):
        if block[0].startswith("    "):
            parts.append(_as_code(block))
        elif _field.match(block[0]):
            items.append(_plain(_as_item(block)))
        else:
            parts.append(_plain("\n".join(block)))
    if items:
        parts.append("\n".join(items))
    return "\n\n".join(parts)


def examples(text: str) -> list[str]:
    """The examples of a docstring."""
    return ["\n".join(line[4:] for line in block) for block in _blocks(text) if block[0].startswith("    ")]
