"""Law: a scenario as the judge's kernels know it, made from the barriers and the rules alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario

if TYPE_CHECKING:
    from trihex.judging.kernels.doors import GuardedCells
    from trihex.judging.kernels.law import Law


def make_law(scenario: Scenario) -> Law:
    """Return the lattice and the rules."""
    from trihex.judging.kernels.law import Law
    from trihex.kernels.signatures import given

    layout = scenario.area.layout
    law: Law = given(
        Law,
        offset=layout.offset_of_direction,
        vertex=layout.vertex_of_direction,
        ring=layout.ring_of_vertex,
        edge_count=scenario.area.tessellation.edge_count,
        corner_rule=scenario.corner_rule,
        forbids_crossing=scenario.forbids_crossing,
        capacity=scenario.entry_limit,
        duration=scenario.duration_of_direction,
        slowness=scenario.slowness.astype(np.int32),
        forbids_following=scenario.following == "forbid",
        doors=_guarded_cells(scenario),
    )
    return law


def _guarded_cells(scenario: Scenario) -> GuardedCells:
    """Return the cells with a schedule, into which nobody has come yet."""
    from trihex.judging.kernels.doors import GuardedCells
    from trihex.kernels.signatures import given

    schedule, layout = scenario.schedule, scenario.area.layout
    place = np.full(layout.size if schedule.cells.size else 0, -1, dtype=np.int32)
    place[layout.cell_to_site(schedule.cells)] = np.arange(schedule.cells.size)
    step, count = np.zeros((2, schedule.cells.size), dtype=np.int32)
    columns = {"rate": schedule.rate, "period": schedule.period, "phase": schedule.phase}
    cells: GuardedCells = given(GuardedCells, place=place, step=step, count=count, **columns)
    return cells


def make_places(scenario: Scenario) -> NDArray[np.int32]:
    """Return what lies at each site, and as yet robot 0, as the kernels write it."""
    from trihex.judging.kernels import law as kernels

    area, layout = scenario.area, scenario.area.layout
    place = np.full(layout.size, kernels.OUTSIDE, dtype=np.int32)
    rows = place[layout.origin : layout.origin + area.height * layout.pitch].reshape(area.height, layout.pitch)
    rows[:, : area.width] = np.where(area.barriers, np.int32(kernels.BARRIER), np.int32(0))
    place[layout.cell_to_site(scenario.destinations)] = ~0
    return place
