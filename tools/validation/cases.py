"""The experiments, and computations of others that stand for one."""

from __future__ import annotations

import math

import figures_of as figure
from case import Case, Curve, Figure
from gauges import front, height, mean_pressure

G = 9.81
BUCHNER_H = LOBOVSKY_H = 0.3  # Buchner's tank is twice as large; lengths and times scale
L = 0.146
WEIGHT = 997 * G * LOBOVSKY_H

LOBOVSKY = ("L. Lobovsky, E. Botia-Vera, F. Castellana, J. Mas-Soler, A. Souto-Iglesias, "
            "J. Fluids Struct. 48 (2014) 407")


def lobovsky_curve(probe: str) -> Curve:
    return Curve(probe, f"{probe}: pressure over rho g H", f"{probe}_pressure", f"lobovsky_2014_{probe.lower()}.csv",
                 "p_over_rho_g_H", scale=1 / WEIGHT, time_column="t_sqrt_2g_over_H",
                 time_scale=math.sqrt(G / LOBOVSKY_H))


ROUGH_FLOOR = {"x": "slip", "y": ["no_slip", "slip"]}


def martin_moyce(inches: float) -> Curve:
    a = 0.0254 * inches
    return Curve("front", f"a = {inches} in: front over a", front(), f"martin_moyce_1952_n2_2_a{inches}in.csv",
                 "front_over_a", scale=1 / a, time_column="t_sqrt_2g_over_a", time_scale=math.sqrt(2 * G / a))


COLUMN = ("A column of water a wide and 2a high, with surface tension. The floor holds the water, which slides along the other "
          "walls. The paper film that held the column opens in a time of its own, and the first points say what the clock was set to, not "
          "when the water started.")
FRONTS = (Figure("front", "front, rms", figure.rms()), Figure("front", "speed of the front, from 2 to 7", figure.slope(2, 7)))

