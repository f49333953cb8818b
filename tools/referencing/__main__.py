"""Writes tools/python/REFERENCE.md from the docstrings of the Python module.

Nothing is imported, so that no module has to be built. What is public and has no docstring, and what a docstring says
of a parameter that is not there, is an error.
"""

from __future__ import annotations

import argparse
import sys

from referencing.python_page import ROOT, Undocumented, page

PAGE = ROOT / "tools/python/REFERENCE.md"


def main() -> None:
    parser = argparse.ArgumentParser(prog="referencing", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true",
                        help="write nothing; exit code 2 if the page is not what would be written")
    is_check = parser.parse_args().check
    text = page()
    if not is_check:
        PAGE.write_text(text)
        print(PAGE.relative_to(ROOT))
    elif not PAGE.is_file() or PAGE.read_text() != text:
        raise Undocumented(f"{PAGE.relative_to(ROOT)} is not what the docstrings say: call tools/reference")


if __name__ == "__main__":
    try:
        main()
    except Undocumented as fault:
        print(fault, file=sys.stderr)
        sys.exit(2)
