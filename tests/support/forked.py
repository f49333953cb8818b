"""Calls of a python program from a test, each in a process of its own that has the modules already: to import them takes
longer than most calls."""

from __future__ import annotations

import os
import runpy
import subprocess
import sys
import tempfile
import traceback
from pathlib import Path


def call(program: str | Path, arguments: list[str], cwd: Path | None = None,
         environment: dict[str, str] | None = None) -> subprocess.CompletedProcess[str]:
    """What `python3 PROGRAM ARGUMENTS` does; a name without a slash is a module (`-m`)."""
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        sys.stdout.flush()
        sys.stderr.flush()
        child = os.fork()
        if child == 0:
            os._exit(_run(str(program), arguments, cwd, environment, out.fileno(), err.fileno()))
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        out.seek(0)
        err.seek(0)
        return subprocess.CompletedProcess([str(program), *arguments], code, out.read(), err.read())


def _run(program: str, arguments: list[str], cwd: Path | None, environment: dict[str, str] | None, out: int,
         err: int) -> int:
    """In the new process. Its exit code: as of an interpreter."""
    code: object = 0
    sys.modules.pop(f"{program}.__main__", None)  # runpy would warn of it
    try:
        os.dup2(out, 1)
        os.dup2(err, 2)
        sys.stdout, sys.stderr = open(1, "w", closefd=False), open(2, "w", closefd=False)
        if environment is not None:
            os.environ.clear()
            os.environ.update(environment)
        if cwd is not None:
            os.chdir(cwd)
        sys.argv = [program, *arguments]
        if "/" in program:
            sys.path.insert(0, str(Path(program).parent))
            runpy.run_path(program, run_name="__main__")
        else:
            runpy.run_module(program, run_name="__main__", alter_sys=True)
    except SystemExit as end:
        code = end.code
        if isinstance(code, str):
            print(code, file=sys.stderr)
            code = 1
    except BaseException:  # noqa: BLE001  as the interpreter does
        traceback.print_exc()
        code = 1
    sys.stdout.flush()
    sys.stderr.flush()
    return int(code or 0)
