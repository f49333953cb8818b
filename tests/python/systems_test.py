"""Systems, columns and parts that are written in python."""

import time
import unittest
import weakref

import numpy as np

import minamo
from support import folder, scene


class Works(unittest.TestCase):
    def test_a_force_in_python_gives_the_bits_of_the_same_force_of_the_program(self):
        @minamo.system(slot="forces", updates=["node.body_force"])
        def gravity(b):
            b[:, 1] -= 9.81

        nodes = {"discretization": {"scheme": "equal_order"}, "volume": {"scheme": "none"}}
        for threads in (1, 2):
            with self.subTest(threads=threads):
                python = minamo.Simulation(scene(body_force=[0, 0], **nodes), threads=threads, systems=[gravity])
                program = minamo.Simulation(scene(**nodes), threads=threads)
                for sim in (python, program):
                    sim.step(10)
                np.testing.assert_array_equal(python["particle.velocity"], program["particle.velocity"])
                self.assertLess(python["particle.velocity"][:, 1].min(), -0.3)

    def test_damping_by_hand(self):
        @minamo.system(slot="g2p", reads=["particle.position"], updates=["particle.velocity"], standing=False)
        def stop(x, v):
            v[x[:, 0] > 0.25] = 0

        sim = minamo.Simulation(scene(), threads=1, systems=[stop])
        sim.step()
        # The step moves particles by nodal displacements, not by this velocity, so they are where they would be.
        other = minamo.Simulation(scene(), threads=1)
        other.step()
        old = minamo.Simulation(scene(), threads=1)["particle.position"]
        by_id = np.argsort(sim["particle.id"])
        was_right = old[by_id, 0] > 0.25
        v, v_other = (s["particle.velocity"][np.argsort(s["particle.id"])] for s in (sim, other))
        self.assertTrue((v[was_right] == 0).all())
        np.testing.assert_array_equal(v[~was_right], v_other[~was_right])

    def test_a_column_of_ones_own_goes_where_its_particle_goes(self):
        tag = minamo.column("particle.tag", unit="1", start=-1)

        @minamo.system(slot="accept", reads=["particle.id"], updates=[tag])
        def name_once(number, t):
            t[t < 0] = number[t < 0]

        moving = scene(time={"end": 1, "cfl": 0.8})
        sim = minamo.Simulation(moving, threads=1, systems=[name_once])
        first = sim["particle.id"].copy()
        sim.step(40)
        np.testing.assert_array_equal(sim["particle.tag"], sim["particle.id"])
        self.assertTrue((sim["particle.id"] != first).any(), "particles have changed places")
        self.assertEqual(sim.columns["particle.tag"]["lifetime"], "state")
        self.assertNotIn("particle.tag", minamo.Simulation(moving, threads=1))

    def test_columns_of_the_history(self):
        @minamo.system(slot="measure", reads=["particle.mass", "particle.position", "clock"], updates=["measure.columns"])
        def mean_height(m, x, clock, columns):
            columns["mean_height"] = m @ x[:, 1] / m.sum()

        sim = minamo.Simulation(scene(), threads=1, systems=[mean_height])
        sim.step(3)
        self.assertEqual(len(sim.history["mean_height"]), 4)
        m, x = sim["particle.mass"], sim["particle.position"]
        self.assertEqual(sim.row["mean_height"], m @ x[:, 1] / m.sum())
        run = minamo.run(scene(), folder("measured"), threads=1, steps=3, systems=[mean_height])
        np.testing.assert_array_equal(run.history["mean_height"], sim.history["mean_height"])

    def test_scratch_of_ones_own(self):
        speed = minamo.column("particle.speed", unit="m/s", lifetime="scratch")
        seen = []

        @minamo.system(slot="g2p", reads=["particle.velocity"], writes=[speed])
        def compute(v, s):
            s[:] = np.hypot(*v.T)

        @minamo.system(slot="advect", reads=[speed])
        def use(s):
            seen.append(s.max())

        sim = minamo.Simulation(scene(), threads=2, systems=[compute, use])
        sim.step(2)
        self.assertEqual(len(seen), 2)
        with self.assertRaisesRegex(minamo.InputError, 'system "use" reads particle.speed, which no earlier system'):
            minamo.Simulation(scene(), threads=1, systems=[use])

    def test_a_part_reads_its_key(self):
        temperature = minamo.column("particle.temperature", unit="K", start=300)

        @minamo.part("cooling", "heat lost", rate=minamo.Number("1/s", "share lost", at_least=0),
                     outside=minamo.Number("K", "of the air", default=280))
        def cooling(rate, outside):
            @minamo.system(slot="g2p", reads=["clock"], updates=[temperature])
            def cool(clock, T):
                T -= rate * clock.step * (T - outside)
            return [cool]

        sim = minamo.Simulation(scene(cooling={"rate": 2}), threads=1, parts=[cooling])
        sim.step(5)
        np.testing.assert_allclose(sim["particle.temperature"], 280 + 20 * (1 - 2 * 0.004)**5, rtol=1e-14)
        self.assertEqual(sim.scene["cooling"], {"rate": 2, "outside": 280})
        self.assertNotIn("particle.temperature", minamo.Simulation(scene(), threads=1, parts=[cooling]))
        problem, = minamo.check(scene(cooling={"rate": -2}), parts=[cooling])
        self.assertEqual(str(problem), "scene: /cooling/rate: out of range\n  expected  a number >= 0 [1/s]\n"
                                       "  got       -2 (number)")
        problem, = minamo.check(scene(coolng={"rate": 2}), parts=[cooling])
        self.assertEqual(problem.closest, "cooling")


