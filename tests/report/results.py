"""Small runs of the built program, and their reports. In the environment: PROGRAM, and WORK, a folder to start anew."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any


class Results:
    """A folder with runs and pages."""

    def __init__(self, program: Path, work: Path):
        self.source = Path(__file__).resolve().parents[2]
        self.program, self.work = program.resolve(), work.resolve()
        shutil.rmtree(work, ignore_errors=True)
        work.mkdir(parents=True)

    def run(self, scene: str, name: str, *settings: str) -> Path:
        """Runs a scene of scenes/ into the folder `name`; a run that fails has results, too."""
        folder = self.work / name
        sets = [part for setting in settings for part in ("--set", setting)]
        command = [self.program, "run", self.source / f"scenes/{scene}.json", "--out", folder, "--threads", "1",
                   "--quiet", *sets]
        ended = subprocess.run(command, capture_output=True, text=True, check=False)
        if ended.returncode not in (0, 3):
            raise RuntimeError(f"{command}: {ended.stderr}")
        return folder

    def report(self, *arguments: object) -> subprocess.CompletedProcess[str]:
        """tools/report with these arguments, the graph drawn by the program under test."""
        return call("reporting", [str(part) for part in ("--program", self.program, *arguments)])

    def page(self, *folders: Path, name: str = "") -> Path:
        """The page on these folders; under another name than report.html of the first folder if one is given."""
        page = self.work / name if name else folders[0] / "report.html"
        ended = self.report(*folders, *(["--out", page] if name else []))
        if ended.returncode != 0 or ended.stderr:
            raise RuntimeError(f"tools/report {folders}: {ended.stderr}")
        return page


def summary(folder: Path) -> dict[str, Any]:
    return json.loads((folder / "summary.json").read_text())


RESULTS = Results(Path(os.environ["PROGRAM"]), Path(os.environ["WORK"]))
sys.path[:0] = [str(RESULTS.source / "tests/support"), str(RESULTS.source / "tools")]

import reporting.page  # noqa: E402, F401  for call()
from forked import call  # noqa: E402
