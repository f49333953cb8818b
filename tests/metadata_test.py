"""Version and licence are the same wherever they stand, and every package that is linked has its licence listed. In the
environment: PROGRAM."""

import os
import re
import subprocess
import sys
import unittest
from importlib.util import find_spec
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def found(pattern, name):
    """What the group of the pattern is in a file; it is there once."""
    (text,) = re.findall(pattern, (ROOT / name).read_text(), re.MULTILINE)
    return text


def output_of(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT / "tools/python").stdout


class Version(unittest.TestCase):
    VERSION = found(r"^project\(minamo VERSION ([\d.]+)", "CMakeLists.txt")

    def test_of_the_citation(self):
        self.assertEqual(found(r"^version: (.+)$", ".github/CITATION.cff"), self.VERSION)

    def test_of_the_program(self):
        self.assertEqual(output_of(os.environ["PROGRAM"], "--version").splitlines()[0], f"minamo {self.VERSION}")

    def test_of_the_package_in_the_readme(self):
        self.assertEqual(found(r"minamo_([\d.]+)_amd64\.deb", "README.md"), self.VERSION)

    @unittest.skipUnless(find_spec("setuptools"), "no setuptools")
    def test_of_the_python_module(self):
        self.assertEqual(output_of(sys.executable, "-B", "setup.py", "--version").split()[-1], self.VERSION)


class Licence(unittest.TestCase):
    LICENCE = found(r"^# SPDX-License-Identifier: (.+)$", "CMakeLists.txt")

    def test_is_the_same_everywhere(self):
        self.assertEqual(found(r"^license: (.+)$", ".github/CITATION.cff"), self.LICENCE)
        self.assertEqual(found(r'^license = { text = "(.+?)" }', "tools/python/pyproject.toml"), self.LICENCE)
        self.assertEqual(found(r"^minamo is under \[(.+?)\]\(LICENSE\)", "README.md"), self.LICENCE)
        # Debian's name of it.
        self.assertEqual(self.LICENCE, "GPL-3.0-or-later")
        self.assertEqual(found(r"^Files: \*\n.*\nLicense: (.+)$", "tools/cmake/copyright"), "GPL-3+")

    def test_its_text_is_there(self):
        text = (ROOT / "LICENSE").read_text()
        self.assertEqual(text.split()[:6], "GNU GENERAL PUBLIC LICENSE Version 3,".split())
        self.assertEqual((ROOT / "tools/python/LICENSE").read_text(), text)

    def test_packages_that_are_linked_are_listed(self):
        lines = [line.split() for line in (ROOT / "tools/packages").read_text().splitlines()]
        linked = {line[1] for line in lines
                  if line and line[0] in ("run", "mpi", "python", "openvdb") and line[1].endswith("-dev")}
        self.assertGreaterEqual(len(linked), 14)
        packed = found(r"^foreach\(package ([^)]+)\)", "tools/cmake/install.cmake").split()
        listed = set(re.findall(r"`([^`]+)`", (ROOT / "tools/LICENCES.md").read_text()))
        self.assertEqual(linked.union(packed) - listed, set())


if __name__ == "__main__":
    unittest.main()
