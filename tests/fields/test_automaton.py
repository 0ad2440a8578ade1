"""The automaton against plain loops over cells, known patterns, and paths counted move by move."""

from __future__ import annotations

import doctest
import runpy
from itertools import product
from math import comb
from pathlib import Path

import numpy as np
import pytest

import trihex as th
from tests.oracles.lattice import Lattice, corners_of
from trihex.fields import OBSTACLE
from trihex.kernels.codes import NOT_REACHED

ROOT = Path(__file__).parents[2]
WAYS = [("square", "full"), ("square", "edge"), ("hexagonal", "full"), ("triangular", "full"), ("triangular", "edge")]
ALL_ROUND_3D = [offset for offset in product((-1, 0, 1), repeat=3) if any(offset)]


def make_life(neighbourhood, born, survive, boundary=0):
    def rule(own, neighbours):
        alive = neighbours.sum(axis=0)
        return np.where(own == 1, np.isin(alive, survive), np.isin(alive, born))

    return th.CellularAutomaton(neighbourhood, 2, rule, boundary=boundary)


def make_elementary(number, boundary=0):
    return th.CellularAutomaton(
        [-1, 1], 2, lambda own, near: number >> (4 * near[0] + 2 * own + near[1]) & 1, boundary=boundary
    )


def place(pattern, height, width, x, y):
    states = np.zeros((height, width), dtype=int)
    rows = [[int(c == "o") for c in row] for row in pattern]
    states[y : y + len(rows), x : x + len(rows[0])] = rows
    return states


# One dimension


def test_rule_30_has_its_middle_column():
    start = np.zeros(61, dtype=int)
    start[30] = 1
    middle = [int(states[30]) for states in make_elementary(30).generations(start, limit=19)]
    assert middle == [1, 1, 0, 1, 1, 1, 0, 0, 1, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 1]  # OEIS A051023


def test_rule_90_is_pascals_triangle_modulo_2():
    start = np.zeros(67, dtype=int)
    start[33] = 1
    for g, states in enumerate(make_elementary(90).generations(start, limit=32)):
        expected = np.zeros(67, dtype=int)
        for i in range(g + 1):
            expected[33 - g + 2 * i] = comb(g, i) % 2
        np.testing.assert_array_equal(states, expected)


def test_rule_110_has_its_rows():
    start = [0] * 15 + [1]
    rows = [int("".join(map(str, states)), 2) for states in make_elementary(110).generations(start, limit=8)]
    assert rows == [1, 3, 7, 13, 31, 49, 115, 215, 509]  # OEIS A006978


@pytest.mark.parametrize("number", range(256))
def test_every_elementary_rule_equals_a_loop(number):
    row = [int(c) for c in "0110100010111101"]
    for boundary in (0, 1, "periodic"):
        states = row
        automaton = make_elementary(number, boundary)
        for generation in automaton.generations(row, limit=6):
            assert generation.tolist() == states
            ends = (states[-1], states[0]) if boundary == "periodic" else (boundary, boundary)
            padded = [ends[0], *states, ends[1]]
            states = [int(f"{number:08b}"[7 - int(f"{padded[i]}{padded[i + 1]}{padded[i + 2]}", 2)]) for i in range(16)]


# Two dimensions


