"""Runs on several ranks against runs of one process. In the environment: PROGRAM (minamo), MPI_PROGRAM (minamo-mpi),
MPIEXEC, RANDOM_MAP (minamo-mpi whose blocks are anywhere), WORK."""

import csv
import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import time
import unittest
import unittest.mock

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
WORK = pathlib.Path(os.environ["WORK"])
SCENES = ROOT / "scenes"

# More ranks than processors take turns; and containers may forbid a process to read another's memory.
os.environ.update(OMPI_MCA_mpi_yield_when_idle="1", OMPI_MCA_btl_vader_single_copy_mechanism="none")

DAM_BREAK = ["--set", "/grid/cells=[24, 24]", "--set", "/time/end=0.3", "--set", "/output/every=0.1", "--set",
             "/time/step=4e-3", "--set", "/solver={\"tolerance\": 1e-12}"]
SPACE = ["--set", "/grid/cells=[16, 8, 16]", "--set", "/particles/0/per_cell=2", "--set", "/time/end=0.1", "--set",
         "/output/every=0.1", "--set", "/time={\"end\": 0.1, \"step\": 5e-3}", "--set", "/solver={\"tolerance\": 1e-12}"]


def command(ranks, program="MPI_PROGRAM"):
    if ranks == 0:
        return [os.environ["PROGRAM"]]
    as_root = ["--allow-run-as-root"] if os.geteuid() == 0 else []
    return [os.environ["MPIEXEC"], "-n", str(ranks), "--oversubscribe", *as_root, os.environ[program]]


