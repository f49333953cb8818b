"""Builds the module with CMake, for the python that runs this. All else is in pyproject.toml.

MINAMO_BUILD in the environment names a build folder to use, which may have been built already.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parents[2]


class CMakeModule(build_ext):
    def build_extension(self, ext):
        folder = Path(os.environ.get("MINAMO_BUILD") or self.build_temp).resolve()
        cores = str(os.cpu_count() or 1)
        if not (folder / "CMakeCache.txt").exists():
            subprocess.run(
                ["cmake", "-S", ROOT, "-B", folder, "-D", "MINAMO_PYTHON=ON", "-D", f"Python3_EXECUTABLE={sys.executable}"],
                check=True,
            )
        subprocess.run(["cmake", "--build", folder, "--target", "minamo_python", "--parallel", cores], check=True)
        (module,) = (folder / "python" / "minamo").glob("_minamo*.so")
        target = Path(self.get_ext_fullpath(ext.name)).parent
        target.mkdir(parents=True, exist_ok=True)
        shutil.copy(module, target)


setup(
    version=re.search(r"project\(minamo VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1),
    ext_modules=[Extension("minamo._minamo", [])],
    cmdclass={"build_ext": CMakeModule},
)