class Refused(unittest.TestCase):
    def refused(self, kind, message, function, **declared):
        made = minamo.system(**declared)(function)
        with self.assertRaisesRegex(kind, message):
            minamo.Simulation(scene(), threads=1, systems=[made])

    def test_what_there_is_not(self):
        self.refused(minamo.InputError, r'system "<lambda>": reads: unknown component\n(.*\n)*  closest   "particle.velocity"',
                     lambda v: None, slot="g2p", reads=["particle.velocty"])
        self.refused(minamo.InputError, r'system "<lambda>": slot: unknown slot\n(.*\n)*  closest   "forces"',
                     lambda v: None, slot="force", reads=["particle.velocity"])
        self.refused(minamo.InputError, "reads: no system of this scene names it", lambda a: None, slot="g2p",
                     reads=["node.pressure"])
        self.refused(minamo.InputError, "reads: is no column", lambda a: None, slot="g2p", reads=["grid"])
        self.refused(minamo.InputError, "updates: can be read, not written", lambda a: None, slot="g2p",
                     updates=["particle.id"])
        self.refused(minamo.InputError, "updates: wrong access", lambda a: None, slot="g2p", updates=["clock"])

    def test_what_is_not_there_yet(self):
        self.refused(minamo.InputError, r'system "early": slot: system "early" reads face.new_velocity, which no earlier '
                                        r'system of the step writes\n  expected  one of \["correct", "g2p"',
                     lambda v: None, name="early", slot="p2g", reads=["face.new_velocity"])

    def test_twice(self):
        self.refused(minamo.ScheduleError, 'system "twice" names particle.velocity twice', lambda a, b: None,
                     name="twice", slot="g2p", reads=["particle.velocity"], updates=["particle.velocity"])

    def test_declarations(self):
        with self.assertRaisesRegex(minamo.InputError, r'system "few": does not take what it declares\n  expected  2 param'):
            minamo.system(name="few", slot="g2p", reads=["particle.mass"], updates=["particle.velocity"])(lambda v: None)
        with self.assertRaisesRegex(minamo.InputError, "reads is one name"):
            minamo.system(slot="g2p", reads="particle.mass")
        for wrong in ({"name": "tag"}, {"name": "particle.tag", "shape": "tensor"}, {"name": "a.b", "lifetime": "cache"}):
            with self.assertRaises(minamo.InputError):
                minamo.column(**wrong)
        odd = minamo.column("partcle.tag")
        self.refused(minamo.InputError, r'column of an unknown table\n(.*\n)*  closest   "particle"', lambda t: None,
                     slot="g2p", updates=[odd])

    def test_names_that_are_taken(self):
        def empty(name):
            return minamo.system(slot="g2p", name=name)(lambda: None)

        for systems in ([empty("same"), empty("same")], [empty("g2p_faces_tpic")]):
            with self.assertRaisesRegex(minamo.InputError, 'system ".*": there is one of that name'):
                minamo.Simulation(scene(), threads=1, systems=systems)
        with self.assertRaisesRegex(minamo.InputError, 'part "fluid": there is one of that name'):
            minamo.Simulation(scene(), threads=1, parts=[minamo.part("fluid", "mine")(lambda: [])])

    def test_what_is_no_system(self):
        for wrong in (len, [len], minamo.system(slot="g2p", name="one")(lambda: None)):
            with self.assertRaises(TypeError):
                minamo.Simulation(scene(), threads=1, systems=wrong)
        with self.assertRaisesRegex(TypeError, "expected a system, as minamo.system makes them, got 3"):
            minamo.Simulation(scene(mine={}), threads=1, parts=[minamo.part("mine", "bad")(lambda: [3])])

    def test_two_columns_of_one_name(self):
        a, b = minamo.column("particle.tag"), minamo.column("particle.mass")
        self.refused(minamo.ScheduleError, "names particle.tag twice", lambda x, y: None, slot="g2p", reads=[a],
                     updates=[a])
        self.refused(minamo.InputError, "particle.mass", lambda x: None, slot="g2p", updates=[b])


