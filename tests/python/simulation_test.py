"""Simulations in memory against the program, and what goes wrong with them."""

import json
import logging
import os
import re
import shutil
import signal
import threading
import time
import unittest

import numpy as np

import minamo
from support import PROGRAM, ROOT, as_stored, folder, in_space, program, scene, state_of


def run_program(test, described, steps, name):
    """The folder of `minamo run` of the scene."""
    out = folder(name)
    (out / "in.json").write_text(json.dumps(described))
    run = program("run", out / "in.json", "--out", out / "out", "--threads", 1, "--steps", steps, "--quiet")
    test.assertEqual(run.returncode, 0, run.stderr)
    return out


class SameBits(unittest.TestCase):
    def compare(self, described, steps, name, threads):
        out = run_program(self, described, steps, name)
        sim = minamo.Simulation(described, threads=threads)
        self.assertEqual(sim.step(steps), steps)
        compared = 0
        for column, stored in state_of(out / "out").items():
            if column not in sim:
                continue
            np.testing.assert_array_equal(as_stored(sim[column]), stored.reshape(len(stored), -1), column)
            compared += 1
        self.assertGreaterEqual(compared, 6)
        return out, sim

    def test_plane(self):
        for threads in (1, 2):
            with self.subTest(threads=threads):
                out, sim = self.compare(scene(), 10, "plane", threads)
        history = minamo.Run(out / "out").history
        self.assertEqual(list(history), list(sim.history))
        for name, column in sim.history.items():
            np.testing.assert_array_equal(column, history[name], name)
        self.assertEqual(sim.row["step"], 10)

    def test_space(self):
        self.compare(in_space(), 4, "space", 2)

    def test_equal_order_with_steps_of_a_cfl_number(self):
        self.compare(scene(discretization={"scheme": "equal_order"}, time={"end": 0.2, "cfl": 0.5}), 8, "cfl", 1)

    def test_pressure_of_a_frame(self):
        described = scene(time={"end": 0.04, "step": 0.004}, output={"every": 0.04, "precision": "double"})
        out = run_program(self, described, 10, "frame")
        sim = minamo.Simulation(scene(time={"end": 0.04, "step": 0.004}), threads=1)
        sim.run()
        frame = minamo.Run(out / "out").particles()
        np.testing.assert_array_equal(sim["particle.id"], frame["id"])
        np.testing.assert_array_equal(sim["particle.pressure"], frame["pressure"])
        np.testing.assert_array_equal(sim["particle.position"], frame["position"])

    def test_pressure_between_frames_is_that_of_now(self):
        sim = minamo.Simulation(scene(), threads=1)
        sim.step(3)
        x = sim["particle.position"]
        p = sim["particle.pressure"].copy()
        self.assertTrue(x.flags.writeable, "asking for the pressure must not take other arrays away")
        other = minamo.Simulation(scene(output={"every": 0.004}), threads=1)
        other.step(3)
        np.testing.assert_array_equal(p, other["particle.pressure"])

    def test_a_look_at_everything_changes_nothing(self):
        looked_at, other = (minamo.Simulation(scene(), threads=1) for _ in range(2))
        for _ in range(5):
            held = [looked_at[name] for name in looked_at.keys()]
            looked_at.step()
        del held
        other.step(5)
        np.testing.assert_array_equal(looked_at["particle.velocity"], other["particle.velocity"])

    def test_run_into_a_folder(self):
        out = folder("into")
        (out / "in.json").write_text(json.dumps(scene()))
        run = minamo.run(out / "in.json", out / "python", threads=1, steps=6)
        self.assertEqual(program("run", out / "in.json", "--out", out / "program", "--steps", 6, "--threads", 1,
                                 "--quiet").returncode, 0)
        for name in ("history.csv", "scene.json", "fields.xdmf"):
            self.assertEqual((out / "python" / name).read_bytes(), (out / "program" / name).read_bytes(), name)
        self.assertEqual(run.summary["steps"], 6)
        with self.assertRaisesRegex(minamo.InputError, "an unfinished run would be replaced"):
            minamo.run(out / "in.json", out / "python", threads=1, steps=6)
        minamo.run(out / "in.json", out / "python", threads=1, steps=6, overwrite=True)
        with self.assertRaisesRegex(ValueError, "overwrite"):
            minamo.run(out / "in.json", out / "python", threads=1, resume=True, overwrite=True)
        self.assertEqual(minamo.run(out / "in.json", out / "python", threads=1, resume=True).summary["steps"], 50)


