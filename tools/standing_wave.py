#!/usr/bin/python3
"""Frequency and damping of the first standing wave of a tank, compared with those of theory.

  tools/run scenes/sloshing.json --set /time/end=11.82
  tools/standing_wave.py out/sloshing

Fits exp(-a t) (A cos(w t) + B sin(w t)) to the momentum along x by least squares. To leading order in the viscosity the
damping is that of a potential flow, a = 2 nu k^2, and the frequency that of an inviscid liquid. With the layer below the
surface, where the shear stress of that flow is undone, exp(n t) has, s = tanh(k H), m^2 = k^2 + n/nu,

  (n + 2 nu k^2)^2 + g k s = 4 nu^2 k^3 m coth(m H) s

(H. Lamb, Hydrodynamics (1932), section 349, for a deep liquid): 2.8 % less damping in scenes/sloshing.json.
For tanks in 2-D between slip walls, with a depth "depth" among the constants of the scene.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.dont_write_bytecode = True

try:
    import numpy as np

    from reporting.closed_pipes import readers_may_go
    from reporting.runs import NoResults, Run
except ModuleNotFoundError as missing:
    sys.exit(f"tools/standing_wave.py needs the python module {missing.name}. Type this line, then call it again:\n"
             "  sudo apt-get install --yes --no-install-recommends python3-h5py python3-matplotlib")


def theories(run: Run) -> dict[str, complex]:
    """n of exp(n t) by theory. [1/s]"""
    low, high = run.box
    depth = run.scene.get("constants", {}).get("depth")
    gravity = -np.array(run.scene.get("body_force", [0, 0]), float)
    if run.dimension != 2 or run.scene.get("walls") != "slip" or depth is None or gravity[0] != 0 or gravity[1] <= 0:
        raise NoResults(f"{run.folder}/scene.json: not a standing wave; expected: the plane, /walls slip, /constants/depth "
                        "and a /body_force along -y, as in scenes/sloshing.json")
    k = np.pi / (high[0] - low[0])
    nu = run.scene["fluid"]["viscosity"] / run.scene["fluid"]["density"]
    shallow = np.tanh(k * depth)
    leading = complex(-2 * nu * k**2, np.sqrt(gravity[1] * k * shallow))
    found = {"leading order": leading}
    if nu > 0:
        found["viscous"] = viscous(leading, k, nu, depth, gravity[1] * k * shallow)
    return found


def viscous(leading: complex, k: float, nu: float, depth: float, stiffness: float) -> complex:
    """The root n next to that of leading order, by Newton's method. [1/s]"""
    def residual(n: complex) -> complex:
        m = np.sqrt(k**2 + n / nu)
        return (n + 2 * nu * k**2) ** 2 + stiffness - 4 * nu**2 * k**3 * np.tanh(k * depth) * m / np.tanh(m * depth)

    n, step = leading, 1e-6 * abs(leading)
    for _ in range(20):
        n -= residual(n) * 2 * step / (residual(n + step) - residual(n - step))
    return n


def fit(run: Run, start: complex) -> tuple[complex, float]:
    """n of the wave by Gauss and Newton, and the share of the momentum that the fit leaves. [1/s]"""
    time, momentum = run.series("time"), run.series("momentum_x")
    if time is None or momentum is None or time[-1] - time[0] < 4 * np.pi / start.imag:
        raise NoResults(f"{run.folder}/history.csv: too short; expected: two periods, {4 * np.pi / start.imag:.2f} s, "
                        "or more")
    n = start
    for _ in range(50):
        wave = np.exp(n * time)
        shapes = np.stack([wave.real, wave.imag], 1)
        (a, b), *_ = np.linalg.lstsq(shapes, momentum, rcond=None)
        left = momentum - shapes @ [a, b]
        slope = time * (a - 1j * b) * wave  # of Re((a - i b) exp(n t)) along Re n; -Im of it along Im n
        jacobian = np.column_stack([shapes, slope.real, -slope.imag])
        step = np.linalg.lstsq(jacobian, left, rcond=None)[0]
        n += complex(step[2], step[3])
        if abs(complex(step[2], step[3])) < 1e-12 * abs(n):
            break
    return n, float(np.std(left) / np.std(momentum))


def line(name: str, n: complex, found: dict[str, complex]) -> str:
    """Frequency and damping, and by how much they exceed those of each theory."""
    parts = [f"{name} {n.imag:10.6f}", *(f"{100 * (n.imag / t.imag - 1):+8.3f} %" for t in found.values())]
    parts += [f"{-n.real:12.6f}", *(f"{100 * (n.real / t.real - 1):+8.2f} %" if t.real else f"{'-':>10}"
                                    for t in found.values())]
    return " ".join(parts)


def main() -> None:
    parser = argparse.ArgumentParser(prog="tools/standing_wave.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", metavar="DIR", help="what `minamo run --out DIR` wrote")
    for run in [Run(folder) for folder in parser.parse_args().folders]:
        found = theories(run)
        n, left = fit(run, found["leading order"])
        width = max(len(name) for name in [run.name, *found])
        over = " ".join(f"{name:>10}" for name in ("- leading", "- viscous")[:len(found)])
        print(f"{'':{width}} {'w [1/s]':>10} {over} {'a [1/s]':>12} {over}")
        for name, theory in found.items():
            print(line(f"{name:{width}}", theory, found))
        print(line(f"{run.name:{width}}", n, found), f"  the fit leaves {100 * left:.1f} % of the momentum")


if __name__ == "__main__":
    try:
        with readers_may_go():
            main()
    except NoResults as problem:
        print(problem, file=sys.stderr)
        sys.exit(2)
