"""Prices: seconds for all barriers and chokes of random areas, beside optima made afresh, which are compared.

With ``--maps FOLDER`` also the best next door of MovingAI maps.
"""

import argparse
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

import trihex as th
from benchmarks.measure import machine

SHAPES = (("hexagonal", "full"), ("square", "edge"), ("triangular", "edge"))
# Destination and numbers of robots.
MAPS = {"room-64-64-8": ((33, 31), (500,)), "Berlin_1_256": ((118, 120), (300, 1000, 3000))}


def scenario_of(seed: int, side: int = 32) -> th.Scenario:
    """Return a random area with one or two destinations and 20 to 200 robots."""
    rng = np.random.default_rng(seed)
    tessellation = th.Tessellation(*SHAPES[seed % 3])
    area = th.Area(tessellation, rng.random((side, side)) < rng.uniform(0.1, 0.4))
    free = rng.permutation(np.flatnonzero(~area.barriers))
    goals = int(rng.integers(1, 3))
    robots = free[goals:][: int(rng.integers(20, 201))]
    return th.Scenario(area, free[:goals], robots, destination_capacity=(None, 1, 2)[seed // 3 % 3])


def price_afresh(plan: th.Plan, kind: str, cell: int) -> int:
    """Return what an optimum made afresh saves, or loses, if a cell is another than it is."""
    scenario = plan.scenario
    barriers = scenario.area.barriers.copy()
    barriers.reshape(-1)[cell] ^= True
    changed = replace(scenario, area=th.Area(scenario.area.tessellation, barriers))
    saved = plan.total_time - th.make_plan(changed, "optimal").total_time
    return -saved if kind == "choke" else saved


def compare(seed: int, most: int) -> tuple[float, float, int] | None:
    """Return the seconds of all prices of an area, and of as many optima made afresh, by some that are compared."""
    plan = th.make_plan(scenario_of(seed), "optimal")
    if not plan.arrived.any():
        return None
    begin = time.process_time()
    prices = th.make_prices(plan, kinds=("barrier", "choke"))
    seconds = time.process_time() - begin
    rows = np.flatnonzero(prices.robots == 0)
    rows = np.random.default_rng(seed).permutation(rows)[:most]
    begin = time.process_time()
    for row in rows:
        price = price_afresh(plan, str(prices.kind[row]), int(prices.cell[row]))
        if price != prices.price[row]:
            raise SystemExit(f"area {seed}, cell {prices.cell[row]}: {prices.price[row]}, afresh {price}")
    afresh = (time.process_time() - begin) / max(1, rows.size) * prices.cell.size
    return seconds, afresh, prices.cell.size


def main(options: list[str]) -> None:
    """Print how many times as long optima made afresh take, then a row for each map and number of robots."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks prices", description=__doc__)
    parser.add_argument("--areas", type=int, default=100, help="random areas of 32 x 32 cells")
    parser.add_argument("--most", type=int, default=20, help="cells of each that are compared")
    parser.add_argument("--maps", type=Path, help="folder of the MovingAI maps")
    chosen = parser.parse_args(options)
    print(machine())
    compare(0, 1)  # what is compiled once does not count
    found = np.array([row for row in (compare(seed, chosen.most) for seed in range(chosen.areas)) if row])
    if found.size:
        ratios = found[:, 1] / found[:, 0]
        print(
            f"{len(found)} areas, {int(found[:, 2].sum())} barriers and chokes: {found[:, 0].sum():.2f} s, afresh "
            f"{found[:, 1].sum() / found[:, 0].sum():.1f} times as long; of the areas median {np.median(ratios):.1f}, "
            f"least {ratios.min():.1f}, below 20 {int((ratios < 20).sum())}"
        )
    for name, (goal, counts) in MAPS.items() if chosen.maps else ():
        area = th.read_area(chosen.maps / f"{name}.map", "hexagonal")
        for robots in counts:
            plan = th.make_plan(th.Scenario(area, [goal], th.random_robots(area, robots, 1, avoid=[goal])), "optimal")
            begin = time.process_time()
            prices = th.make_prices(plan, kinds="door")
            seconds = time.process_time() - begin
            print(f"{name:16}{robots:6} best door {prices.best_door} in {seconds:.1f} s", flush=True)