class Time(unittest.TestCase):
    def test_until_and_end(self):
        sim = minamo.Simulation(scene(), threads=1)
        self.assertEqual((sim.time, sim.steps, sim.is_over), (0, 0, False))
        self.assertEqual(sim.run(until=0.02), 5)
        self.assertAlmostEqual(sim.time, 0.02, places=15)
        self.assertEqual(sim.run(until=0.02), 0)
        self.assertEqual(sim.run(until=0.0201), 1, "the first step that reaches the time")
        sim.run()
        self.assertEqual((sim.time, sim.steps, sim.is_over), (0.2, 50, True))
        self.assertEqual(sim.step(), 0)

    def test_history_every_third_step(self):
        sim = minamo.Simulation(scene(output={"every": 0.1, "history": 3}), threads=1)
        sim.step(7)
        np.testing.assert_array_equal(sim.history["step"], [0, 3, 6])

    def test_description(self):
        sim = minamo.Simulation(in_space(), threads=1)
        self.assertEqual(sim.dimension, 3)
        self.assertEqual(sim.grid, {"low": [0, 0, 0], "high": [1, 0.5, 1], "cells": [8, 4, 8], "spacing": 0.125})
        self.assertEqual(sim.scene["transfer"]["scheme"], "tpic")
        self.assertIn("Falling block", repr(sim))

    def test_numbers_of_numpy(self):
        sim = minamo.Simulation(scene(body_force=np.array([0, -9.81]), fluid={"density": np.float64(1000), "viscosity": 0}))
        self.assertEqual(sim.scene["body_force"], [0, -9.81])


class Errors(unittest.TestCase):
    def test_broken_scenes_are_refused_in_the_words_of_the_program(self):
        out = folder("broken")
        broken = ROOT / "tests/error"
        count = 0
        before = os.getcwd()
        os.chdir(out)
        try:
            for path in sorted(broken.glob("*.json")):
                if path.with_suffix(".args").exists():
                    continue
                shutil.copy(path, out)
                if path.with_suffix(".obj").exists():
                    shutil.copy(path.with_suffix(".obj"), out)
                with self.subTest(scene=path.name):
                    with self.assertRaises(minamo.InputError) as raised:
                        minamo.Simulation(path.name)
                    text = path.with_suffix(".txt").read_text()
                    self.assertEqual(str(raised.exception) + "\n", text)
                    self.assertEqual("\n".join(map(str, minamo.check(path.name))) + "\n", text)
                    self.assertEqual(len(raised.exception.problems), len(minamo.check(path.name)))
                count += 1
        finally:
            os.chdir(before)
        self.assertGreater(count, 100)

    def test_parts_of_a_problem(self):
        problem, = minamo.check(scene(transfer={"scheme": "apci"}))
        self.assertEqual(problem.file, "scene")
        self.assertEqual(problem.pointer, "/transfer/scheme")
        self.assertEqual(problem.closest, "apic")
        self.assertIn("closest   \"apic\"", str(problem))
        self.assertEqual(minamo.check(scene()), [])

    def test_no_file(self):
        with self.assertRaisesRegex(minamo.InputError, "nowhere.json: no such file"):
            minamo.Simulation("nowhere.json")

    def test_what_is_no_json(self):
        with self.assertRaisesRegex(TypeError, "a scene has numbers"):
            minamo.Simulation(scene(title=object()))
        with self.assertRaisesRegex(minamo.InputError, "scene: line 1, column .*: NaN, which is no number of JSON"):
            minamo.Simulation(scene(body_force=[0, float("nan")]))

    def test_threads(self):
        for threads in (0, -1, 1.5, True):
            with self.subTest(threads=threads), self.assertRaisesRegex(minamo.InputError, "threads: out of range"):
                minamo.Simulation(scene(), threads=threads)

    def test_arguments(self):
        sim = minamo.Simulation(scene(), threads=1)
        for call, message in ((lambda: sim.step(-1), "n: out of range"), (lambda: sim.step(1.5), "n: out of range"),
                              (lambda: sim.run(float("nan")), "until: out of range"),
                              (lambda: minamo.run(scene(), folder("never"), steps=-1), "steps: out of range")):
            with self.assertRaisesRegex(minamo.InputError, message):
                call()
        self.assertEqual(sim.steps, 0)

    def test_other_exceptions_are_still_caught_as_python_does(self):
        self.assertTrue(issubclass(minamo.InputError, ValueError))
        self.assertTrue(issubclass(minamo.UnknownName, KeyError))