class Fails(unittest.TestCase):
    def step(self, function, message, kind, threads=1, **declared):
        """The step fails with the message, and the simulation stands where it stood."""
        calls = []

        def second_time(*arguments):
            calls.append(1)
            if len(calls) > 1:
                return function(*arguments)
            if "writes" in declared:
                arguments[-1][:] = 0
            return None

        parameters = len([name for names in declared.values() if isinstance(names, list) for name in names])
        signature = ", ".join("abcd"[:parameters])
        made = eval(f"lambda {signature}: second_time({signature})", {"second_time": second_time})
        sim = minamo.Simulation(scene(), threads=threads,
                                systems=[minamo.system(name="bad", standing=False, **declared)(made)])
        sim.step()
        before = {name: sim[name].copy() for name in sim if sim.columns[name]["lifetime"] == "state"}
        with self.assertRaisesRegex(kind, message) as raised:
            sim.step()
        self.assertEqual(sim.steps, 1)
        for name, values in before.items():
            np.testing.assert_array_equal(sim[name], values, name)
        return sim, raised.exception

    def test_exceptions_come_out_as_they_are(self):
        def fail(v):
            v[:] = 7
            raise ZeroDivisionError("of mine")

        for threads in (1, 2):
            sim, error = self.step(fail, "of mine", ZeroDivisionError, threads, slot="g2p", updates=["particle.velocity"])
            self.assertIn('in system "bad" of slot "g2p" (step 2, t = 0.004 s)', error.__notes__)
            with self.assertRaisesRegex(minamo.RunError, "means nothing after a step that has failed"):
                sim["face.new_velocity"]

    def test_what_is_read_cannot_be_written(self):
        def write(v):
            v[0] = 1

        self.step(write, "read-only", ValueError, slot="g2p", reads=["particle.velocity"])

    def test_a_kept_array_is_an_error_and_stays_readable(self):
        for declared in ({"reads": ["particle.velocity"]}, {"updates": ["particle.velocity"]}):
            for threads in (1, 2):
                kept = []
                sim, _ = self.step(lambda v: kept.append(v[::2]), "bad.* keeps an array of a column beyond its call",
                                   minamo.RunError, threads, slot="g2p", **declared)
                before = kept[0].copy()
                del sim
                np.testing.assert_array_equal(kept[0], before)

    def test_a_row_that_is_not_written(self):
        def write(v):
            v[:-1] = 0

        column = minamo.column("particle.half", lifetime="scratch")
        self.step(write, "writes particle.half, but row .* is not a number", minamo.RunError, slot="g2p", writes=[column])

    def test_a_place_outside_the_grid(self):
        for place in (2, np.nan, np.inf):
            def throw(x, place=place):
                x[1] = place

            self.step(throw, r'system "bad" has gone wrong: particle.position: row 1 was set to a place outside the grid',
                      minamo.RunError, slot="advect", updates=["particle.position"])

    def test_what_is_not_declared_is_out_of_reach(self):
        def look():
            sim["particle.mass"]

        sim = minamo.Simulation(scene(), threads=1, systems=[minamo.system(slot="g2p")(look)])
        with self.assertRaisesRegex(minamo.RunError, "is in a step; a system declares what it reads"):
            sim.step()

    def test_history_columns_end_with_the_call(self):
        kept = []
        sim = minamo.Simulation(scene(), threads=1, systems=[
            minamo.system(slot="measure", updates=["measure.columns"])(lambda columns: kept.append(columns))])
        del sim
        with self.assertRaisesRegex(ValueError, "while the system runs"):
            kept[0]["late"] = 1

    def test_a_failure_at_the_start(self):
        def fail():
            raise ZeroDivisionError("at once")

        with self.assertRaisesRegex(ZeroDivisionError, "at once"):
            minamo.Simulation(scene(), threads=1, systems=[minamo.system(slot="measure")(fail)])
        with self.assertRaisesRegex(ZeroDivisionError, "at once"):
            minamo.run(scene(), folder("failed"), threads=1, systems=[minamo.system(slot="g2p")(fail)])


class Cost(unittest.TestCase):
    def test_an_empty_system_costs_less_than_20_us(self):
        small = scene(grid={"low": [0, 0], "high": [1, 1], "cells": [3, 3]}, time={"end": 1e6, "step": 1e-3},
                      output={"every": 1e3})
        small["body_force"] = [0, 0]

        @minamo.system(slot="g2p", reads=["particle.position", "particle.mass"], updates=["particle.velocity"])
        def nothing(x, m, v):
            pass

        # Processor time of this thread, which takes the steps, with and without the system in turns.
        sims = [minamo.Simulation(small, threads=1, systems=systems) for systems in ([], [nothing])]
        best = [np.inf, np.inf]
        for _ in range(20):
            for k, sim in enumerate(sims):
                begin = time.thread_time()
                sim.step(200)
                best[k] = min(best[k], (time.thread_time() - begin) / 200)
        cost = 1e6 * (best[1] - best[0])
        print(f"an empty system of three columns: {cost:.2f} us per step")
        self.assertLess(cost, 20)
        self.assertGreater(cost, 0.1, "it was called")

    def test_a_simulation_lets_go_of_its_systems(self):
        class Held:
            pass

        held = Held()
        gone = weakref.ref(held)

        def function(v, held=held):
            pass

        sim = minamo.Simulation(scene(), threads=1,
                                systems=[minamo.system(slot="g2p", updates=["particle.velocity"])(function)])
        sim.step()
        del sim, function, held
        self.assertIsNone(gone())


if __name__ == "__main__":
    unittest.main()
