"""Lower bounds: worlds that fit in the head, and never above the optimum that integer programming finds."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings

import trihex as th
from tests.oracles.optimum import least_total_time
from tests.oracles.rules import Rules
from tests.strategies import scenarios, with_start_times
from tests.sweeps import swept
from trihex.areas import entries_per_step
from trihex.bounds import bounds
from trihex.bounds.cuts import find_cuts
from trihex.bounds.demand import make_demand
from trihex.bounds.gates import make_gate_network
from trihex.bounds.meetings import find_meeting_nodes
from trihex.bounds.queues import queue_past_cuts
from trihex.bounds.rhythm import entry_headways
from trihex.bounds.serving import least_arrivals


def world(drawing, tessellation="hexagonal", **rules):
    """Scenario from a drawing: `.` free, `#` barrier, `D` destination, `r` robot."""
    rows = drawing.split()
    area = th.Area(tessellation, [[letter == "#" for letter in row] for row in rows])
    places = {kind: [(x, y) for y, row in enumerate(rows) for x, a in enumerate(row) if a == kind] for kind in "Dr"}
    return th.Scenario(area, places["D"], places["r"], **rules)


def values(scenario):
    n_scheme = th.make_n_scheme(scenario)
    return [bound(n_scheme).value for bound in (th.distance_bound, th.slot_bound, th.cut_bound)]


EDGES = th.Tessellation("square", "edge")


def test_a_row_of_robots_needs_no_waiting():
    assert values(world("Drrrr")) == [100, 100, 100]


def test_one_way_in_takes_one_robot_a_step():
    # Three robots at 3 steps and one at 4: they arrive in steps 3, 4, 5, 6.
    assert values(world("##r## D..rr ##r##", EDGES)) == [130, 180, 180]


def test_a_door_far_from_the_destination_takes_one_robot_a_step():
    # The nearest of the nine needs 3 steps, and nobody passes the door at the same time: 3 + 4 + ... + 11.
    scenario = world("rrr#... rrr..D. rrr#...", EDGES)
    distance, slot, cut = values(scenario)
    assert (distance, slot, cut) == (420, 420, 630)


NESTED = world("rr#...#r. rr....... rr#...#D. rr#...#..", EDGES)


def test_doors_behind_doors_are_all_seen():
    assert [cut.width for cut in find_cuts(make_demand(th.make_n_scheme(NESTED)), 100)] == [1, 2]
    assert values(NESTED)[2] == least_total_time(NESTED, 20)


def test_robots_between_two_exits_are_parted_by_the_way_to_each():
    # Both doors of a wall lead to D, one much farther: the far robots come through the far door only at a price.
    scenario = world("rrrr#.. rrrr... rrrr#.D rrrr#.. rrrr... rrrr#..", EDGES)
    distance, slot, cut = values(scenario)
    assert distance < slot < cut <= least_total_time(scenario, 20)


@pytest.mark.parametrize(
    ("tessellation", "rules", "entries"),
    [
        ("hexagonal", {}, 6),
        ("square", {}, 8),
        (EDGES, {}, 4),
        ("triangular", {}, 6),  # three edges and three vertices
        ("triangular", dict(crossing="allow"), 12),
        ("triangular", dict(crossing="allow", destination_capacity=5), 5),
        (th.Tessellation("triangular", "edge"), {}, 3),
    ],
)
def test_entries_per_step(tessellation, rules, entries):
    assert entries_per_step(world("..... ..... ..D.. ..... .....", tessellation, **rules)) == entries


def test_entries_of_neighbouring_destinations_are_counted_once():
    assert entries_per_step(world(".D.D.", EDGES)) == 3
    assert entries_per_step(world(".DD.", EDGES)) == 2
    assert entries_per_step(world(".D.D.", EDGES, destination_capacity=1)) == 2


def test_robots_that_cannot_arrive_or_have_arrived_cost_nothing():
    scenario = th.Scenario(th.Area("hexagonal", [[0, 0, 0, 1, 0]]), [(0, 0)], [(0, 0), (2, 0), (4, 0)])
    assert values(scenario) == [20, 20, 20]
    assert values(scenario.with_robots([])) == [0, 0, 0]
    assert values(scenario.with_robots([(4, 0)])) == [0, 0, 0]


def test_a_wait_that_costs_less_than_a_move_makes_queues_cheaper():
    cheap, dear = (world("##r## D..rr ##r##", EDGES, waiting_cost=cost) for cost in (3, 50))
    assert values(cheap) == [130, 130 + 3 * 5, 130 + 3 * 5]
    assert values(dear) == [130, 180, 180]  # who must not stand can go to and fro


def test_the_best_bound_is_named_and_told():
    told = []
    bound = th.make_lower_bound(
        th.make_n_scheme(world("rrr#... rrr..D. rrr#...", EDGES)), progress=lambda *done: told.append(done)
    )
    assert bound == th.LowerBound("cut", 630)
    assert told[-1][0] == told[-1][1]
    assert th.make_lower_bound(th.make_n_scheme(world("Drrrr"))).name == "distance"


@settings(max_examples=swept(150, 20), deadline=None)
@given(scenarios(sides=(1, 4), most_robots=7))
def test_no_bound_exceeds_the_optimum(scenario):
    if scenario.seed % 2:
        scenario = with_start_times(scenario, scenario.seed, latest=5)
    optimum = least_total_time(scenario, 8 + scenario.robot_count)
    if optimum is None:  # so many steps are seldom needed, and more of them cost time
        latest = int(scenario.start_times.max(initial=0))
        optimum = least_total_time(scenario, scenario.area.free_count + scenario.robot_count + latest)
    assert max(*values(scenario), th.queue_bound(th.make_n_scheme(scenario)).value) <= optimum


def all_nodes(demand):
    """Every place where robots can hinder each other."""
    scenario, layout = demand.scenario, demand.scenario.area.layout
    cells = np.flatnonzero(demand.nodes.steps_of_site > 0)
    destinations = layout.cell_to_site(scenario.destinations)
    full = destinations if scenario.destination_capacity else destinations[:0]
    vertices = np.array([], dtype=np.int64)
    if scenario.forbids_crossing:
        edges = scenario.area.tessellation.edge_count
        vertices = np.unique(cells[:, None] + layout.vertex_of_direction[cells & 1, edges:])
        vertices = np.array([v for v in vertices if demand.nodes.sites_around(v).size], dtype=np.int64) + layout.size
    return np.concatenate([cells, full, vertices]).astype(np.int32)


@settings(max_examples=swept(100, 20), deadline=None)
@given(scenarios(sides=(1, 4), most_robots=6))
def test_if_every_place_is_a_gate_the_bound_is_the_least_sum_of_steps(scenario):
    demand = make_demand(th.make_n_scheme(scenario))
    network = make_gate_network(demand, all_nodes(demand))
    arrivals, _ = least_arrivals(demand, network, 40, 10**9)
    optimum = least_total_time(scenario, 8 + scenario.robot_count, count_steps=True)
    assert arrivals.size == demand.sites.size
    assert arrivals.sum() <= optimum
    if scenario.corners == "allow":  # other corner rules allow but some of the ways through a vertex
        assert arrivals.sum() == optimum


@settings(max_examples=swept(60, 20), deadline=None)
@given(scenarios(sides=(3, 7), most_filled=0.6))
def test_a_bound_that_is_cut_short_is_lower(scenario):
    demand = make_demand(th.make_n_scheme(scenario))
    whole = bounds._steps_past_gates(demand, 64, None)
    for limit, value in [("_MOST_LOOKS", 3), ("_MOST_SLOTS", 40), ("_MOST_VISITS", 4 * scenario.area.free_count)]:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(bounds, limit, value)
            assert demand.steps.sum() <= bounds._steps_past_gates(demand, 64, None) <= max(whole, _queued(demand))


def _queued(demand):
    cuts = find_cuts(demand, 10**6)
    return int(queue_past_cuts(demand, cuts, entry_headways(demand.nodes)).sum())


@settings(max_examples=swept(40, 20), deadline=None)
@given(scenarios(sides=(3, 6)))
def test_cuts_part_robots_from_destinations_and_are_nested(scenario):
    scenario = replace(scenario, crossing="allow", destination_capacity=None)
    demand, rules = make_demand(th.make_n_scheme(scenario)), Rules(scenario)
    for nearer, cut in pairwise([None, *find_cuts(demand, 1000)]):
        assert nearer is None or set(nearer.behind) <= set(cut.behind)
        assert cut.width == cut.nodes.size
        blocked = set(rules.places(scenario.area.layout.site_to_cell(cut.nodes)))
        stack = rules.places(scenario.destinations)
        seen = blocked | set(stack)
        while stack:
            new = {other for other, _ in rules.neighbours(stack.pop())} - seen
            seen |= new
            stack += new
        behind = set(rules.places(scenario.area.layout.site_to_cell(demand.sites[cut.behind])))
        assert not behind & (seen - blocked)


def test_meeting_nodes_are_where_robots_meet():
    scenario = world("rrr#... rrr..D. rrr#...", EDGES)
    door = int(scenario.area.layout.cell_to_site(scenario.area.xy_to_cell(3, 1)))
    assert door in find_meeting_nodes(make_demand(th.make_n_scheme(scenario)), 2)