def run(name, ranks, scene, *options, expect=0, program="MPI_PROGRAM"):
    folder = WORK / name
    if "--resume" not in options:
        shutil.rmtree(folder, ignore_errors=True)
    done = subprocess.run([*command(ranks, program), "run", str(scene), "--out", str(folder), "--threads", "1", "--quiet",
                           "--set", '/output/precision="double"', *options], capture_output=True, text=True, timeout=250)
    if expect is not None and done.returncode != expect:
        raise AssertionError(f"{name}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return folder, done


def history(folder):
    with open(folder / "history.csv") as file:
        rows = list(csv.DictReader(file))
    return {key: np.array([float(row[key]) for row in rows if row[key]]) for key in rows[0]}


def last_frame(folder):
    with h5py.File(folder / "fields.h5") as file:
        frames = file["particles"]
        frame = frames[str(len(frames) - 1)]
        order = np.argsort(frame["id"][:])
        return {name: frame[name][:][order] for name in ("id", "position", "velocity", "pressure")}


def vertices(path):
    """Position and velocity of the vertices of a PLY file."""
    head, _, data = path.read_bytes().partition(b"end_header\n")
    vertex = head.decode().partition("element face")[0]
    count = int(vertex.partition("element vertex ")[2].split()[0])
    width = vertex.count("property float")
    return np.frombuffer(data, dtype="<f4", count=count * width).reshape(count, width)


def layout(path):
    """Kind, shape and attributes of everything in a file; of what differs with the order of particles only that."""
    found = {}

    def add(name, item):
        kind = (item.dtype, item.shape, item.chunks) if isinstance(item, h5py.Dataset) else None
        if name in ("fields/frames", "state/history.totals"):
            kind = item.dtype
        found[name] = (kind, dict(item.attrs))

    with h5py.File(path) as file:
        file.visititems(add)
    return found


def stop_one_that_writes(process, folder):
    """Stops the second rank while there is a checkpoint and another one is being written. Returns its process id."""
    unfinished = folder / "checkpoint.h5.unfinished"
    end = time.monotonic() + 60
    while time.monotonic() < end:
        if not (unfinished.exists() and (folder / "checkpoint.h5").exists()):
            continue
        ranks = subprocess.run(["ps", "--ppid", str(process.pid), "-o", "pid="], capture_output=True, text=True)
        rank = int(ranks.stdout.split()[1])
        os.kill(rank, signal.SIGSTOP)
        time.sleep(0.3)
        if unfinished.exists():
            return rank
        os.kill(rank, signal.SIGCONT)
    raise AssertionError("no checkpoint is written")


EXACT = ["--set", '/solver={"tolerance": 1e-12}']


class Alike(unittest.TestCase):
    """The same flow on any number of ranks."""

    def assert_alike(self, folder, alone, within=1e-8):
        ours, theirs = history(folder), history(alone)
        np.testing.assert_array_equal(ours["time"], theirs["time"])
        columns = [name for name in ("kinetic_energy", "potential_energy", "surface_energy") if theirs.get(name, np.empty(0)).size]
        energy = sum(np.abs(theirs[column]).max() for column in columns)
        for column in columns:
            difference = np.abs(ours[column] - theirs[column]).max() / energy
            self.assertLess(difference, within, f"{folder}: {column}")
        for column in ("W", "Q", "Q_volume"):
            if column in theirs:
                self.assertLess(np.abs(ours[column] - theirs[column]).max() / np.abs(theirs[column]).max(), within, column)
        frame, expected = last_frame(folder), last_frame(alone)
        np.testing.assert_array_equal(frame["id"], expected["id"])
        self.assertLess(np.abs(frame["position"] - expected["position"]).max(), 1e-6)
        difference = frame["pressure"] - expected["pressure"]
        self.assertLess(np.abs(difference).max() / np.abs(expected["pressure"]).max(), 1e-4)
        summaries = [json.loads((place / "summary.json").read_text()) for place in (folder, alone)]
        self.assertEqual(summaries[0]["particles"], summaries[1]["particles"])
        self.assertAlmostEqual(summaries[0]["conservation"]["mass"] / summaries[1]["conservation"]["mass"], 1, 12)

    def check(self, name, scene, options, counts, within=1e-8):
        alone, _ = run(f"{name}_alone", 0, scene, *options)
        for ranks in counts:
            with self.subTest(ranks=ranks):
                self.assert_alike(run(f"{name}_{ranks}", ranks, scene, *options)[0], alone, within)

    def test_dam_break(self):
        meters = ["--set", '/gauges=[{"name": "W", "at": [0.2, 0]}]', "--set",
                  '/meters=[{"name": "Q", "plane": {"point": [0.2, 0], "normal": [1, 0]}}]']
        self.check("plane", SCENES / "dam_break.json", [*DAM_BREAK, *meters], [2, 3])

    def test_dam_break_in_space(self):
        self.check("space", SCENES / "dam_break_3d.json", SPACE, [3])

    def test_degree_3_and_flip(self):
        scheme = ["--set", "/discretization={\"scheme\": \"conforming\", \"degree\": 3}", "--set",
                  "/transfer={\"scheme\": \"flip\"}"]
        self.check("flip", SCENES / "dam_break.json", [*DAM_BREAK, *scheme, "--set", "/time/end=0.2"], [3])

    def test_newmark(self):
        options = ["--set", "/integrator={\"scheme\": \"newmark\"}", "--set", "/time={\"end\": 0.1, \"step\": 0.002}"]
        self.check("newmark", SCENES / "dam_break.json", [*DAM_BREAK, *options], [2])

    def test_filters_second_order_and_errors(self):
        exact = ["--set", "/exact={\"velocity\": [\"x\", \"-y\"], \"pressure\": \"1000*9.81*(0.3-y)\", "
                 "\"pressure_mean\": \"free\"}", "--set", "/time/end=0.08"]
        for scheme in ("xpic", "fmpm", "tpic2"):
            options = [*DAM_BREAK, *exact, "--set", f"/transfer={{\"scheme\": \"{scheme}\"}}"]
            self.check(scheme, SCENES / "dam_break.json", options, [3])
            ours, alone = history(WORK / f"{scheme}_3"), history(WORK / f"{scheme}_alone")
            for column in ("error_velocity", "error_pressure"):
                np.testing.assert_allclose(ours[column], alone[column], rtol=1e-7, err_msg=f"{scheme}: {column}")

    def test_a_body_force_that_differs_from_place_to_place(self):
        force = ["--set", "/body_force=[\"2*sin(3*x)\", \"-9.81 + y\"]", "--set", "/time/end=0.1"]
        ours, _ = run("force_3", 3, SCENES / "dam_break.json", *DAM_BREAK, *force)
        alone, _ = run("force_alone", 0, SCENES / "dam_break.json", *DAM_BREAK, *force)
        for column in ("time", "kinetic_energy"):
            np.testing.assert_allclose(history(ours)[column], history(alone)[column], rtol=1e-7, err_msg=column)

    def test_around_a_periodic_axis(self):
        options = ["--set", "/walls={\"x\": \"periodic\", \"y\": \"slip\"}", "--set", "/time/end=0.2"]
        self.check("periodic", SCENES / "dam_break.json", [*DAM_BREAK, *options], [3])

    def test_nothing_reads_further_than_a_rank_knows(self):
        with unittest.mock.patch.dict(os.environ, {"MINAMO_MARK_UNKNOWN": "1"}):
            self.check("marked", SCENES / "dam_break.json", [*DAM_BREAK, "--set", "/time/end=0.1"], [3])
            self.check("marked_space", SCENES / "dam_break_3d.json", [*SPACE, "--set", "/time/end=0.05"], [3])

    def test_thick_liquids(self):
        thick = ["--set", "/fluid/viscosity=100", "--set", "/time/end=0.2"]
        self.check("thick", SCENES / "dam_break.json", [*DAM_BREAK, *thick], [2, 3])
        sticky = [*thick, "--set", '/walls="no_slip"', "--set", "/time/end=0.1"]
        with unittest.mock.patch.dict(os.environ, {"MINAMO_MARK_UNKNOWN": "1"}):
            self.check("sticky", SCENES / "dam_break_3d.json", [*SPACE, *sticky], [3])

    def test_other_liquids(self):
        self.check("bingham", SCENES / "slump.json", [*EXACT, "--set", "/time/end=0.02"], [2])
        self.check("two_liquids", SCENES / "lock_exchange.json", [*EXACT, "--set", "/time/end=0.2"], [3])
        self.check("sponge", SCENES / "dam_break.json",
                   [*DAM_BREAK, "--set", "/time/end=0.1", "--set", '/sponge=[{"where": "x > 0.1", "rate": "20*x"}]'], [2])

    def test_probes_see_the_same(self):
        options = ["--set", "/time={\"end\": 0.1, \"step\": 0.005}", "--set", "/particles/0/per_cell=2", "--set",
                   "/fluid/viscosity=1e-3", "--set", "/solver={\"tolerance\": 1e-12}"]
        self.check("probes", SCENES / "sloshing.json", options, [3])
        ours, alone = history(WORK / "probes_3"), history(WORK / "probes_alone")
        for column in ("left_pressure", "left_velocity_y", "middle_pressure", "middle_velocity_x"):
            np.testing.assert_allclose(ours[column], alone[column], rtol=1e-7, atol=1e-9, err_msg=column)

    def test_a_splash_has_the_same_surface(self):
        options = ["--set", "/grid/cells=[16, 14, 8]", "--set", "/time={\"end\": 0.06, \"step\": 4e-3}", "--set",
                   "/solver={\"tolerance\": 1e-12}"]
        self.check("splash", SCENES / "splash.json", options, [3])
        for frame in ("0000.ply", "0003.ply"):
            ours, alone = (vertices(WORK / name / "surface" / frame) for name in ("splash_3", "splash_alone"))
            # Drops stand in the order of their particles, so that vertices are compared as a whole.
            self.assertEqual(len(ours), len(alone), frame)
            for of in (np.mean, np.std, np.min, np.max):
                np.testing.assert_allclose(of(ours, axis=0), of(alone, axis=0), atol=1e-4, err_msg=frame)

    def test_ode_variables_and_steps_of_the_fastest_particle(self):
        options = ["--set", "/time={\"end\": 0.2, \"cfl\": 0.5}", "--set", "/particles/0/per_cell=2", "--set",
                   "/solver={\"tolerance\": 1e-12}"]
        ours, _ = run("ode_3", 3, SCENES / "elliptical_drop.json", *options)
        alone, _ = run("ode_alone", 0, SCENES / "elliptical_drop.json", *options)
        for column in ("time", "kinetic_energy", "error_velocity"):
            np.testing.assert_allclose(history(ours)[column], history(alone)[column], rtol=1e-7, err_msg=column)

    def test_blocks_are_on_any_rank(self):
        alone, _ = run("anywhere_alone", 0, SCENES / "dam_break.json", *DAM_BREAK)
        for ranks, seed in ((2, 1), (3, 2), (5, 3)):
            with self.subTest(ranks=ranks, seed=seed):
                folder, _ = run(f"anywhere_{ranks}", ranks, SCENES / "dam_break.json", *DAM_BREAK, "--set",
                                f"/random_map={seed}", program="RANDOM_MAP")
                self.assert_alike(folder, alone)

    def test_the_surface_is_told_from_as_far_as_it_is_by_one_process(self):
        """Planes three multipliers away tell of the force on a face: a rank has to know so far. Else positions are
        1e-12 m apart when the front has run a few cells, and grow apart."""
        options = [*EXACT, "--steps", "60"]
        expected = last_frame(run("far_alone", 0, SCENES / "wave_under_lid.json", *options)[0])
        for ranks in (2, 4):
            with self.subTest(ranks=ranks):
                folder, _ = run(f"far_{ranks}", ranks, SCENES / "wave_under_lid.json", *options)
                difference = np.abs(last_frame(folder)["position"] - expected["position"]).max()
                self.assertLess(difference, 1e-13)

    def test_one_process_of_mpi_is_the_ordinary_program(self):
        alone, _ = run("ordinary", 0, SCENES / "dam_break.json", *DAM_BREAK)
        of_mpi, _ = run("of_mpi", 1, SCENES / "dam_break.json", *DAM_BREAK)
        for name in ("history.csv", "fields.h5", "checkpoint.h5"):
            self.assertEqual((alone / name).read_bytes(), (of_mpi / name).read_bytes())


POOLS = {
    "title": "Two pools, and a thin wall between them", "dimension": 2,
    "grid": {"low": [0, 0], "high": [1, 0.5], "cells": [40, 20]}, "fluid": {"density": 1000, "viscosity": 1e-3},
    "body_force": [0.5, -9.81],
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [0.48, 0.3]}}, "per_cell": 2},
                  {"shape": {"box": {"low": [0.52, 0], "high": [1, 0.2]}}, "per_cell": 2}],
    "bodies": [{"name": "wall", "shape": {"polygon": {
        "vertices": [[0.49, -0.1], [0.494, -0.1], [0.604, 0.6], [0.6, 0.6]]}}}],
    "time": {"end": 0.1, "step": 2e-3}, "output": {"every": 0.1}}
