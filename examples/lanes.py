"""Lanes: where a corridor of two cells bends, shortest ways all go round the inner corner; lanes use both cells."""

import sys
from pathlib import Path

import numpy as np
from examples.drawing import bare, labelled, save, side_by_side

import trihex as th
from trihex.pictures.palette import SERIES
from trihex.planners.lanes import make_lanes

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
barriers = np.ones((17, 24), dtype=bool)
for rows, columns in [((1, 3), (1, 17)), ((1, 9), (15, 17)), ((7, 9), (3, 17)), ((7, 15), (3, 5)), ((13, 15), (3, 23))]:
    barriers[slice(*rows), slice(*columns)] = False
area = th.Area("hexagonal", barriers, "corridor")
robots = [(x, y) for y in (1, 2) for x in range(1, 13)]
scenario = th.Scenario(area, [(22, 14)], robots)
plans = {name: th.make_plan(scenario, name) for name in ("greedy", "fcost", "optimal")}
for name, plan in plans.items():
    print(f"{name:8} total time {plan.total_time}; the last of {len(robots)} robots arrives in step {plan.steps}")

ways = make_lanes(th.make_n_scheme(scenario)).ways
xy = [zip(*(axis.tolist() for axis in area.cell_to_xy(np.array(way))), strict=True) for way in ways]
colours = {cell: colour for way, colour in zip(xy, SERIES, strict=False) for cell in way}
pictures = [
    bare(th.picture_of_plan(plans["greedy"], width=340), f"greedy: one file, {plans['greedy'].steps} steps"),
    labelled(area, {(22, 14): "D"}, colours, title=f"{len(ways)} lanes", scale=16.3, size=10.0),
    bare(th.picture_of_plan(plans["fcost"], width=340), f"fcost: both files, {plans['fcost'].steps} steps"),
]
save(folder, {"lanes.svg": side_by_side(pictures, columns=3)})
