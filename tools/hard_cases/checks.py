"""What runs must keep, each as a number with a limit, and why the limit is what it is."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from case import Check, Runs
from runs import Frame, Run


def worst(of_run: Callable[[Run], float]) -> Callable[[Runs], float]:
    """Over all runs of a case; a run that left nothing to look at counts as the worst."""

    def measure(runs: Runs) -> float:
        return max(of_run(run) if run.history and run.frames else np.inf for run in runs)

    return measure


def non_finite(run: Run) -> float:
    unknown_at_start = [f"{body['name']}_{what}" for body in run.scene.get("bodies", []) for what in ("force", "torque")]
    unknown_at_start += [f"{opening['name']}_rate" for opening in run.scene.get("openings", [])]
    columns = [values[1:] if name.removesuffix("_" + name[-1]) in unknown_at_start or name in unknown_at_start else values
               for name, values in run.history.items() if name != "potential_energy"]
    fields = [values for frame in run.frames for values in (frame.position, frame.velocity, frame.pressure)]
    return float(sum(np.count_nonzero(~np.isfinite(values)) for values in [*columns, *fields]))


def lost(run: Run) -> float:
    """Particles that are missing, doubled or outside the box in a frame."""
    ids = run.frames[0].id
    most = 0
    for frame in run.frames:
        outside = np.any((frame.position < run.low) | (frame.position > run.high), axis=1)
        same = frame.id.shape == ids.shape and bool(np.all(frame.id == ids))
        most = max(most, int(np.count_nonzero(outside)) + (0 if same else abs(len(ids) - len(frame.id)) or 1))
    return float(most)


def speed(run: Run) -> float:
    """Fastest particle at any time over the speed that the energy at the start could give all of the water."""
    return over(float(np.max(run.history["max_speed"])), run.speed_scale)


def energy_gain(run: Run) -> float:
    """The larger of two shares of the energy at the start: how far the energy of any step is above it, and how far that
    of any output time is above what particles and their velocity gradients had at one before."""
    stored = np.array([energy_of_gradients(run, frame) for frame in run.frames])
    above_start = float(np.max(run.energy)) - float(run.energy[0]) - stored[0]
    of_frame = np.interp([frame.time for frame in run.frames], run.history["time"], run.energy)
    risen = float(np.max(of_frame - np.minimum.accumulate(of_frame + stored)))
    return over(max(above_start, risen, 0.0), float(run.energy[0]))


def balance_rise(run: Run) -> float:
    """How far energy and what bodies have taken of it rise together, over the energy at the start or, where bodies bring
    more, the largest kinetic energy."""
    balance = run.history["energy_balance"]
    rise = float(np.max(balance - np.minimum.accumulate(balance)))
    return over(rise, max(float(run.energy[0]), float(np.max(run.history["kinetic_energy"]))))


def energy_of_gradients(run: Run, frame: Frame) -> float:
    """The most that the velocity gradients of TPIC and APIC can give back, sum_p m_p/2 h^2/4 |grad v_p|^2: D_p of (E30)
    away from walls, where it is largest."""
    if frame.gradient is None:
        return 0.0
    return run.spacing**2 / 8 * float(np.sum(run.masses[frame.id] * np.sum(frame.gradient**2, axis=(1, 2))))


def pressure(run: Run) -> float:
    """Largest pressure over rho (U L/dt + |b| L): what stops a column as long as the box within the shortest step."""
    length = float(np.max(run.high - run.low))
    steps = run.history["dt"][1:]
    dt = float(np.min(steps[steps > 0])) if np.any(steps > 0) else np.inf
    scale = run.scene["fluid"]["density"] * (run.speed_scale * length / dt + float(np.linalg.norm(run.force)) * length)
    nu_scale = run.scene["fluid"]["viscosity"] * run.speed_scale / run.spacing
    return over(max(float(np.max(np.abs(frame.pressure))) for frame in run.frames), scale + nu_scale)


def overlap_gain(run: Run) -> float:
    """Largest volume that is squeezed into full cells, over the volume of the water, above that at the start."""
    if run.scene["volume"]["scheme"] == "none":  # promises nothing
        return 0.0
    return float(np.max(run.history["overlap"]) - run.history["overlap"][0])


def momentum_change(run: Run) -> float:
    """Largest change of the momentum that the body force does not explain, over m U."""
    axes = "xyz"[:len(run.low)]
    momentum = np.array([run.history[f"momentum_{axis}"] for axis in axes]).T
    expected = momentum[0] + run.mass * np.outer(run.history["time"], run.force)
    return over(float(np.max(np.abs(momentum - expected))), run.mass * run.speed_scale)


def flight_error(run: Run) -> float:
    """Largest distance of a particle from x0 + v0 t + g t^2/2, over the length of the box."""
    first = run.frames[0]
    away = max(np.max(np.abs(frame.position - flight(first, run.force, frame.time))) for frame in run.frames)
    return float(away) / float(np.max(run.high - run.low))


def centre_error(run: Run) -> float:
    """The same of the mean of all particles, which have equal masses."""
    first = run.frames[0]
    away = max(np.max(np.abs(np.mean(frame.position - flight(first, run.force, frame.time), axis=0)))
               for frame in run.frames)
    return float(away) / float(np.max(run.high - run.low))


def flight(first: Frame, force: np.ndarray, time: float) -> np.ndarray:
    return first.position + time * first.velocity + time * time / 2 * force


def motion(run: Run) -> float:
    """Fastest particle at any time. [m/s]"""
    return float(np.max(run.history["max_speed"]))


def over(value: float, scale: float) -> float:
    """Zero over zero is zero: a scene without motion that stays so."""
    if value == 0:
        return 0.0
    return value / scale if scale > 0 else np.inf


# A run must keep these in every case.
FINITE = Check("finite", "gave values that are not finite", worst(non_finite), 0, "values", garbage=True)
PARTICLES = Check("particles", "lost particles", worst(lost), 0, "particles", garbage=True)
# A jet can be several times as fast as its source; ten times takes a hundredth of the water and no loss at all.
SPEED = Check("speed", "reached an absurd speed", worst(speed), 10, "times that of all energy as motion", garbage=True)
# What stops the whole length of the box in one step is the most that an incompressible liquid can ask for.
PRESSURE = Check("pressure", "reached an absurd pressure", worst(pressure), 1, "of what stops all water in a step",
                 garbage=True)
ALWAYS = [FINITE, PARTICLES, SPEED, PRESSURE]

# Particles move with order 2 on weights of order 2: energy is kept to a per cent by waves of ten cells; a method that
# is not stable passes any limit.
ENERGY = Check("energy", "gained energy", worst(energy_gain), 0.01, "of the energy at the start", garbage=True)
# The same of energy and the work that the liquid has done on bodies.
BALANCE = Check("balance", "gained energy that no body gave", worst(balance_rise), 0.01, "of the energy", garbage=True)
# Nodes below the mass threshold are ballistic, (E15), which loses 1e-5 of the momentum.
MOMENTUM = Check("momentum", "changed the momentum", worst(momentum_change), 1e-5, "of m U")
# Rounding of 1e-16 of the box in some tens of steps.
FLIGHT = Check("flight", "left the parabola", worst(flight_error), 1e-12, "of the box")
CENTRE = Check("centre", "let the centre of mass leave the parabola", worst(centre_error), 1e-5, "of the box")
# An impact squeezes before the correction, 15 % of the excess per step, can answer; the water that stays squeezed
# is what a volume correction promises to give back.
VOLUME = Check("volume", "squeezed the water", worst(overlap_gain), 0.2, "of the volume")
REST = Check("rest", "moved what rests", worst(motion), 0, "m/s")