ENCLOSED = {
    "title": "Two boxes full of water, side by side", "dimension": 2,
    "grid": {"low": [0, 0], "high": [1, 0.5], "cells": [40, 20]}, "fluid": {"density": 1000, "viscosity": 1e-3},
    "body_force": ["5*y", "-9.81 - 5*x"],
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.5]}}, "per_cell": 2}],
    "bodies": [{"name": "wall", "shape": {"box": {"low": [0.45, -1], "high": [0.53, 1]}}}],
    "time": {"end": 0.1, "step": 5e-3}, "output": {"every": 0.1}}


def pockets():
    """The two boxes with slanting bars across, so that there are closed pockets of few cells."""
    cosine, sine = math.cos(0.1), math.sin(0.1)

    def bar(middle, along, length):
        across = (-along[1], along[0])
        corner = [[middle[d] + i * length * along[d] + j * 0.03 * across[d] for d in range(2)]
                  for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        return {"polygon": {"vertices": corner}}

    bars = [bar((0.5, 0.25 + 0.11 * k), (cosine, sine), 0.8) for k in range(-2, 3)]
    bars += [bar((0.5 + 0.115 * k, 0.25), (-sine, cosine), 0.4) for k in range(-4, 5)]
    return {**ENCLOSED, "bodies": [{"name": "bars", "shape": {"union": bars}}]}


class Scenes(unittest.TestCase):
    """What else a scene may have, on ranks; where nobody knows all, what is not known is marked."""

    def check(self, name, scene, *options, ranks=3, program="MPI_PROGRAM", columns=()):
        if isinstance(scene, dict):
            WORK.mkdir(parents=True, exist_ok=True)
            (WORK / f"{name}.json").write_text(json.dumps(scene))
            scene = WORK / f"{name}.json"
        elif isinstance(scene, str):
            scene = SCENES / f"{scene}.json"
        alone, _ = run(f"{name}_alone", 0, scene, *EXACT, *options)
        more = ["--set", "/random_map=3"] if program == "RANDOM_MAP" else []
        with unittest.mock.patch.dict(os.environ, {"MINAMO_MARK_UNKNOWN": "1"}):
            folder, _ = run(f"{name}_{ranks}", ranks, scene, *EXACT, *options, *more, program=program)
        Alike.assert_alike(self, folder, alone)
        ours, theirs = history(folder), history(alone)
        for column in columns:
            largest = np.abs(theirs[column]).max()
            self.assertGreater(largest, 0, column)
            self.assertLess(np.abs(ours[column] - theirs[column]).max() / largest, 1e-7, column)

    def test_openings(self):
        self.check("jump", "hydraulic_jump", "--steps", "60",
                   columns=("tailwater_rate", "tailwater_mass_in", "tailwater_energy_in", "particles"))
        self.check("channel", "channel_flow", "--steps", "20", program="RANDOM_MAP", columns=("inlet_mass_in",))

    def test_separating_sides(self):
        self.check("separating", "dam_break", *DAM_BREAK, "--set", '/walls="separating"', program="RANDOM_MAP")

    def test_surface_tension(self):
        self.check("drop", "oscillating_drop", "--steps", "20", columns=("surface_energy",))
        self.check("drop_3d", "oscillating_drop_3d", "--steps", "1", ranks=2, columns=("surface_energy",))

    def test_bodies_that_move(self):
        # What is continued at the gate comes from the other end of it.
        self.check("gate", "gate", "--steps", "25", columns=("gate_force_x", "gate_torque", "gate_work"))

    def test_free_bodies(self):
        low = ["--set", '/bodies/0/shape={"box": {"low": [0.7, 0.4], "high": [1.1, 0.6], "angle": 15}}']
        self.check("floating", "floating_box", *low, "--steps", "20", program="RANDOM_MAP",
                   columns=("box_position_y", "box_force_y", "box_torque"))

    def test_friction_on_bodies(self):
        self.check("friction", "cylinder", "--set", "/grid/cells=[110, 20]", "--set",
                   "/grid/high=[2.2, 0.4]", "--set",
                   '/particles/0/shape={"box": {"low": [0, 0], "high": [2.2, 0.4]}}', "--set", "/time/step=0.01", "--steps", "10",
                   columns=("cylinder_force_x", "cylinder_friction_x"))
        self.check("mould", "mould", "--steps", "4", ranks=8)

    def test_contact_lines_on_bodies(self):
        self.check("slope", "drop_on_slope", "--steps", "10", columns=("slope_force_y", "surface_energy"))

    def test_thin_walls(self):
        self.check("pools", POOLS, ranks=4, columns=("wall_force_x",))
        self.check("pools_anywhere", POOLS, program="RANDOM_MAP", columns=("wall_force_x",))

    def test_patches(self):
        patch = json.dumps([{"name": "low", "body": "wall", "within": {"box": {"low": [0.3, -0.1], "high": [0.7, 0.1]}}}])
        self.check("patches", POOLS, "--set", f"/patches={patch}", "--set", "/time/end=0.02",
                   columns=("low_pressure", "low_force_x"))

    def test_liquid_that_is_enclosed_in_several_places(self):
        self.check("enclosed", ENCLOSED, columns=("wall_force_x",))
        self.check("pockets", pockets(), "--steps", "4", columns=("bars_force_x",))

    def test_separating_bodies(self):
        separating = ["--set", '/bodies/0/wall="separating"', "--steps", "30"]
        self.check("separating_gate", "gate", *separating, columns=("gate_force_x",))

    def test_another_number_of_ranks_goes_on_with_openings_and_a_free_body(self):
        scene = json.loads((SCENES / "floating_box.json").read_text())
        scene["openings"] = [{"name": "in", "side": "x_low", "where": "y < 0.1", "inflow": {"velocity": [0.2, 0]}},
                             {"name": "out", "side": "x_high", "where": "y < 0.1", "outflow": {"level": 0.3}}]
        scene["bodies"][0]["shape"]["box"].update(low=[0.7, 0.4], high=[1.1, 0.6])
        scene.pop("$schema")
        path = WORK / "through.json"
        WORK.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(scene))
        alone, _ = run("through_alone", 0, path, *EXACT, "--steps", "24")
        for steps, ranks in ((8, 4), (16, 2), (24, 8)):
            folder, _ = run("through", ranks, path, *EXACT, "--steps", str(steps), *(["--resume"] if steps > 8 else []))
        Alike.assert_alike(self, folder, alone)


