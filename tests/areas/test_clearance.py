"""Clearance: the table of least distances against all pairs of moves, drawn on paper."""

from fractions import Fraction
from functools import cache
from itertools import product
from math import ceil, hypot, sqrt
from pathlib import Path

import numpy as np
import pytest
import shapely

import trihex as th
from tests.oracles.owners import TICKS
from tests.sweeps import swept
from trihex.areas import CLOCKS, COSTS, CROSSINGS, FOLLOWINGS, NEIGHBOURHOODS, TESSELLATIONS, Tessellation
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


class Pairs:
    """All moves and waits of a robot in a cell of either orientation beside all of another robot nearby, as columns."""

    def __init__(self, tessellation, crossing="forbid"):
        rows, actions = [], {}
        for a in [(20, 20), (21, 20)]:
            # Beyond five columns or four rows two robots are at least one edge step apart: each moves at most 2.
            for dx, dy in product(range(-5, 6), range(-4, 5)):
                b = (a[0] + dx, a[1] + dy)
                for cell in {a, b} - actions.keys():
                    actions[cell] = [(cell, cell, None), *((cell, *move) for move in drawn_moves(tessellation, cell))]
                rows += [(*one, *other) for one, other in product(actions[a], actions[b])]
        cells = np.array([(a, to_a, b, to_b) for a, to_a, _, b, to_b, _ in rows])
        number = cells @ (1000, 1)
        self.cells, (self.a, self.to_a, self.b, self.to_b) = cells, number.T
        self.point = np.stack(tessellation.centre_of_cell(cells[..., 0], cells[..., 1]), axis=-1)
        # Moves past one vertex, and those to and fro between two cells, may not overlap in time.
        same_vertex = np.array([one is not None and one == other for _, _, one, _, _, other in rows])
        exchanges = (self.a == self.to_b) & (self.b == self.to_a) & (self.a != self.to_a)
        self.excludes = exchanges | (same_vertex if crossing == "forbid" else False)

    def duration(self, tessellation):
        """Return how many ticks the actions of both robots last."""
        lengths = np.hypot(*np.moveaxis(self.point[:, [1, 3]] - self.point[:, [0, 2]], -1, 0)).T
        ticks = np.ones_like(lengths)
        if tessellation.clock == "costs" and tessellation.name != "hexagonal" and tessellation.neighbourhood == "full":
            for length, duration in TICKS[tessellation.name, tessellation.costs].items():
                ticks[np.abs(lengths - length) < 0.01] = duration
        return ticks

    def are_legal(self, duration_a, duration_b, delay, following):
        """Tell which pairs overlap in time and own nothing together, if the second begins `delay` after the first."""
        if following == "allow":
            owned_a = [(self.a, 0, duration_a / 2), (self.to_a, duration_a / 2, duration_a)]
            owned_b = [(self.b, 0, duration_b / 2), (self.to_b, duration_b / 2, duration_b)]
        else:
            owned_a = [(cell, 0, duration_a) for cell in (self.a, self.to_a)]
            owned_b = [(cell, 0, duration_b) for cell in (self.b, self.to_b)]
        are_legal = (delay < duration_a) & (-delay < duration_b) & ~self.excludes
        for (one, begin, end), (other, start, stop) in product(owned_a, owned_b):
            are_legal &= (one != other) | (end <= delay + start) | (delay + stop <= begin)
        return are_legal

    def nearest(self, duration_a, duration_b, delay):
        """Return how near both come while both act."""
        begin, end = np.maximum(0, delay), np.minimum(duration_a, delay + duration_b)
        a, to_a, b, to_b = np.moveaxis(self.point, 1, 0)

        def gap(time):
            there = b + (to_b - b) * ((time - delay) / duration_b)[:, None]
            return there - a - (to_a - a) * (time / duration_a)[:, None]

        gaps, change = gap(begin), gap(end) - gap(begin)
        speed = (change**2).sum(axis=1)
        moment = np.clip(-(gaps * change).sum(axis=1) / np.where(speed == 0, 1, speed), 0, 1)
        return np.hypot(*(gaps + moment[:, None] * change).T)

    def nearest_legal(self, tessellation, following):
        """Return the least distance of all legal pairs and delays in ticks, and where: index of the pair, delay."""
        duration_a, duration_b = self.duration(tessellation)
        least, where = np.inf, None
        for delay in range(1 - int(duration_b.max()), int(duration_a.max())):
            legal = np.flatnonzero(self.are_legal(duration_a, duration_b, delay, following))
            apart = self.nearest(duration_a, duration_b, np.float64(delay))[legal]
            if legal.size and apart.min() < least - 1e-9:
                least, where = float(apart.min()), (int(legal[apart.argmin()]), delay)
        return least, where


