"""tools/scale: its model against plain loops and known costs, counts of a real run, wrong input. In the environment:
MPI_PROGRAM (minamo-mpi), WORK."""

import json
import os
import subprocess
import sys
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
TOOL = ROOT / "tools/scaling"
WORK = Path(os.environ["WORK"])
sys.path.insert(0, str(TOOL))

from measure import Case, measure  # noqa: E402
from model import Machine, Step, depth, fit, latest_around, on_paper, played  # noqa: E402
from page import SHARES, SIDES, counted, table, terms  # noqa: E402

STILL = Machine(latency=1e-6, bandwidth=1e9, jitter=0, imbalance=1)
STEP = Step(compute=0.1, exchanges=30, exchange_bytes=1e4, collectives=12)


def made_up(series, ranks, particles):
    """Counts of costs that are known: 2 us a particle and 3 ns a byte; 5 us an unknown and 7 us an exchange."""
    unknowns, share = particles / 20, particles / ranks
    bytes_sent = 100 * share ** (2 / 3) * (0 if ranks == 1 else 1) * ranks
    messages = 100 * np.log(unknowns) / np.log(8)
    return {"series": series, "ranks": ranks, "particles": particles, "unknowns": unknowns, "iterations": 9.0,
            "rest": {"compute_s": 2e-6 * share + 3e-9 * bytes_sent, "messages": 12, "bytes": bytes_sent, "collectives": 40},
            "solver": {"compute_s": 5e-6 * unknowns / ranks + 7e-6 * messages, "messages": messages, "bytes": 1e5,
                       "collectives": 60}}


class Model(unittest.TestCase):
    def test_ranks_that_are_alike_take_what_they_take_on_paper(self):
        for side in (2, 5):
            expected = sum(on_paper(STEP, STILL, side ** 3).values())
            self.assertAlmostEqual(played(STEP, STILL, side, np.random.default_rng(1)), expected, delta=1e-12)

    def test_one_rank_waits_for_nobody(self):
        self.assertEqual(played(STEP, Machine(), 1, np.random.default_rng(1)), STEP.compute)

    def test_ranks_that_differ_take_longer(self):
        times = [played(STEP, Machine(1e-6, 1e9, jitter, imbalance), 4, np.random.default_rng(1))
                 for jitter, imbalance in ((0, 1), (0, 1.2), (0.1, 1.2))]
        self.assertEqual(times, sorted(times))
        self.assertGreater(times[1], times[0] + 0.1 * STEP.compute)
        self.assertLess(times[1], times[0] + 0.2 * STEP.compute)

    def test_the_latest_around_is_that_of_a_plain_loop(self):
        times = np.random.default_rng(3).random((4, 4, 4))
        found = latest_around(times.copy())
        for index in np.ndindex(times.shape):
            around = tuple(slice(max(i - 1, 0), i + 2) for i in index)
            self.assertEqual(found[index], times[around].max())

    def test_a_sum_goes_up_and_down_a_tree(self):
        self.assertEqual([depth(ranks) for ranks in (1, 2, 8, 1000)], [0, 2, 6, 20])

    def test_known_costs_are_found_again(self):
        model = fit([made_up("weak", ranks, 30000 * ranks) for ranks in (1, 2, 4, 8)]
                    + [made_up("strong", ranks, 250000) for ranks in (1, 2, 4, 8)]
                    + [made_up("two", 2, particles) for particles in (20000, 50000, 100000, 200000)])
        found = (model.per_particle, model.per_byte, model.per_unknown, model.per_exchange, model.unknowns,
                 model.solver_exchanges(8.0**6), model.solver_collectives(8.0**9), model.iterations(8.0**9))
        np.testing.assert_allclose(found, (2e-6, 3e-9, 5e-6, 7e-6, 0.05, 600, 60, 9), rtol=1e-6)


class Counts(unittest.TestCase):
    def test_of_a_real_run(self):
        row = measure(Path(os.environ["MPI_PROGRAM"]), Case("two", "dam_break_3d", 2, 16))
        self.assertEqual((row["ranks"], row["particles"]), (2, 3456))
        for part in ("rest", "solver"):
            self.assertGreater(row[part]["compute_s"], 0)
            self.assertGreater(row[part]["bytes"], row[part]["messages"])
        self.assertGreater(row["solver"]["messages"], row["iterations"])  # a product with the matrix each, at least
        self.assertGreater(row["rest"]["messages"], 8)


class Wrong(unittest.TestCase):
    def expect(self, words, *arguments):
        done = subprocess.run([sys.executable, "-B", TOOL, *arguments], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertIn(words, done.stderr)

    def test_what_cannot_be(self):
        self.expect("expected a number above 0, got -1", "--check", "--latency", "-1")
        self.expect("there is no ", "--again", "--out", WORK / "nothing", "--check")

    def test_the_page_is_that_of_the_counts(self):
        measured = json.loads((ROOT / "systems/ranks/scaling.json").read_text(encoding="utf8"))
        model = fit(measured)
        page = (ROOT / "systems/ranks/SCALING.md").read_text(encoding="utf8").splitlines()
        small = table(model, Machine(), [(side, share) for side in SIDES[:2] for share in SHARES])
        for line in (*counted(measured), *terms(model), *small):
            self.assertIn(line, page)


if __name__ == "__main__":
    WORK.mkdir(parents=True, exist_ok=True)
    unittest.main()