class Messages(unittest.TestCase):
    def test_a_step_at_rest_sends_what_it_shares(self):
        still = ["--set", "/particles/0/shape={\"box\": {\"low\": [0, 0], \"high\": [0.584, 0.292]}}"]
        sent = {}
        for steps in (5, 6):
            folder, _ = run(f"still_{steps}", 2, SCENES / "dam_break.json", *still, "--steps", str(steps))
            summary = json.loads((folder / "summary.json").read_text())
            sent[steps] = {row["name"]: row["messages"] for row in summary["systems"]}
            sent[steps]["all"] = summary["ranks"]["messages"]
        step = {name: messages - sent[5][name] for name, messages in sent[6].items()}
        self.assertEqual(step.pop("all"), sum(step.values()))
        solver = step.pop("solve_multipliers_petsc")
        # Volume, divergence and fill of multipliers, mass and velocity of faces, bound of friction and friction, inertia,
        # parts; of exact integrals q, liquid near and w, where they reach, in two parts, distances of the surface three
        # times, normals, and volumes; what particles do not see, three times, and its force; ghost cells, and which sites
        # they touch.
        self.assertEqual(sum(step.values()), 2 * (9 + 10 + 4 + 2))
        # Every iteration of two sources multiplies by the matrix, and sends more on coarser levels.
        self.assertGreater(solver, 2 * 2 * 2)


