"""Setting: what a picture shows of a world in one step: barriers, destinations and where robots begin."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Area, Scenario
from trihex.plans import Motion, Plan


@dataclass(frozen=True)
class Setting:
    """As a `Scenario` has them, but nothing is checked: a run may end without a destination."""

    area: Area
    destinations: NDArray[np.int64]
    robots: NDArray[np.int64]

    @property
    def robot_count(self) -> int:
        """Number of robots."""
        return int(self.robots.size)


def setting_of(motion: Motion, step: int | None = None) -> Scenario | Setting:
    """Return barriers and destinations as they were in a step (default: in the last one), and all robots."""
    scenario = motion.scenario
    if isinstance(motion, Plan):
        return scenario
    worlds = deque(islice(motion.worlds(), step), 1)
    barriers, destinations = worlds.pop() if worlds else (scenario.area.barriers, scenario.destinations)
    return Setting(replace(scenario.area, barriers=barriers), destinations, motion.robots)