def test_a_glider_moves_by_one_cell_in_four_generations():
    automaton = make_life("square", [3], [2, 3])
    start = place([".o.", "..o", "ooo"], 12, 12, 1, 2)
    generations = list(automaton.generations(start, limit=16))
    for g in (4, 8, 12, 16):
        np.testing.assert_array_equal(generations[g], np.roll(start, (g // 4, g // 4), (0, 1)))
    assert not np.array_equal(generations[2], np.roll(start, (1, 1), (0, 1)))


def test_a_glider_comes_back_on_a_torus():
    automaton = make_life("square", [3], [2, 3], boundary="periodic")
    start = place([".o.", "..o", "ooo"], 7, 7, 4, 4)
    np.testing.assert_array_equal(automaton.run(start, limit=28).configuration, start)


def test_a_triangular_glider_moves_along_its_row():
    # A block of 2 x 4 cells lives on under the rule 4,5,6/4: it moves by 2 cells in 3 generations, to the east if its
    # first cell points south, to the west if it points north; on a torus of 16 columns it is back after 24.
    automaton = make_life("triangular", [4], [4, 5, 6], boundary="periodic")
    for x, shift in ((5, 2), (4, -2)):
        start = place(["oooo", "oooo"], 8, 16, x, 4)
        generations = list(automaton.generations(start, limit=24))
        for g in range(0, 25, 3):
            np.testing.assert_array_equal(generations[g], np.roll(start, shift * g // 3, axis=1))


def test_a_hexagonal_pair_blinks():
    # Two cells that both touch the same two: these are born in between, and back again.
    automaton = make_life("hexagonal", [2], [3, 5])
    one = place([".o", "..", "o."], 6, 6, 2, 1)
    generations = list(automaton.generations(one, limit=4))
    other = generations[1]
    assert other.sum() == 2
    assert not (one & other).any()
    assert [np.array_equal(g, one) for g in generations] == [True, False, True, False, True]


@pytest.mark.parametrize(("name", "neighbourhood"), WAYS)
@pytest.mark.parametrize("boundary", [0, 2])
def test_neighbours_are_those_that_share_points(name, neighbourhood, boundary):
    # A rule that tells every neighbourhood from every other: the sum of powers of the states, three states.
    height, width = 6, 7
    rng = np.random.default_rng(5)
    start = rng.integers(0, 3, (height, width))
    tessellation = th.Tessellation(name, neighbourhood)
    least = 1 if neighbourhood == "full" else 2
    automaton = th.CellularAutomaton(
        tessellation, 3, lambda own, near: (own + (near * near).sum(axis=0)) % 3, boundary=boundary
    )
    everywhere = list(product(range(-2, width + 2), range(-2, height + 2)))
    around = {
        cell: [
            other
            for other in everywhere
            if other != cell and len(corners_of(name, cell) & corners_of(name, other)) >= least
        ]
        for cell in product(range(width), range(height))
    }
    states = {(x, y): int(start[y, x]) for x, y in around}
    for generation in automaton.generations(start, limit=4):
        assert {(x, y): int(generation[y, x]) for x, y in around} == states
        states = {
            cell: (states[cell] + sum(states.get(other, boundary) ** 2 for other in around[cell])) % 3
            for cell in around
        }


def test_neighbours_come_in_the_order_of_directions():
    for name, neighbourhood in WAYS:
        tessellation = th.Tessellation(name, neighbourhood)
        start = np.arange(80).reshape(8, 10)
        seen = []
        th.CellularAutomaton(
            tessellation,
            80,
            lambda own, near: seen.append(near.copy()) or own,  # noqa: B023
            boundary=0,
        ).next_generation(start)
        for x, y in ((4, 4), (5, 4), (4, 5), (5, 5)):
            names = tessellation.direction_names[int(tessellation.orientation_of_cell(x, y))]
            for k, direction in enumerate(names):
                there = int(seen[0][k, y, x])
                assert (there // 10 > y) == ("S" in direction) or name == "hexagonal"
                assert (there % 10 > x) == ("E" in direction)
                assert (there % 10 < x) == ("W" in direction)


def test_two_lists_of_offsets_are_the_two_orientations():
    tessellation = th.Tessellation("hexagonal")
    start = np.random.default_rng(1).integers(0, 2, (9, 9))
    by_name = make_life("hexagonal", [2], [3, 4])
    by_lists = th.CellularAutomaton(tessellation.step_of_direction, 2, by_name.rule, tessellation=tessellation)
    assert by_lists == by_name
    np.testing.assert_array_equal(by_lists.run(start, 9).configuration, by_name.run(start, 9).configuration)


# Three dimensions


def test_life_5766_carries_conways_glider_in_two_layers():
    automaton = make_life(ALL_ROUND_3D, [6], [5, 6, 7])
    flat = place([".o.", "..o", "ooo"], 12, 12, 2, 3)
    start = np.zeros((6, 12, 12), dtype=int)
    start[2:4] = flat
    number = 0
    for number, states in enumerate(automaton.generations(start, limit=12)):
        if number % 4 == 0:
            np.testing.assert_array_equal(states, np.roll(start, (number // 4, number // 4), (1, 2)))
    assert number == 12


@pytest.mark.parametrize("boundary", [0, 1, "periodic"])
def test_a_rule_in_three_dimensions_equals_a_loop(boundary):
    offsets = [(1, 0, 0), (0, -2, 0), (0, 0, 1), (-1, 1, 3), (0, 0, 0)]
    depth, height, width = 3, 4, 5
    start = np.random.default_rng(2).integers(0, 4, (depth, height, width))
    automaton = th.CellularAutomaton(
        offsets, 4, lambda own, near: (own + near[0] * near[1] + 2 * near[2] + near[3] + near[4]) % 4, boundary=boundary
    )
    states = start.tolist()

    def at(x, y, z):
        if boundary == "periodic":
            return states[z % depth][y % height][x % width]
        inside = 0 <= x < width and 0 <= y < height and 0 <= z < depth
        return states[z][y][x] if inside else boundary

    for generation in automaton.generations(start, limit=5):
        assert generation.tolist() == states
        states = [
            [
                [
                    (
                        2 * at(x, y, z)
                        + at(x + 1, y, z) * at(x, y - 2, z)
                        + 2 * at(x, y, z + 1)
                        + at(x - 1, y + 1, z + 3)
                    )
                    % 4
                    for x in range(width)
                ]
                for y in range(height)
            ]
            for z in range(depth)
        ]


@pytest.mark.parametrize("dimensions", [1, 2, 3])
def test_the_parity_rule_copies_every_pattern(dimensions):
    # Fredkin: under "sum of the neighbours modulo 2", after 2^m generations each offset holds a copy 2^m times as far.
    offsets = [(1,), (-1,), (2,)] if dimensions == 1 else [(1, 0, 0), (-1, 1, 0), (0, -1, 1), (0, 0, -1)]
    offsets = [offset[:dimensions] for offset in offsets]
    start = np.zeros((48,) * dimensions, dtype=int)
    start[(slice(22, 25),) * dimensions] = np.random.default_rng(3).integers(0, 2, (3,) * dimensions)
    automaton = th.CellularAutomaton(offsets, 2, lambda own, near: near.sum(axis=0) % 2)
    expected = sum(np.roll(start, [-8 * d for d in offset[::-1]], range(dimensions)) for offset in offsets) % 2
    np.testing.assert_array_equal(automaton.run(start, limit=8).configuration, expected)


# Generations


def test_it_ends_when_nothing_changes():
    automaton = make_life("square", [3], [2, 3])
    block = place(["oo", "oo"], 5, 5, 1, 1)
    assert [g.tolist() for g in automaton.generations(block)] == [block.tolist()]
    last = automaton.run(place(["o"], 5, 5, 2, 2))
    assert (last.number, last.configuration.sum()) == (1, 0)
    blinker = place(["ooo"], 5, 5, 1, 2)
    assert automaton.run(blinker, limit=7).number == 7
    assert len(list(automaton.generations(blinker, limit=0))) == 1


def test_generations_are_read_only_and_nobody_elses():
    mine = np.array([0, 1, 0, 0])
    shift = th.CellularAutomaton([-1], 2, lambda own, near: near[0])
    first, second = shift.generations(mine, limit=1)
    mine[:] = 1
    assert (first.tolist(), second.tolist()) == ([0, 1, 0, 0], [0, 0, 1, 0])
    with pytest.raises(ValueError, match="read-only"):
        first[0] = 1


def test_states_may_be_any_whole_numbers():
    sign = th.CellularAutomaton([1], {-7, 7, 100}, lambda own, near: np.where(near[0] == 100, 7, -own), boundary=100)
    assert sign.states == (-7, 7, 100)
    assert sign.next_generation([7, 7, -7]).tolist() == [-7, -7, 7]
    assert th.CellularAutomaton([1], [2, 1, 0], lambda own, near: own).states == range(3)
    both = th.CellularAutomaton([1], 2, lambda own, near: own == near[0])
    assert both.next_generation([True, False, False]).tolist() == [0, 1, 1]


def identity(own, neighbours):
    return own


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([], 2), "neighbourhood must be a tessellation, its name, or offsets"),
        (([(0, 1), (1,)], 2), "neighbourhood must be a tessellation, its name, or offsets"),
        (([0.5], 2), "neighbourhood must be a tessellation, its name, or offsets"),
        (([(1, 0, 0, 0)], 2), "neighbourhood must have 1, 2 or 3 dimensions, not 4"),
        (([[(1, 0)], [(0, 1)]], 2), "two lists of offsets only beside a tessellation"),
        (([1, -1, 1], 2), r"must not list an offset twice: \(1,\)"),
        (([1], 0), "states must be a whole number above 0 or a set of whole numbers, not 0"),
        (([1], [0, 0.5]), "states must be a whole number above 0"),
        (([1], 2, "life"), r"rule must be a function of \(own, neighbours\), not 'life'"),
        (([1], 2, identity, 2), r"boundary must be 'periodic' or a state of 0..1, not 2"),
        (([1], (3, 5), identity, 4), r"boundary must be 'periodic' or a state of \{3, 5\}, not 4"),
        (([1], 2, identity, "Periodic"), "did you mean 'periodic'"),
        (([1], 2, identity, 0, "square"), "neighbourhood must have 2 dimensions on a tessellation, not 1"),
    ],
)
def test_what_makes_no_automaton_is_refused(arguments, message):
    neighbourhood, states, *rest = arguments
    with pytest.raises(th.AutomatonError, match=message):
        th.CellularAutomaton(neighbourhood, states, *(rest or [identity]))


def test_an_unknown_tessellation_is_refused_by_its_near_name():
    with pytest.raises(th.TessellationError, match="did you mean 'hexagonal'"):
        th.CellularAutomaton("hexagon", 2, identity)


@pytest.mark.parametrize(
    ("configuration", "message"),
    [
        ([0, 1], r"configuration must be a filled array of 2 dimensions, not \(2,\)"),
        ([[]], "configuration must hold whole numbers"),
        (np.zeros((0, 3), dtype=int), "configuration must be a filled array of 2 dimensions"),
        ([[0, 1], [0]], "configuration must be a full array: its rows differ in length"),
        ([[0.5]], "configuration must hold whole numbers, not float64"),
        ([[0, 0, 0], [0, 2, 0]], r"configuration must hold states of 0..1; cell \(1, 1\) holds 2"),
    ],
)
def test_what_is_no_configuration_is_refused(configuration, message):
    with pytest.raises(th.AutomatonError, match=message):
        make_life("square", [3], [2, 3]).generations(configuration)


@pytest.mark.parametrize(
    ("rule", "message"),
    [
        (
            lambda own, near: near,
            r"what rule returns must have the shape of the configuration, \(2, 2\), not \(8, 2, 2\)",
        ),
        (lambda own, near: own + 0.5, "what rule returns must hold whole numbers, not float64"),
        (lambda own, near: own - 1, r"what rule returns must hold states of 0..1; cell \(0, 0\) holds -1"),
        (lambda own, near: None, "what rule returns must hold whole numbers, not object"),
    ],
)
def test_what_a_rule_must_not_return(rule, message):
    with pytest.raises(th.AutomatonError, match=message):
        th.CellularAutomaton("square", 2, rule).run([[0, 0], [0, 0]])


def test_a_limit_is_a_whole_number():
    with pytest.raises(th.AutomatonError, match="limit must be a whole number from 0, not -1"):
        make_elementary(30).run([1], limit=-1)


def test_a_torus_of_oriented_cells_has_even_sides():
    for name, shape, message in [
        ("hexagonal", (4, 5), "width of a periodic hexagonal configuration must be even, not 5"),
        ("triangular", (4, 5), "width of a periodic triangular configuration must be even, not 5"),
        ("triangular", (5, 4), "height of a periodic triangular configuration must be even, not 5"),
    ]:
        with pytest.raises(th.AutomatonError, match=message):
            make_life(name, [2], [3], "periodic").generations(np.zeros(shape, dtype=int))
    assert make_life("hexagonal", [2], [3], "periodic").run(np.zeros((5, 4), dtype=int)).number == 0
    assert make_life("square", [2], [3], "periodic").run(np.zeros((5, 5), dtype=int)).number == 0


# The distance rule


def least_costs(lattice, barriers, destinations, rule):
    """Yield for 0, 1, 2, ... moves the least cost of a path of at most that many moves, until nothing changes."""
    cost = dict.fromkeys(destinations, 0)
    ways = {
        cell: [(o, c) for o, c in near.items() if o not in barriers and lattice.is_open(cell, o, barriers, rule)]
        for cell, near in lattice.cost.items()
        if cell not in barriers
    }
    while True:
        yield cost
        after = {}
        for cell, near in ways.items():
            reached = [cost[cell]] if cell in cost else []
            reached += [cost[other] + c for other, c in near if other in cost]
            if reached:
                after[cell] = min(reached)
        if after == cost:
            return
        cost = after


@pytest.mark.parametrize(("name", "neighbourhood"), WAYS)
@pytest.mark.parametrize("corners", ["allow", "no-squeeze", "no-cut"])
@pytest.mark.parametrize("costs", ["paper", "euclidean"])
def test_a_generation_holds_the_least_cost_of_as_many_moves(name, neighbourhood, corners, costs):
    rng = np.random.default_rng([len(name), len(neighbourhood), len(corners), len(costs)])
    for _ in range(10):
        height, width = rng.integers(1, 9, 2)
        walls = rng.random((height, width)) < rng.uniform(0, 0.5)
        walls[rng.integers(height), rng.integers(width)] = False
        free = np.flatnonzero(~walls)
        destinations = rng.choice(free, size=min(free.size, rng.integers(1, 4)), replace=False)
        area = th.Area(th.Tessellation(name, neighbourhood, costs), walls)
        scenario = th.Scenario(area, destinations, corners=corners)
        lattice = Lattice(name, neighbourhood, costs, height, width)
        barriers = {(x, y) for x, y in lattice.inside if walls[y, x]}
        goals = [(int(cell) % width, int(cell) // width) for cell in destinations]
        expected = least_costs(lattice, barriers, goals, corners)
        for states, cost in zip(th.distance_generations(scenario), expected, strict=True):
            seen = {(x, y): int(states[y, x]) for x, y in lattice.inside}
            assert seen == {
                cell: OBSTACLE if cell in barriers else cost.get(cell, NOT_REACHED) for cell in lattice.inside
            }
        fixed_point = np.where(states == OBSTACLE, NOT_REACHED, states)
        np.testing.assert_array_equal(th.make_n_scheme(scenario).distance, fixed_point)


def test_obstacles_stay_obstacles():
    # The paper's state of obstacles, 1, is less than every distance but 0; it must neither spread nor be overwritten.
    scenario = th.Scenario(th.Area("triangular", [[0, 1, 1, 1, 0]]), destinations=[(0, 0)])
    *_, last = th.distance_generations(scenario)
    assert last.tolist() == [[0, 1, 1, 1, NOT_REACHED]]


def test_the_n_scheme_is_the_last_generation_beyond_the_range_of_small_numbers():
    # A serpentine: one corridor of 599 moves, so that neither 8 bits hold its generations nor 16 bits its distances.
    walls = np.zeros((35, 32), dtype=bool)
    walls[1::2] = True
    walls[1::4, -1] = walls[3::4, 0] = False
    for name in ("square", "hexagonal"):
        scenario = th.Scenario(th.Area(th.Tessellation(name, "edge", "euclidean"), walls), destinations=[(0, 0)])
        *_, last = generations = list(th.distance_generations(scenario))
        assert len(generations) > 257
        assert last[~walls].max() > 2**16
        np.testing.assert_array_equal(last[~walls], th.make_n_scheme(scenario).distance[~walls])


# Examples

EXAMPLES = ["distances", "hexagonal_life", "life", "life_in_space", "rule_110", "triangular_life"]


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_example_runs(name, capsys):
    runpy.run_path(str(ROOT / "examples" / "automata" / f"{name}.py"), run_name="__main__")
    assert len(capsys.readouterr().out.splitlines()) >= 8


def test_every_example_is_tested():
    assert sorted(path.stem for path in (ROOT / "examples" / "automata").glob("*.py")) == EXAMPLES


def test_the_page_tells_the_truth():
    result = doctest.testfile(str(ROOT / "docs" / "automaton.md"), module_relative=False)
    assert result.attempted > 10
    assert result.failed == 0
