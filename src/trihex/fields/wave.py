"""Wave: distances that spread from where some of them changed or are given."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.errors import ScenarioError
from trihex.kernels.codes import NOT_REACHED

BUDGET = 1 << 18  # entries looked at in one call of a kernel, a few hundredths of a second
_LEAST = 1 << 10


class Wave:
    """What waves of raising and lowering need beside the field that they change; kept from one wave to the next.

    Parameters
    ----------
    scenario : Scenario
        For its tessellation and layout; its barriers may have changed since.
    moves : ndarray of uint16
        Open moves of each site, as in `Scenario`.
    distance_of_site : ndarray of int32
        The field, changed in place.
    """

    def __init__(self, scenario: Scenario, moves: NDArray[np.uint16], distance_of_site: NDArray[np.int32]) -> None:
        self.offset = scenario.area.layout.offset_of_direction
        self.cost = scenario.area.tessellation.cost_of_direction
        self.moves, self.distance_of_site = moves, distance_of_site
        self._lists = np.empty((3, _LEAST), dtype=np.int32)
        self._log = np.empty(_LEAST, dtype=np.int32)

    def raised(self, doubtful: NDArray[np.int32]) -> NDArray[np.int32]:
        """Raise to "not reached" what has lost its support, beginning at `doubtful` sites; return the sites raised."""
        from trihex.fields.kernels.repair import RAISE

        doubtful = doubtful[self.distance_of_site[doubtful] != NOT_REACHED]
        return self._run(RAISE, doubtful)

    def lowered(self, sites: NDArray[np.int32]) -> NDArray[np.int32]:
        """Let what comes nearer by way of `sites` know; return all sites that have a new distance."""
        from trihex.fields.kernels.repair import LOWER

        return self._run(LOWER, sites)

    def _run(self, wave: int, sites: NDArray[np.int32]) -> NDArray[np.int32]:
        from trihex.fields.kernels import repair as kernels

        beginnings = self.distance_of_site[sites].astype(np.int64) << 32 | sites
        beginnings.sort()
        state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
        while state[kernels.REASON] != kernels.DONE:
            kernels.run_wave(
                *(wave, state, beginnings, self._lists.reshape(-1), self._log),
                *(self.moves, self.offset, self.cost, self.distance_of_site, BUDGET),
            )
            if state[kernels.REASON] == kernels.TOO_FAR:
                raise ScenarioError(f"distances must stay below {kernels.FARTHEST}; a cell that can be reached is not")
            if state[kernels.REASON] == kernels.LISTS_FULL:
                self._lists = np.concatenate([self._lists, np.empty_like(self._lists)], axis=1)
            if state[kernels.REASON] == kernels.LOG_FULL:
                self._log = np.concatenate([self._log, np.empty_like(self._log)])
        return self._log[: state[kernels.LOGGED]].copy()


def renew_directions(
    scenario: Scenario,
    sites: NDArray[np.int32],
    moves: NDArray[np.uint16],
    distance_of_site: NDArray[np.int32],
    directions_of_site: NDArray[np.uint16],
) -> None:
    """Find the best directions of `sites` anew, in place, and of their neighbours those that lead to them."""
    from trihex.fields.kernels import repair as kernels

    layout, cost = scenario.area.layout, scenario.area.tessellation.cost_of_direction
    offset, back = layout.offset_of_direction, layout.back_of_direction
    for start in range(0, sites.size, BUDGET):
        part = sites[start : start + BUDGET]
        kernels.renew_directions(part, moves, offset, back, cost, distance_of_site, directions_of_site)
