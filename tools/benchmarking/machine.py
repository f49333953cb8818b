"""The machine and the compiler that numbers belong to."""

from __future__ import annotations

import os
import platform
import re
from pathlib import Path


def machine(build: Path) -> dict[str, str]:
    """What a page of numbers must say. CPUs are those that this process may use."""
    info = Path("/proc/cpuinfo").read_text()
    return {"cpu": f"{entry(info, 'model name')} (family {entry(info, 'cpu family')}, model {entry(info, 'model')})",
            "cpus": str(len(os.sched_getaffinity(0))), "memory": memory(), "compiler": compiler(build),
            "system": f"Linux {platform.release().split('-')[0]}"}


def entry(info: str, name: str) -> str:
    """A line of /proc/cpuinfo."""
    found = re.search(rf"^{name}\s*: (.+)$", info, re.MULTILINE)
    return found[1] if found else "unknown"


def memory() -> str:
    kilobytes = re.search(r"^MemTotal: +(\d+)", Path("/proc/meminfo").read_text(), re.MULTILINE)
    return f"{int(kilobytes[1]) / 2**20:.0f} GiB" if kilobytes else "unknown"


def compiler(build: Path) -> str:
    """What CMake has found in a build folder."""
    for file in build.glob("CMakeFiles/*/CMakeCXXCompiler.cmake"):
        values = dict(re.findall(r'^set\(CMAKE_CXX_COMPILER_(ID|VERSION) "(.+)"\)$', file.read_text(), re.MULTILINE))
        return f"{values.get('ID', 'unknown')} {values.get('VERSION', '')}"
    return "unknown"