class Interrupts(unittest.TestCase):
    def interrupt(self, call):
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        begin = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            call()
        self.assertLess(time.monotonic() - begin, 2)

    def test_ctrl_c_leaves_the_simulation_usable(self):
        sim = minamo.Simulation(scene(time={"end": 1e4, "step": 1e-3}), threads=1)
        self.interrupt(sim.run)
        steps = sim.steps
        self.assertGreater(steps, 0)
        self.assertEqual(sim.step(2), 2)
        self.assertEqual(sim.steps, steps + 2)

    def test_ctrl_c_of_a_run_into_a_folder(self):
        out = folder("interrupted")
        self.interrupt(lambda: minamo.run(scene(time={"end": 1e4, "step": 1e-3}), out, threads=1))
        self.assertEqual(minamo.Run(out).summary["status"], "interrupted")
        self.assertEqual(signal.getsignal(signal.SIGINT), signal.default_int_handler)
        self.interrupt(lambda: time.sleep(5))

    def test_other_threads_run_while_steps_are_taken(self):
        sim = minamo.Simulation(scene(time={"end": 1e4, "step": 1e-3}), threads=1)
        count = 0
        done = threading.Event()

        def counting():
            nonlocal count
            while not done.is_set():
                count += 1
                time.sleep(1e-3)

        other = threading.Thread(target=counting)
        other.start()
        begin = time.monotonic()
        sim.step(200)
        wall = time.monotonic() - begin
        done.set()
        other.join()
        # One count takes at least a millisecond; a thread that waits for the interpreter would make a few.
        self.assertGreater(count, 200 * wall)

    def test_one_step_at_a_time(self):
        sim = minamo.Simulation(scene(time={"end": 1e4, "step": 1e-3}), threads=1)
        other = threading.Thread(target=sim.step, args=(3000,))
        other.start()
        time.sleep(0.05)
        with self.assertRaisesRegex(minamo.RunError, "is in a step"):
            sim.step()
        with self.assertRaisesRegex(minamo.RunError, "is in a step"):
            sim["particle.mass"]
        other.join()
        self.assertEqual(sim.steps, 3000)


class Log(unittest.TestCase):
    def test_rejected_steps_are_logged(self):
        @minamo.system(slot="accept", reads=["clock"], standing=False)
        def reject_long(clock):
            if clock.step > 0.003:
                raise minamo.StepRejected("too long")

        sim = minamo.Simulation(scene(), threads=1, systems=[reject_long])
        with self.assertLogs("minamo", logging.WARNING) as logged:
            sim.step()
        self.assertIn("is taken back: reject_long: too long", logged.output[0])
        self.assertEqual(sim.rejected, 1)
        self.assertEqual(sim.last_step, 0.002)
        np.testing.assert_array_equal(sim.history["step"], [0, 1])


class Lists(unittest.TestCase):
    def test_what_the_program_lists(self):
        for what in ("systems", "components"):
            lines = program("list", what).stdout.splitlines()[2:]
            first = [re.match(r"\| (?:\[(\w+)\]\((.*?)\)|([\w.]+)) \|", line).groups() for line in lines]
            self.assertEqual([entry["name"] for entry in minamo.list(what)], [linked or name for linked, _, name in first])
            self.assertEqual([entry.get("file", "").removeprefix("systems/") for entry in minamo.list(what)],
                             [file or "" for _, file, _ in first])
        for what in ("parts", "schemes", "solvers"):
            lines = program("list", what).stdout.splitlines()
            self.assertEqual([entry["name"] for entry in minamo.list(what)], [line.split()[0] for line in lines])

    def test_unknown_list(self):
        with self.assertRaisesRegex(minamo.InputError, 'closest   "systems"'):
            minamo.list("sistems")

    def test_schema(self):
        self.assertEqual(minamo.schema(), json.loads(program("schema").stdout))

    def test_version(self):
        self.assertIn(minamo.__version__, program("--version").stdout)
        self.assertTrue(PROGRAM)


if __name__ == "__main__":
    unittest.main()
