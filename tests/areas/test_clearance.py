"""Clearance: the table of least distances against all pairs of moves, drawn on paper."""

from itertools import product
from math import ceil, hypot
from pathlib import Path

import numpy as np
import pytest

import trihex as th
from trihex.areas import NEIGHBOURHOODS, TESSELLATIONS, Tessellation
from trihex.areas.clearance import least_cell_size, least_distance

KINDS = list(product(TESSELLATIONS, NEIGHBOURHOODS))


def drawn_moves(tessellation, cell):
    """Yield (target, vertex passed or None) for each move of `cell`, found by the corners that polygons share."""
    own = {tuple(corner) for corner in np.round(tessellation.polygon_of_cell(*cell), 6)}
    for dx, dy in product(range(-3, 4), range(-2, 3)):
        if (dx, dy) == (0, 0):
            continue
        target = (cell[0] + dx, cell[1] + dy)
        shared = own & {tuple(corner) for corner in np.round(tessellation.polygon_of_cell(*target), 6)}
        if len(shared) == 2:
            yield target, None
        elif len(shared) == 1 and tessellation.neighbourhood == "full":
            yield target, shared.pop()


def nearest(from_a, to_a, from_b, to_b):
    """Return the least distance of two points that move in straight lines in the same time."""
    px, py = from_b[0] - from_a[0], from_b[1] - from_a[1]
    vx, vy = to_b[0] - to_a[0] - px, to_b[1] - to_a[1] - py
    speed = vx * vx + vy * vy
    time = 0.0 if speed == 0 else min(1.0, max(0.0, -(px * vx + py * vy) / speed))
    return hypot(px + time * vx, py + time * vy)


def least_of_all_pairs(tessellation, crossing):
    """Try every move and wait of a robot in a cell of either orientation with every one of another robot nearby."""
    around = {}

    def actions(cell):
        if cell not in around:
            around[cell] = [(cell, None), *drawn_moves(tessellation, cell)]
        return around[cell]

    centre = {}

    def at(cell):
        if cell not in centre:
            centre[cell] = tuple(float(number) for number in tessellation.centre_of_cell(*cell))
        return centre[cell]

    least = float("inf")
    for a in [(20, 20), (21, 20)]:
        # Beyond five columns or four rows two robots are at least one edge step apart throughout: each moves at most 2.
        for dx, dy in product(range(-5, 6), range(-4, 5)):
            b = (a[0] + dx, a[1] + dy)
            if a == b:
                continue
            for (to_a, vertex_a), (to_b, vertex_b) in product(actions(a), actions(b)):
                if to_a == to_b or (to_a == b and to_b == a):
                    continue
                if crossing == "forbid" and vertex_a is not None and vertex_a == vertex_b:
                    continue
                least = min(least, nearest(at(a), at(to_a), at(b), at(to_b)))
    return least


@pytest.mark.parametrize(("name", "neighbourhood"), KINDS)
@pytest.mark.parametrize("crossing", ["forbid", "allow"])
def test_the_least_distance_is_that_of_all_pairs_of_moves(name, neighbourhood, crossing):
    tessellation = Tessellation(name, neighbourhood)
    assert least_distance(tessellation, crossing) == pytest.approx(least_of_all_pairs(tessellation, crossing), abs=1e-6)


def test_following_round_a_turn_brings_robots_to_the_cosine_of_half_the_turn():
    follower, leader = ((0, 0), (1, 0)), ((1, 0), (1 + np.cos(2 * np.pi / 3), np.sin(2 * np.pi / 3)))
    assert nearest(*follower, *leader) == pytest.approx(np.cos(np.pi / 3)) == least_distance(Tessellation("hexagonal"))


@pytest.mark.parametrize(("name", "neighbourhood"), KINDS)
def test_the_least_cell_size_is_accepted_and_one_below_it_refused_with_the_least(name, neighbourhood):
    tessellation = Tessellation(name, neighbourhood)
    least = least_cell_size(tessellation, 0.15)
    said = f"{ceil(least * 1e4 - 1e-6) / 1e4:.10g}"
    for size in (least, float(said)):
        area = th.Area(tessellation, [[0, 0]], frame=th.Frame(size, robot_radius=0.15))
        assert th.Scenario(area, [(0, 0)], [(1, 0)]).destination_capacity == 1
    area = th.Area(tessellation, [[0, 0]], frame=th.Frame(least * 0.999, robot_radius=0.15))
    with pytest.raises(
        th.AreaError, match=rf"cell_size must be at least {said} metres \(.*\) on {name} cells"
    ) as caught:
        th.Scenario(area, [(0, 0)], following="allow")
    radius = float(str(caught.value).rsplit(" ", 1)[1])
    th.Scenario(th.Area(tessellation, [[0]], frame=th.Frame(least * 0.999, robot_radius=radius)), [(0, 0)])


def test_rules_that_let_robots_meet_are_refused_where_they_have_a_radius():
    area = th.Area("square", [[0, 0]], frame=th.Frame(1.0, robot_radius=0.1))
    with pytest.raises(th.ScenarioError, match=r"crossing must be 'forbid' for robots of radius 0.1, not 'allow'"):
        th.Scenario(area, [(0, 0)], crossing="allow")
    with pytest.raises(th.ScenarioError, match=r"destination_capacity must be 1 for robots of radius 0.1, not 2"):
        th.Scenario(area, [(0, 0)], destination_capacity=2)
    points = th.Area("square", [[0, 0]], frame=th.Frame(1.0))
    assert th.Scenario(points, [(0, 0)], crossing="allow", destination_capacity=2).destination_capacity == 2
    hexagons = th.Area("hexagonal", [[0, 0]], frame=th.Frame(1.0, robot_radius=0.1))
    assert th.Scenario(hexagons, [(0, 0)], crossing="allow").crossing == "allow"  # no move passes a vertex


def test_the_table_in_the_docs_is_right():
    text = (Path(__file__).parents[2] / "docs" / "metric.md").read_text()
    rows = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in text.splitlines()
        if "| sqrt(" in line or "| 1/2 =" in line
    ]
    names = {
        "3": ("triangular", "edge"),
        "12": ("triangular", "full"),
        "4": ("square", "edge"),
        "8": ("square", "full"),
    }
    seen = set()
    for cells, _, formula, size, radius in rows[-5:]:
        kind = ("hexagonal", "full") if cells == "hexagonal" else names[cells.split()[1]]
        tessellation = Tessellation(*kind)
        assert kind[0] in cells
        assert float(formula.split("= ")[1]) == pytest.approx(least_distance(tessellation), abs=5e-5)
        assert float(size) == ceil(least_cell_size(tessellation, 0.15) * 1e4 - 1e-6) / 1e4
        assert float(radius) == int(least_distance(tessellation) * 0.25 * 1e4 + 1e-6) / 1e4
        seen.add(kind)
    assert len(seen) == 5