CASES = (
    Case(
        "collapsing_column", "Collapsing column on a dry floor", "J. C. Martin, W. J. Moyce, Phil. Trans. R. Soc. A 244 (1952) 312",
        COLUMN + " Friction decides: along a floor that lets it slip the front is 7 to 8 % ahead on any grid, of a/10 to a/40, "
        "and its speed 9 to 10 % too high. The layer that the floor holds is half a millimetre thick; cells are 2.9 and 1.4 mm.",
        "t (2 g/a)^0.5", (martin_moyce(2.25),), FRONTS, (("a/20", {}), ("a/40", {"/grid/cells": [640, 120]}))),
    Case(
        "collapsing_column_small", "The same, half as wide", "J. C. Martin, W. J. Moyce, Phil. Trans. R. Soc. A 244 (1952) 312",
        COLUMN + " Without surface tension the front would be 7 % ahead with a/40.",
        "t (2 g/a)^0.5", (martin_moyce(1.125),), FRONTS,
        tuple((label, {"/constants/a": 0.028575, "/time/end": 0.36} | cells)
              for label, cells in (("a/20", {}), ("a/40", {"/grid/cells": [640, 120]}))), "collapsing_column"),
    Case(
        "dam_break", "Dam break",
        "S. Koshizuka, Y. Oka, Nucl. Sci. Eng. 123 (1996) 421",
        "The dam break of [the front page](../dam_break.json): a column 0.146 m wide and twice as high; the floor holds the "
        "water. Along one that lets it slip the front is 9 % ahead. The gate that is drawn up takes time, and delays the front.",
        "t (2 g/L)^0.5",
        (Curve("front", "front over L", front(), "koshizuka_oka_1996_front.csv", "front_over_L", scale=1 / L,
               time_column="t_sqrt_2g_over_L", time_scale=math.sqrt(2 * G / L)),),
        (Figure("front", "front, rms", figure.rms()),
         Figure("front", "delay of the gate, fitted", figure.delay(0.5), ""),
         Figure("front", "front but for that delay, rms", figure.rms_but_delay(0.5)),
         Figure("front", "speed of the front, from 1.5", figure.slope(1.5, 3.2))),
        tuple((label, {"/time/end": 0.28, "/walls": ROUGH_FLOOR, "/grid/cells": [cells, cells]})
              for label, cells in (("L/20", 80), ("L/40", 160)))),
    Case(
        "dam_break_pressure", "Pressure of a dam break at the far wall",
        f"B. Buchner, PhD thesis, TU Delft (2002), and {LOBOVSKY}",
        "The same tank in two sizes: water of height H, 2H wide, in a tank 5.366 H long. Buchner's plate is 90 mm across "
        "(ours is the mean of four points), H = 0.6 m; Lobovsky's sensors are 4 mm, at 3, 30 and 80 mm, H = 0.3 m. In 2-D "
        "and without air: where the front has turned over, from 5.5 on, it encloses none. The water reaches no lid. "
        "Our water slips along the walls; therefore P1 and P3 lie above and P4 below what was measured: "
        "[interFoam](../reference/dam_break_pressure_interfoam/README.md) has the same pressures with slip, and the measured ones "
        "with walls that hold the water. The layer that the floor holds comes to rest before the wall, and an eddy fills the corner.",
        "t (g/H)^0.5",
        (Curve("Buchner", "Buchner: pressure over rho g H", mean_pressure("B1", "B2", "B3", "B4"),
               "buchner_2002_pressure.csv", "p_over_rho_g_H", scale=1 / WEIGHT, time_column="t_sqrt_2g_over_H",
               time_scale=math.sqrt(G / BUCHNER_H)),
         lobovsky_curve("P1"), lobovsky_curve("P3"), lobovsky_curve("P4")),
        (Figure("Buchner", "arrival", figure.arrival(0.3)),
         Figure("Buchner", "plateau, mean from 3 to 5", figure.mean(3, 5)),
         Figure("P1", "arrival", figure.arrival(0.5)), Figure("P1", "first peak", figure.peak(2, 3)),
         Figure("P1", "mean from 3 to 5", figure.mean(3, 5)), Figure("P3", "mean from 3 to 5", figure.mean(3, 5)),
         Figure("P4", "mean from 3 to 5", figure.mean(3, 5))),
        (("H/30", {}), ("H/60", {"/grid/cells": [322, 300]})),
        beside=(("interFoam, slip, H/30", "../reference/dam_break_pressure_interfoam/slip_30.csv"),
                ("interFoam, no slip, H/30", "../reference/dam_break_pressure_interfoam/no_slip_30.csv"))),
    Case(
        "dam_break_pressure_3d", "The same in 3-D",
        LOBOVSKY,
        "Lobovsky's tank in its width of 0.15 m, between slip walls. The first peak lasts for 10 ms, as long as a step with H/15. "
        "With H/60 (1 728 000 particles) it is 8 % too high, in a single step; without that step 12 % too low.",
        "t (g/H)^0.5", (lobovsky_curve("P1"), lobovsky_curve("P3"), lobovsky_curve("P4")),
        (Figure("P1", "arrival", figure.arrival(0.5)), Figure("P1", "first peak", figure.peak(2, 3)),
         Figure("P1", "mean from 3 to 5", figure.mean(3, 5)), Figure("P3", "mean from 3 to 5", figure.mean(3, 5)),
         Figure("P4", "mean from 3 to 5", figure.mean(3, 5))),
        (("H/15", {"/grid": {"low": [0, 0, 0], "high": [1.61, "1.61/80*7.0", "1.61/80*30"], "cells": [80, 7, 30]},
                   "/particles/0/shape": {"where": "x < 0.6 && z < 0.3"},
                   "/probes": [{"name": f"P{k}", "at": [1.61, 0.07, z]} for k, z in ((1, 0.003), (3, 0.03), (4, 0.08))]}),
         ("H/30", {}))),
    Case(
        "box_in_the_way", "Dam break with a box in its way",
        "K. M. T. Kleefsman, G. Fekken, A. E. P. Veldman, B. Iwanowski, B. Buchner, J. Comput. Phys. 206 (2005) 363",
        "Water 0.55 m deep falls upon a box of 0.16 x 0.4 x 0.16 m (SPHERIC test 2). Half of the tank is computed, up to "
        "its plane of symmetry; the box and the far wall are bodies that cut the grid. P1 and P3 on the front of the box, "
        "21 and 101 mm above the floor, P5 on its top; H2 and H4 are depths of water in front of the box and where the water was.",
        "t [s]",
        tuple(Curve(probe, f"{probe} [Pa]", f"{probe}_pressure", "spheric2_kleefsman_2005.csv", probe)
              for probe in ("P1", "P3", "P5"))
        + tuple(Curve(name, f"{name} [m]", height(at, 0.08, 0.5), "spheric2_kleefsman_2005.csv", name)
                for name, at in (("H2", 0.992), ("H4", 2.638))),
        (Figure("P1", "arrival", figure.arrival(1000)), Figure("P1", "first peak", figure.peak(0.3, 0.8)),
         Figure("P1", "rms", figure.rms()), Figure("P3", "rms", figure.rms()), Figure("P5", "rms", figure.rms()),
         Figure("H2", "rms", figure.rms()), Figure("H4", "rms", figure.rms())),
        (("h = 40 mm", {}),
         ("h = 20 mm", {"/constants/N": 161, "/grid/high": [3.22, "3.22/N*26", "3.22/N*50"],
                        "/grid/cells": ["N", 26, 50]}))),
    Case(
        "moving_square", "Square that starts to move",
        "SPHERIC benchmark test 6 (A. Colagrossi), computed with finite differences",
        "A square of 1 m in a box of 10 m x 5 m full of liquid, brought to 1 m/s in half a second; Reynolds number 100. "
        "Drag coefficients of pressure and friction. Steps are short, a CFL number of 0.2. The benchmark's friction differs from "
        "ours and, alike, from that of [pimpleFoam](../reference/moving_square_pimplefoam/README.md), where the grid moves with the "
        "square and no cell is cut: from pimpleFoam's finer one ours is 1.7 % off (rms, 1/40), the benchmark's 9 %.",
        "t [s]",
        (Curve("pressure", "pressure: drag coefficient", "square_force_x", "spheric6_drag_Re100.csv", "Cd_pressure",
               scale=-2),
         Curve("friction", "friction: drag coefficient", "square_friction_x", "spheric6_drag_Re100.csv", "Cd_viscous",
               scale=-2)),
        (Figure("pressure", "rms", figure.rms()), Figure("pressure", "mean from 2 to 8", figure.mean(2, 8)),
         Figure("friction", "rms", figure.rms()), Figure("friction", "mean from 2 to 8", figure.mean(2, 8))),
        (("1/20", {}), ("1/40", {"/grid/cells": [400, 200]})),
        beside=(("pimpleFoam, 1/20", "../reference/moving_square_pimplefoam/square_20.csv"),
                ("pimpleFoam, 1/40", "../reference/moving_square_pimplefoam/square_40.csv"))),
    Case(
        "swayed_tank", "Swayed tank",
        "O. M. Faltinsen, O. F. Rognebakke, I. A. Lukovsky, A. N. Timokha, J. Fluid Mech. 407 (2000) 201",
        "Water 0.6 m deep in a tank of 1.73 m that sways by 0.032 m with a period of 1.3 s; the surface 0.05 m from a wall. "
        "By linear theory the measured curve is that of a tank that starts at the end of its way, with the acceleration's "
        "cosine, and so does ours. Linear theory of that start has crests 6 % too high. Walls that hold the "
        "water take 4 % off ours; 3 mm less way would take 15 % off. [interFoam](../reference/swayed_tank_interfoam/README.md) with the "
        "same motion has the same curve as we, with crests still higher: what is known of the motion does not make the measured ones.",
        "t [s]",
        (Curve("height", "surface above its level [m]", height(0.05, 0.1), "faltinsen_2000_wave_height.csv", "value",
               offset=-0.6),),
        (Figure("height", "crests", figure.crests(0, 10, 0.02)), Figure("height", "rms", figure.rms())),
        (("H/28", {}), ("H/55", {"/grid/cells": [162, 100]})),
        beside=(("interFoam, H/28", "../reference/swayed_tank_interfoam/slip_28.csv"),)),
    Case(
        "pitched_tank", "Pitched tank",
        "H. Akyildiz, N. E. Unal, Ocean Eng. 33 (2006) 2135",
        "Water 0.465 m deep in a tank of 0.92 x 0.62 m that pitches by 4 degrees with 2 rad/s about the middle of its floor, "
        "far below the first natural frequency, 5.6 rad/s. P2 is 0.17 m above the floor at one end, P8 0.45 m at the other, where "
        "the wall falls dry. Seen from the tank, without Coriolis's force: in 2-D that is a pressure of 1 mm of water. "
        "Measured curves are periodic from their first point; ours are those after two periods, in which the motion grows. "
        "P8 reads 0.245 kPa at a dry wall: that is added to ours at both gauges. Without it P2's mean is 10 % too low.",
        "t [s]",
        tuple(Curve(probe, f"{probe} [kPa]", f"{probe}_pressure", f"akyildiz_2006_pitch_{name}.csv", "value", scale=1e-3,
                    offset=245, begin=2 * math.pi) for probe, name in (("P2", "probe2"), ("P8", "probe8"))),
        (Figure("P2", "swing", figure.swing(0, 9.8)), Figure("P2", "mean", figure.mean(0, 9.8)),
         Figure("P2", "rms", figure.rms()), Figure("P8", "swing", figure.swing(0, 9.8)),
         Figure("P8", "rms", figure.rms())),
        (("H/23", {}), ("H/46", {"/grid/cells": [92, 62]}))),
)