@cache
def pairs_of(name, neighbourhood, crossing="forbid"):
    return Pairs(Tessellation(name, neighbourhood), crossing)


@pytest.mark.parametrize(("name", "neighbourhood"), KINDS)
@pytest.mark.parametrize("following", FOLLOWINGS)
@pytest.mark.parametrize("clock", CLOCKS)
def test_the_least_distance_is_that_of_all_pairs_of_moves(name, neighbourhood, clock, following):
    for costs, crossing in product(COSTS, CROSSINGS):
        tessellation = Tessellation(name, neighbourhood, costs, clock)
        least, _ = pairs_of(name, neighbourhood, crossing).nearest_legal(tessellation, following)
        assert least_distance(tessellation, crossing, following) == pytest.approx(least, abs=1e-6)


@pytest.mark.parametrize(("name", "neighbourhood"), KINDS)
def test_where_nobody_follows_no_timing_brings_robots_nearer(name, neighbourhood):
    """Each is on the segment between the cells that it owns, whatever it does; times and speeds are real numbers."""
    tessellation = Tessellation(name, neighbourhood)
    pairs, least = pairs_of(name, neighbourhood), least_distance(tessellation, following="forbid")
    together = pairs.are_legal(1.0, 1.0, 0.0, "forbid")
    segments = shapely.linestrings(pairs.point[:, :2]), shapely.linestrings(pairs.point[:, 2:])
    assert shapely.distance(*segments)[together].min() == pytest.approx(least, abs=1e-6)
    rng = np.random.default_rng(1)
    for _ in range(swept(100)):
        duration_a, duration_b = rng.uniform(0.1, 1, (2, len(pairs.a)))  # for speeds from 10 to 100 %
        delay = rng.uniform(-duration_b, duration_a)
        legal = pairs.are_legal(duration_a, duration_b, delay, "forbid")
        assert np.array_equal(legal, together)
        assert pairs.nearest(duration_a, duration_b, delay)[legal].min() >= least - 1e-9


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
    lines = text[text.index("| cells | clock, following |") :].split("\n\n")[0].splitlines()[2:]
    names = {
        "3": ("triangular", "edge"),
        "12": ("triangular", "full"),
        "4": ("square", "edge"),
        "8": ("square", "full"),
    }
    seen = set()
    for line in lines:
        cells, rule, _, formula, size, radius = (cell.strip() for cell in line.strip("|").split("|"))
        kind = ("hexagonal", "full") if cells == "hexagonal" else names[cells.split()[1]]
        assert kind[0] in cells
        clock, following = rule.split(", ")
        for one in CLOCKS if clock == "any" else (clock,):
            tessellation = Tessellation(*kind, "euclidean", one)
            least = least_distance(tessellation, following=following)
            root, value = formula.split(" = ")
            square = Fraction(root.removeprefix("sqrt(").removesuffix(")"))
            assert (sqrt(square) if "sqrt" in root else square) == pytest.approx(least)
            assert float(value) == pytest.approx(least, abs=5e-5)
            assert float(size) == ceil(least_cell_size(tessellation, 0.15, following) * 1e4 - 1e-6) / 1e4
            assert float(radius) == int(least * 0.25 * 1e4 + 1e-6) / 1e4
            seen.add((kind, one, following))
    assert len(lines) == 12 and len(seen) == 5 * 2 * 2