class Continuations(unittest.TestCase):
    def test_another_number_of_ranks_goes_on(self):
        alone, _ = run("whole", 0, SCENES / "dam_break.json", *DAM_BREAK)
        folder, _ = run("parts", 3, SCENES / "dam_break.json", *DAM_BREAK, "--steps", "30")
        run("parts", 5, SCENES / "dam_break.json", *DAM_BREAK, "--steps", "50", "--resume")
        run("parts", 0, SCENES / "dam_break.json", *DAM_BREAK, "--resume")
        Alike.assert_alike(self, folder, alone)

    def test_a_signal_leaves_a_checkpoint(self):
        folder = WORK / "signal"
        shutil.rmtree(folder, ignore_errors=True)
        process = subprocess.Popen([*command(2), "run", str(SCENES / "dam_break.json"), "--out", str(folder), "--quiet",
                                    *DAM_BREAK, "--set", "/time/end=100"], stderr=subprocess.DEVNULL)
        for _ in range(600):
            time.sleep(0.05)
            if (folder / "history.csv").exists() and (folder / "history.csv").read_text().count("\n") > 5:
                break
        process.send_signal(signal.SIGUSR1)
        process.wait(timeout=60)
        steps = json.loads((folder / "summary.json").read_text())["steps"]
        run("signal", 2, SCENES / "dam_break.json", *DAM_BREAK, "--set", "/time/end=100", "--steps", str(steps + 2),
            "--resume")
        self.assertEqual(len(history(folder)["time"]), steps + 3)


    def test_a_rank_that_is_killed_while_it_writes_leaves_the_checkpoint_before(self):
        options = [*DAM_BREAK, "--set", "/output/checkpoint=1e-3"]
        folder = WORK / "killed"
        shutil.rmtree(folder, ignore_errors=True)
        process = subprocess.Popen([*command(3), "run", str(SCENES / "dam_break.json"), "--out", str(folder), "--quiet",
                                    *options], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        rank = stop_one_that_writes(process, folder)
        before = (folder / "checkpoint.h5").read_bytes()
        os.kill(rank, signal.SIGKILL)
        self.assertNotEqual(process.wait(timeout=60), 0)
        self.assertEqual((folder / "checkpoint.h5").read_bytes(), before)
        run("killed", 2, SCENES / "dam_break.json", *options, "--resume")
        alone, _ = run("not_killed", 0, SCENES / "dam_break.json", *options)
        Alike.assert_alike(self, folder, alone)


class Files(unittest.TestCase):
    """What ranks write side by side is what one process writes."""

    @classmethod
    def setUpClass(cls):
        jitter = ["--set", "/particles/0/arrangement=\"jittered\"", "--set", "/particles/0/seed=7"]
        cls.folders = [run(f"files_{ranks}", ranks, SCENES / "dam_break.json", *DAM_BREAK, *jitter, "--steps", "2")[0]
                       for ranks in (0, 3)]

    def test_the_layout_is_the_same(self):
        for name in ("checkpoint.h5", "fields.h5"):
            alone, ours = [layout(folder / name) for folder in self.folders]
            self.assertEqual(ours, alone)

    def test_ranks_cut_the_same_particles(self):
        for scene in ("elliptical_drop", "drop_3d", "obstacle", "tilted_tank"):
            options = ["--steps", "0"] if scene in ("obstacle", "tilted_tank") else ["--steps", "0", "--set", "/particles/0/per_cell=1"]
            alone = last_frame(run("cut_alone", 0, SCENES / f"{scene}.json", *options)[0])
            shared = last_frame(run("cut_shared", 5, SCENES / f"{scene}.json", *options)[0])
            for name in ("id", "position"):
                np.testing.assert_array_equal(shared[name], alone[name], scene)

    def test_the_first_frame_is_the_same(self):
        frames = []
        for folder in self.folders:
            with h5py.File(folder / "fields.h5") as file:
                frame = file["particles/0"]
                order = np.argsort(frame["id"][:])
                frames.append({name: frame[name][:][order] for name in ("id", "position", "velocity")})
        for name, values in frames[0].items():
            np.testing.assert_array_equal(frames[1][name], values, name)


class Refusals(unittest.TestCase):
    def test_equal_order_is_refused_once(self):
        nodes = ["--set", '/discretization={"scheme": "equal_order"}']
        _, done = run("nodes", 3, SCENES / "dam_break.json", *nodes, expect=None)
        self.assertNotEqual(done.returncode, 0)
        lines = [line for line in done.stderr.splitlines() if "does not run on several ranks" in line]
        self.assertGreater(len(lines), 0)
        said = [line for line in done.stderr.splitlines() if line.startswith("  got")]
        self.assertEqual(len(said), len(set(said)))
        self.assertFalse((WORK / "nodes" / "history.csv").exists())

    def test_umfpack_is_refused_by_name(self):
        umfpack = ["--set", '/solver={"scheme": "umfpack"}']
        _, done = run("umfpack", 2, SCENES / "dam_break.json", *umfpack, expect=None)
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual(done.stderr.count("/solver/scheme: solves all equations in one process"), 1, done.stderr)
        self.assertFalse((WORK / "umfpack" / "history.csv").exists())

    def test_more_ranks_than_blocks_have_nothing_to_do(self):
        options = [*DAM_BREAK, "--set", "/grid/cells=[8, 8]", "--set", "/time/end=0.04"]
        folder, done = run("few_blocks", 5, SCENES / "dam_break.json", *options)
        self.assertEqual(done.stderr.count("ranks have no particles at the start"), 1, done.stderr)
        alone, _ = run("few_blocks_alone", 0, SCENES / "dam_break.json", *options)
        Alike.assert_alike(self, folder, alone)

    def test_what_one_rank_rejects_all_take_back(self):
        options = [*DAM_BREAK, "--set", "/time/step=0.05", "--set", "/time/end=0.3"]
        folder, _ = run("rejected", 3, SCENES / "dam_break.json", *options)
        alone, _ = run("rejected_alone", 0, SCENES / "dam_break.json", *options)
        rejected = [json.loads((place / "summary.json").read_text())["rejected_steps"] for place in (folder, alone)]
        self.assertEqual(rejected[0], rejected[1])
        self.assertGreater(rejected[0], 0)

    def test_the_ordinary_program_is_not_run_several_times(self):
        done = subprocess.run([*command(2)[:-1], os.environ["PROGRAM"], "run", str(SCENES / "dam_break.json"), "--out",
                               str(WORK / "ordinary_twice")], capture_output=True, text=True, timeout=60)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("minamo-mpi", done.stderr)


if __name__ == "__main__":
    WORK.mkdir(parents=True, exist_ok=True)
    unittest.main()
