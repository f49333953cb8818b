"""What the tools do when nobody reads them any more, and what tools/run and tools/setup say. In the environment: PROGRAM,
WORK."""

import os
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TOOLS = ROOT / "tools"
PROGRAM = os.environ["PROGRAM"]
WORK = Path(os.environ["WORK"])
SCENE = str(ROOT / "scenes/dam_break.json")


def without_reader(command):
    """Ends a command whose output nobody reads: exit code, and what it says of that."""
    read, write = os.pipe()
    os.close(read)
    try:
        done = subprocess.run(list(map(str, command)), stdout=write, stderr=subprocess.PIPE, text=True, check=False,
                              env=os.environ | {"PYTHONPATH": str(TOOLS)}, cwd=WORK)
    finally:
        os.close(write)
    return done.returncode, done.stderr


class ClosedPipes(unittest.TestCase):
    def expect_quiet(self, *command):
        with self.subTest(" ".join(map(str, command[:3]))):
            code, said = without_reader(command)
            self.assertEqual(said, "")
            self.assertIn(code, (0, -signal.SIGPIPE))

    def test_commands_of_the_program_end_quietly(self):
        for arguments in (["schema"], ["schema", "--table"], ["list", "systems"], ["list", "components"], ["list", "parts"],
                          ["graph", SCENE], ["check", SCENE], ["--version"], ["--help"], ["run", "--help"]):
            self.expect_quiet(PROGRAM, *arguments)

    def test_python_tools_end_quietly(self):
        self.expect_quiet(TOOLS / "report", "--help")
        for tool in ("piston", "compare_interfoam.py", "standing_wave.py"):
            self.expect_quiet(sys.executable, TOOLS / tool, "--help")
        self.expect_quiet(sys.executable, TOOLS / "piston", "--height", "0.04", "--period", "1.57", "--depth", "0.4")
        self.expect_quiet(sys.executable, "-P", "-B", "-m", "figuring", "--help")
        self.expect_quiet(sys.executable, "-P", "-B", "-m", "comparing", "--help")
        for tool in ("benchmarking", "hard_cases", "validation"):
            self.expect_quiet(sys.executable, "-B", TOOLS / tool, "--list")
            self.expect_quiet(sys.executable, "-B", TOOLS / tool, "--help")

    def test_results_are_compared_quietly(self):
        folder = WORK / "short"
        subprocess.run([PROGRAM, "run", SCENE, "--out", folder, "--set", "/time/end=0.1", "--set", "/grid/cells=[16, 16]",
                        "--quiet", "--threads", "1"], check=True)
        self.expect_quiet(sys.executable, TOOLS / "compare_interfoam.py", folder)
        self.expect_quiet(TOOLS / "report", folder)
        self.assertTrue((folder / "report.html").is_file())


