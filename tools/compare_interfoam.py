#!/usr/bin/python3
"""How far the water of a dam break is from that of OpenFOAM's interFoam, or of another run.

  tools/compare_interfoam.py out/dam_break out/dam_break_pic
  tools/compare_interfoam.py --from out/dam_break out/tilted_dam_break
  tools/compare_interfoam.py --mean 0.6 out/dam_break

Prints the area that is water in one of the two and not in the other, over the area of the column at the start. Water is
where the volume fraction exceeds 1/2, on a raster of 0.5 mm. That of interFoam (160 x 160 cells) is interpolated between
the middles of cells. That of a run is sum_p V_p N((x - x_p)/h) N((y - y_p)/h) / h^2, N the quadratic B-spline,
mirrored at the walls, h = 14.6 mm whatever the grid of the run, so that runs can be compared.
With --mean the mean over all times of the reference up to that one, a single number, as studies want it.
For scenes with the tank and the column of scenes/dam_break.json; the tank may be a body, turned by an angle, that the
grid is cut by. A run of scenes/obstacle.json is compared with interFoam over the same obstacle.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

sys.dont_write_bytecode = True

try:
    import h5py
    import numpy as np

    from reporting.closed_pipes import readers_may_go
    from reporting.overlays import fits
    from reporting.runs import NoResults, Run
except ModuleNotFoundError as missing:
    sys.exit(f"tools/compare_interfoam.py needs the python module {missing.name}. Type this line, then call it again:\n"
             "  sudo apt-get install --yes --no-install-recommends python3-h5py python3-matplotlib")

REFERENCES = Path(__file__).resolve().parent.parent / "scenes/reference"
TANK = 0.584  # side [m]
COLUMN = 0.146 * 0.292  # area of the water at the start [m^2]
WIDTH = TANK / 40  # of the B-spline [m]
PIXEL = 0.5e-3  # [m]
CENTRES = (np.arange(round(TANK / PIXEL)) + 0.5) * PIXEL  # of pixels, along either side [m]
TOLERANCE = 2e-3  # between an output time and one of the reference [s]


def b_spline(distance: np.ndarray) -> np.ndarray:
    """Quadratic B-spline of unit width."""
    r = np.abs(distance)
    return np.where(r < 0.5, 0.75 - r * r, np.where(r < 1.5, 0.5 * (1.5 - r) ** 2, 0.0))


def spread(place: np.ndarray) -> np.ndarray:
    """Weights of particles, and of their mirror images in two walls, at pixels: particles x pixels."""
    images = (place, -place, 2 * TANK - place)
    return sum(b_spline((CENTRES - image[:, None]) / WIDTH) for image in images)


def open_share(run: Run) -> np.ndarray:
    """Share of the B-spline at pixels [y, x] that fixed boxes along the grid leave open; 0 inside of them."""
    share = np.ones((len(CENTRES), len(CENTRES)))
    for body in run.scene.get("bodies", []):
        box = body["shape"].get("box")
        if not box or box.get("angle") or "motion" in body:
            continue
        inside = [(CENTRES > low) & (CENTRES < high) for low, high in zip(box["low"], box["high"])]
        x, y = (spread(CENTRES[within]).sum(axis=0) * PIXEL / WIDTH for within in inside)
        share -= np.outer(y, x)
        share[np.ix_(inside[1], inside[0])] = 0
    return share


def water_of_particles(position: np.ndarray, share: np.ndarray, open_part: np.ndarray) -> np.ndarray:
    """Pixels [y, x] that are water, from the places of particles and their shares of the area of the column."""
    fraction = np.zeros((len(CENTRES), len(CENTRES)))
    for part in np.array_split(np.arange(len(position)), -(-len(position) // 1000)):
        x, y = position[part].T
        fraction += (spread(y) * share[part, None]).T @ spread(x)
    return (open_part > 0) & (fraction * COLUMN / WIDTH**2 > 0.5 * open_part)


def shares(run: Run, count: int) -> np.ndarray:
    """Of particles of the water, in the order of their ids. All the same where no checkpoint has their masses."""
    path = run.folder / "checkpoint.h5"
    if not path.is_file():
        return np.full(count, 1 / count)
    with h5py.File(path, "r") as file:
        order = np.argsort(np.frombuffer(file["state/particle.id"][:].tobytes(), dtype=np.int64))
        mass = file["state/particle.mass"][:][order]
    return mass / mass.sum()


def between(middles: np.ndarray) -> np.ndarray:
    """Weights of the middles of cells at pixels, linear between them and constant next to the walls: pixels x cells."""
    cells = len(middles)
    place = np.interp(CENTRES, middles, np.arange(cells))
    low = np.minimum(place.astype(int), cells - 2)
    weights = np.zeros((len(CENTRES), cells))
    rows = np.arange(len(CENTRES))
    weights[rows, low] = 1 - (place - low)
    weights[rows, low + 1] = place - low
    return weights


def reference_of(run: Run) -> Path:
    """The folder with interFoam's water: over the obstacle if the scene is that one, else without."""
    obstacle = REFERENCES / "obstacle_interfoam"
    is_that_one = fits(json.loads((obstacle / "fits.json").read_text()), run.scene)
    return obstacle if is_that_one else REFERENCES / "dam_break_interfoam"


