"""Strategies: any areas, scenarios and walks, however senseless, that files must carry."""

import numpy as np
from hypothesis import strategies as st

from trihex.areas import (
    CLOCKS,
    CORNERS,
    COSTS,
    CROSSINGS,
    FOLLOWINGS,
    NEIGHBOURHOODS,
    TESSELLATIONS,
    Area,
    Frame,
    Scenario,
    Tessellation,
)
from trihex.kernels.codes import WAIT
from trihex.plans import Plan, plan_from_lists

NAMES = st.text(st.characters(codec="utf-8", exclude_categories=["Cs"]), max_size=8)


@st.composite
def areas(draw: st.DrawFn, *, least_free: int = 0) -> Area:
    tessellation = Tessellation(
        draw(st.sampled_from(TESSELLATIONS)), draw(st.sampled_from(NEIGHBOURHOODS)), draw(st.sampled_from(COSTS))
    )
    height, width = draw(st.integers(1, 6)), draw(st.integers(max(1, least_free), 6))
    barriers = np.array(draw(st.lists(st.booleans(), min_size=height * width, max_size=height * width)))
    barriers[:least_free] = False
    return Area(tessellation, barriers.reshape(height, width))


FRAMES = st.builds(
    Frame,
    st.floats(0.001, 1e9),
    st.tuples(st.floats(-1e9, 1e9), st.floats(-1e9, 1e9)),
    st.floats(-9, 9),
    st.just(0.0),  # any larger radius forbids small cells and many rules
)


@st.composite
def scenarios(draw: st.DrawFn, *, most_robots: int = 6) -> Scenario:
    area = draw(areas(least_free=2))
    free = np.flatnonzero(~area.barriers.reshape(-1)).tolist()
    destinations = draw(st.lists(st.sampled_from(free), min_size=1, max_size=3, unique=True))
    robots = draw(st.lists(st.sampled_from(free), max_size=most_robots, unique=True))
    clock = draw(st.sampled_from(CLOCKS))
    return Scenario(
        area,
        np.array(destinations),
        np.array(robots, dtype=np.int64),
        waiting_cost=draw(st.integers(0, 2000)) if clock == "steps" else None,
        crossing=draw(st.sampled_from(CROSSINGS)),
        corners=draw(st.sampled_from(CORNERS)),
        destination_capacity=draw(st.none() | st.integers(1, 5)),
        seed=draw(st.none() | st.integers(0, 2**30)),
        clock=clock,
        following=draw(st.sampled_from(FOLLOWINGS)),
    )


@st.composite
def walks(draw: st.DrawFn) -> Plan:
    """A plan in which robots stray about inside the area, through barriers and each other."""
    scenario = draw(scenarios())
    area = scenario.area
    actions: list[list[int]] = []
    for robot in scenario.robots.tolist():
        y, x = divmod(robot, area.width)
        own: list[int] = []
        for _ in range(draw(st.integers(0, 6))):
            steps = area.tessellation.step_of_direction[int(area.tessellation.orientation_of_cell(x, y))].tolist()
            inside = [k for k, (dx, dy) in enumerate(steps) if 0 <= x + dx < area.width and 0 <= y + dy < area.height]
            action = draw(st.sampled_from([WAIT, *inside]))
            own.append(action)
            if action != WAIT:
                x, y = x + steps[action][0], y + steps[action][1]
        actions.append(own)
    return plan_from_lists(scenario, actions)