class Commands(unittest.TestCase):
    def test_a_misspelt_command_is_told_before_anything_is_built(self):
        for word, meant in (("chek", "check"), ("grahp", "graph"), ("lst", "list"), ("Study", "study"), ("rnu", "run"),
                            ("scheme", "schema")):
            done = subprocess.run([TOOLS / "run", word, SCENE], capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertEqual(done.stderr, f"tools/run: unknown command \"{word}\"; did you mean {meant}?\n")

    def test_a_report_asks_for_python_where_there_is_none(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, line in (("dpkg-query", "echo installed bash"), ("apt-get", f'echo "$@" >> {folder}/calls')):
                (Path(folder) / name).write_text(f"#!/bin/sh\n{line}\n")
                (Path(folder) / name).chmod(0o755)
            done = subprocess.run([TOOLS / "report", "--help"], capture_output=True, text=True, check=False,
                                  env=os.environ | {"PATH": f"{folder}:{os.environ['PATH']}"})
            calls = Path(folder) / "calls"
            told = calls.read_text() if calls.exists() else done.stderr  # root installs, others are told how
            self.assertRegex(told, "install --yes --no-install-recommends .*python3-h5py")

    def test_the_version_has_commit_and_options(self):
        lines = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True, check=True).stdout.splitlines()
        facts = dict(line.split(maxsplit=1) for line in lines)
        self.assertIn("minamo", facts)
        self.assertRegex(facts["commit"], "^[0-9a-f]{40}$|^unknown: ")
        for option in ("PROCESSOR", "MPI", "PYTHON", "OPENVDB", "SANITIZE", "DEVELOPER"):
            self.assertRegex(facts["options"], rf"\bMINAMO_{option}=\w+")


class Configuring(unittest.TestCase):
    """tools/setup, with a cmake that writes down how it is called."""

    def setUp(self):
        self.tree = Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.tree / "tools").mkdir()
        shutil.copy(TOOLS / "setup", self.tree / "tools")
        (self.tree / "bin").mkdir()
        cmake = self.tree / "bin/cmake"
        cmake.write_text(f"#!/bin/sh\necho \"$@\" >> {self.tree}/calls\n")
        cmake.chmod(0o755)

    def configure(self, home, folder, *made, compiler="c++"):
        """What cmake is called with for a folder whose cache names these places."""
        build = self.tree / "build"
        shutil.rmtree(build, ignore_errors=True)
        (self.tree / "calls").unlink(missing_ok=True)
        build.mkdir()
        if home:
            (build / "CMakeCache.txt").write_text(f"CMAKE_HOME_DIRECTORY:INTERNAL={home}\n"
                                                  f"CMAKE_CACHEFILE_DIR:INTERNAL={folder}\n")
        for name in made:
            (build / name).touch()
        path = f"{self.tree / 'bin'}:{os.environ['PATH']}"
        subprocess.run(["bash", "-c", f"source {self.tree}/tools/setup; configure {build} -D A=B"], check=True,
                       env=os.environ | {"PATH": path, "CXX": compiler}, stderr=subprocess.DEVNULL)
        calls = self.tree / "calls"
        return calls.read_text() if calls.is_file() else ""

    def test_a_folder_that_was_copied_with_its_checkout_is_configured_anew(self):
        here, build = self.tree, self.tree / "build"
        usual = f"-S {here} -B {build} -G Ninja --log-level=WARNING -D A=B\n"
        self.assertEqual(self.configure(None, None), usual)
        self.assertEqual(self.configure(here, build, "build.ninja"), "")
        self.assertEqual(self.configure(ROOT, ROOT / "tests", "build.ninja"), "--fresh " + usual)
        self.assertEqual(self.configure("/nowhere", "/nowhere/build", "build.ninja"), "--fresh " + usual)
        self.assertEqual(self.configure(here, here / "tools", "build.ninja"), "--fresh " + usual)
        self.assertEqual(self.configure(here, build), usual)

    @unittest.skipUnless(shutil.which("clang++-14"), "no clang++-14")
    def test_the_compiler_is_clang_unless_another_is_asked_for(self):
        self.assertIn("-D CMAKE_CXX_COMPILER=clang++-14 -D A=B", self.configure(None, None, compiler=""))
        self.assertNotIn("clang", self.configure(None, None, compiler="g++"))

    def test_another_name_of_the_same_folder_is_the_same(self):
        other = self.tree / "other"
        other.symlink_to(self.tree)
        self.assertEqual(self.configure(other, other / "build", "build.ninja"), "")

    def test_a_build_says_at_once_how_far_it_is(self):
        # What is built next ends when the test has read of what is built already.
        go_on = self.tree / "go_on"
        os.mkfifo(go_on)
        (self.tree / "bin/cmake").write_text(f"#!/bin/sh\necho '1 9 12.0 an object'\nread line < {go_on}\n")
        path = f"{self.tree / 'bin'}:{os.environ['PATH']}"
        with subprocess.Popen(["bash", "-c", f"source {self.tree}/tools/setup; build {self.tree}/build all"], text=True,
                              env=os.environ | {"PATH": path}, stderr=subprocess.PIPE) as build:
            seen, _, _ = select.select([build.stderr], [], [], 10)
            with go_on.open("w") as line:
                line.write("go\n")
            said = build.stderr.read()
        self.assertTrue(seen, "nothing until the build has ended")
        self.assertEqual(said, "Building all: 1 of 9, about 2 min left\n")

    def build(self, script):
        """A build by a cmake that runs the script in its folder."""
        folder = self.tree / "build"
        folder.mkdir(exist_ok=True)
        (self.tree / "bin/cmake").write_text(f"#!/bin/sh\ncd {folder}\n{script}")
        path = f"{self.tree / 'bin'}:{os.environ['PATH']}"
        return subprocess.run(["bash", "-c", f"set -e; source {self.tree}/tools/setup; build {folder} all"], text=True,
                              env=os.environ | {"PATH": path}, stderr=subprocess.PIPE)

    def test_all_is_compiled_again_where_a_package_has_brought_other_headers(self):
        stale = "fatal error: file a.h has been modified since the precompiled header"
        (self.tree / "build").mkdir()
        (self.tree / "build/some.pch").touch()
        built = self.build('echo "$*" >> calls\n'
                           'case "$*" in *clean) rm some.pch; exit 0 ;; esac\n'
                           f"test -e some.pch || exit 0; echo {stale}; exit 1\n")
        self.assertEqual(built.returncode, 0)
        self.assertIn("Headers of a package have changed", built.stderr)
        targets = [line.split()[-1] for line in (self.tree / "build/calls").read_text().splitlines()]
        self.assertEqual(targets, ["all", "clean", "all"])

    def test_a_build_that_fails_is_not_tried_again(self):
        built = self.build("echo once >> calls; echo error; exit 1\n")
        self.assertNotEqual(built.returncode, 0)
        self.assertEqual((self.tree / "build/calls").read_text(), "once\n")


if __name__ == "__main__":
    WORK.mkdir(parents=True, exist_ok=True)
    shutil.rmtree(WORK)
    WORK.mkdir(parents=True)
    unittest.main()
