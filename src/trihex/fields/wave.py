"""Wave: distances that spread from where some of them changed or are given."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario
from trihex.errors import ScenarioError
from trihex.kernels.codes import NOT_REACHED

BUDGET = 1 << 18  # entries looked at in one call of a kernel, a few hundredths of a second
_LEAST = 1 << 10
_PIECE = 1 << 12  # entries between two looks at how many cells a wave has changed that may be too many


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
        from trihex.fields.kernels import repair as kernels
        from trihex.kernels.signatures import given

        layout = scenario.area.layout
        self.distance_of_site = distance_of_site
        self.field = given(
            kernels.WaveField,
            distance=distance_of_site,
            moves=moves,
            offset=layout.offset_of_direction,
            cost=scenario.area.tessellation.cost_of_direction,
        )
        self._kernels = kernels  # to import it anew for each wave took a tenth of the time of a small repair
        self._back = layout.back_of_direction
        self._lists = np.empty((3, _LEAST), dtype=np.int32)
        self._log = np.empty(_LEAST, dtype=np.int32)

    def raised(self, doubtful: NDArray[np.int32], most: int | None = None) -> NDArray[np.int32] | None:
        """Raise to "not reached" what has lost its support, beginning at `doubtful` sites; return the sites raised.

        None, with the wave broken off, if they are more than `most`.
        """
        doubtful = doubtful[self.distance_of_site[doubtful] != NOT_REACHED]
        return self._run(self._kernels.RAISE, doubtful, most)

    def lowered(self, sites: NDArray[np.int32], most: int | None = None) -> NDArray[np.int32] | None:
        """Let what comes nearer by way of `sites` know; return all sites that have a new distance.

        None, with the wave broken off, if they are more than `most`.
        """
        return self._run(self._kernels.LOWER, sites, most)

    def best_of(self, sites: NDArray[np.int32]) -> NDArray[np.int32]:
        """Return the least distance that each of `sites` can have by one move to a neighbour as it is now."""
        best = np.empty(sites.size, dtype=np.int32)
        for start in range(0, sites.size, BUDGET):
            part = slice(start, start + BUDGET)
            self._kernels.find_best(sites[part], self.field, best[part])
        return best

    def renew_directions(self, sites: NDArray[np.int32], directions_of_site: NDArray[np.uint16]) -> None:
        """Find the best directions of `sites` anew, in place, and of their neighbours those that lead to them."""
        for start in range(0, sites.size, BUDGET):
            self._kernels.renew_directions(sites[start : start + BUDGET], self.field, self._back, directions_of_site)

    def _run(self, wave: int, sites: NDArray[np.int32], most: int | None) -> NDArray[np.int32] | None:
        kernels = self._kernels
        beginnings = self.distance_of_site[sites].astype(np.int64) << 32 | sites
        beginnings.sort()
        beginnings.flags.writeable = False
        state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
        front = kernels.WaveFront(state, beginnings, self._lists.reshape(-1), self._log)
        budget = BUDGET if most is None else _PIECE
        while True:
            kernels.run_wave(wave, front, self.field, budget)
            reason = state[kernels.REASON]
            if most is not None and state[kernels.LOGGED] > most:
                return None
            if reason == kernels.DONE:
                return self._log[: state[kernels.LOGGED]].copy()
            if reason == kernels.TOO_FAR:
                raise ScenarioError(f"distances must stay below {kernels.FARTHEST}; a cell that can be reached is not")
            if reason == kernels.LISTS_FULL:
                self._lists = np.concatenate([self._lists, np.empty_like(self._lists)], axis=1)
            if reason == kernels.LOG_FULL:
                self._log = np.concatenate([self._log, np.empty_like(self._log)])
            front = front._replace(lists=self._lists.reshape(-1), log=self._log)


def renew_directions(
    scenario: Scenario,
    sites: NDArray[np.int32],
    moves: NDArray[np.uint16],
    distance_of_site: NDArray[np.int32],
    directions_of_site: NDArray[np.uint16],
) -> None:
    """Find the best directions of `sites` anew, see `Wave.renew_directions`."""
    Wave(scenario, moves, distance_of_site).renew_directions(sites, directions_of_site)
