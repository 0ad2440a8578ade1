"""Slots: the paper's c against a literal count of meetings, and how branches and regions share them out."""

import numpy as np
import pytest

import trihex as th
from tests.strategies import random_scenario
from tests.sweeps import swept
from trihex.planners.slots import Slots


def shortest_path(n_scheme, d_scheme, cell):
    """Cells of the path that follows the first best direction, `cell` first."""
    area = n_scheme.scenario.area
    path = [cell]
    while n_scheme.distance_of_cell([path[-1]])[0] > 0:
        x, y = (int(i) for i in area.cell_to_xy(path[-1]))
        bits = int(d_scheme.directions[y, x])
        k = next(k for k in range(16) if bits >> k & 1)
        dx, dy = area.tessellation.step_of_direction[int(area.tessellation.orientation_of_cell(x, y)), k]
        path.append(int(area.xy_to_cell(x + dx, y + dy)))
    return path


@pytest.mark.parametrize("seed", range(swept(60, 10)))
def test_the_paper_s_count_over_all_paths_is_a_look_up(seed):
    """c: the others that are in one cell at one step with the path that starts with a direction."""
    scenario = random_scenario(seed, sides=(3, 9))
    n_scheme = th.make_n_scheme(scenario)
    d_scheme = th.make_d_scheme(n_scheme)
    layout = scenario.area.layout
    slot_table = Slots(d_scheme, is_literal=True)
    distance = n_scheme.distance_of_cell(scenario.robots)
    going = scenario.robots[(distance > 0) & (distance < 2**31 - 1)]
    path_of_robot = [shortest_path(n_scheme, d_scheme, int(cell))[:-1] for cell in going]
    slot_table.find_regions(layout.cell_to_site(going))
    slots = slot_table.find_slots(layout.cell_to_site(going))
    count = np.bincount(slots, minlength=slot_table.first_slot[-1] + 1)
    reached = np.flatnonzero(n_scheme.distance.reshape(-1) < 2**31 - 1)
    for robot, own_slot in enumerate(slots):
        for target in reached[:: max(1, reached.size // 12)]:  # any cell may stand for the one a direction leads to
            path = [None, *shortest_path(n_scheme, d_scheme, int(target))[:-1]]
            others = [p for r, p in enumerate(path_of_robot) if r != robot]
            literal = sum(any(a == b for a, b in zip(path[1:], other[1:], strict=False)) for other in others)
            looked_up = 0
            if n_scheme.distance_of_cell([target])[0] > 0:
                slot = slot_table.find_slots(layout.cell_to_site(np.array([target])))[0] + 1
                looked_up = count[slot] - (slot == own_slot)
            assert looked_up == literal


@pytest.mark.parametrize("is_literal", [False, True])
@pytest.mark.parametrize("seed", range(swept(30, 10)))
def test_each_robot_is_counted_in_a_slot_of_its_own_region(seed, is_literal):
    scenario = random_scenario(5_000 + seed, sides=(3, 9))
    n_scheme = th.make_n_scheme(scenario)
    slots = Slots(th.make_d_scheme(n_scheme), is_literal)
    distance = n_scheme.distance_of_cell(scenario.robots)
    starts = scenario.area.layout.cell_to_site(scenario.robots[(distance > 0) & (distance < 2**31 - 1)])
    region = slots.find_regions(starts)
    slot = slots.find_slots(starts)
    assert slots.count.sum() == starts.size
    assert (np.bincount(slot, minlength=slots.count.size) == slots.count).all()
    branch = slots.branch_of_slot[slot]
    assert (slots.first_slot[branch] <= slot).all() and (slot < slots.first_slot[branch + 1]).all()
    assert (slots.first_branch[region] <= branch).all() and (branch < slots.first_branch[region + 1]).all()
    if is_literal:
        assert not region.any()