def reference(folder: Path, open_part: np.ndarray) -> dict[float, np.ndarray]:
    """Pixels [y, x] that are water of interFoam, by time [s]; a file without places of cells has squares."""
    with np.load(folder / "alpha_160.npz") as file:
        frames = list(zip(file["time"], file["alpha"]))
        y, x = (between(file[axis] if axis in file else (np.arange(count) + 0.5) * TANK / count)
                for axis, count in zip("yx", frames[0][1].shape))
    return {round(float(time), 6): (y @ (alpha / 255.0) @ x.T > 0.5) & (open_part > 0) for time, alpha in frames}


@dataclass(frozen=True)
class Tank:
    """Where the tank of a run is."""

    middle: np.ndarray  # [m]
    angle: float  # by which it is turned, counter-clockwise [rad]

    def inside(self, position: np.ndarray) -> np.ndarray:
        """Places seen from the lower left corner of the tank, along its walls: particles x 2."""
        cosine, sine = np.cos(self.angle), np.sin(self.angle)
        return (position - self.middle) @ np.array([[cosine, -sine], [sine, cosine]]) + 0.5 * TANK


def tank_of(run: Run) -> Tank:
    """The sides of the grid, or a body that is all but a box."""
    low, high = run.box
    boxes = [body["shape"].get("invert", {}).get("box") for body in run.scene.get("bodies", [])]
    low, high, angle = next(((np.array(box["low"]), np.array(box["high"]), np.radians(box.get("angle", 0)))
                             for box in boxes if box), (low, high, 0.0))
    if run.dimension != 2 or not np.allclose(high - low, TANK):
        raise NoResults(f"{run.folder}: not the tank of the reference; expected: a grid, or the inverted box of a body, "
                        f"of {TANK} m x {TANK} m, got: from {low} to {high}")
    return Tank(0.5 * (low + high), angle)


def water_of_run(run: Run, times: Iterable[float]) -> dict[float, np.ndarray]:
    """Water of a run by time [s], at those of the times that it has written."""
    tank = tank_of(run)
    open_part = open_share(run)
    frames = {time: run.frame_at(time, TOLERANCE) for time in times}
    return {time: water_of_particles(tank.inside(frame.position), shares(run, len(frame.position)), open_part)
            for time, frame in frames.items() if frame}


def distances(run: Run, reference_water: dict[float, np.ndarray]) -> dict[float, float]:
    """Area of the symmetric difference over that of the column, at the times that the run has written."""
    return {time: float(np.count_nonzero(water != reference_water[time])) * PIXEL**2 / COLUMN
            for time, water in water_of_run(run, reference_water).items()}


def mean_distance(run: Run, water: dict[float, np.ndarray]) -> float:
    """Mean of distances() over all of these times."""
    found = distances(run, water)
    missing = ", ".join(f"{time:g}" for time in water if time not in found)
    if missing:
        raise NoResults(f"{run.folder}: frames are missing at t = {missing} s; expected: a frame every 0.1 s, or 0.05 s")
    return sum(found.values()) / len(found)


def main() -> None:
    parser = argparse.ArgumentParser(prog="tools/compare_interfoam.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", metavar="DIR", help="what `minamo run --out DIR` wrote")
    parser.add_argument("--mean", type=float, metavar="UNTIL", help="print the mean up to this time [s], a line per DIR")
    parser.add_argument("--from", dest="other", metavar="DIR", help="another run, to compare with in place of interFoam")
    options = parser.parse_args()
    runs = [Run(folder) for folder in options.folders]
    for run in runs:
        run.require_whole()
    folder, *others = {reference_of(run) for run in runs}
    if others:
        raise NoResults("runs with the obstacle and without are not compared with one reference; name them apart")
    water = reference(folder, open_share(runs[0]))
    if options.other:
        water = water_of_run(Run(options.other), water)
    if options.mean is not None:
        for run in runs:
            print(mean_distance(run, {time: w for time, w in water.items() if time < options.mean + TOLERANCE}))
        return
    width = max(5, *(len(run.name) for run in runs))
    print(f"{'t [s]':{width}}", *(f"{time:6g}" for time in water))
    for run in runs:
        found = distances(run, water)
        print(f"{run.name:{width}}", *(f"{found[time]:6.3f}" if time in found else "     -" for time in water))


if __name__ == "__main__":
    try:
        with readers_may_go():
            main()
    except NoResults as problem:
        print(problem, file=sys.stderr)
        sys.exit(2)
