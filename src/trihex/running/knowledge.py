"""Knowledge: what robots have seen of the world, all together."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import World
from trihex.running.sensing import Sensor


class Knowledge:
    """Since when robots know each cell.

    Parameters
    ----------
    world : World
        What there is to know.
    sensor : Sensor or None
        What each robot sees; None if they know everything.
    """

    def __init__(self, world: World, sensor: Sensor | None) -> None:
        self.layout = world.layout
        self._since = np.full(world.layout.size, 0 if sensor is None else -1, dtype=np.int32)
        self._eyes = None if sensor is None else _eyes_of(sensor, world)

    @property
    def known_since(self) -> NDArray[np.int32]:
        """The step in which each cell was seen, or announced, -1 where it was not; shape (height, width)."""
        return self.layout.cells_of(self._since).copy()  # type: ignore[return-value]

    @property
    def is_known(self) -> NDArray[np.bool_]:
        """Which cells robots know, shape (height, width)."""
        return self.known_since >= 0

    def look(self, sites: NDArray[np.int32], step: int) -> NDArray[np.int32]:
        """Let robots at `sites` look around after `step`, and return the sites that none had seen before."""
        from trihex.running.kernels.sensing import look

        if self._eyes is None:
            return np.empty(0, dtype=np.int32)
        news = np.empty(self.layout.height * self.layout.width, dtype=np.int32)
        self._since[sites] = np.where(self._since[sites] < 0, step, self._since[sites])
        return news[: look(sites, *self._eyes, step, self._since, news)]

    def change(self, blocked: NDArray[np.int32], freed: NDArray[np.int32], step: int) -> None:
        """Forget the sites where barriers appear, and note that it is announced after `step` where they go."""
        self._since[blocked] = -1
        self._since[freed] = step


def _eyes_of(sensor: Sensor, world: World) -> tuple[Any, Any]:
    """Return what a robot can see from each cell, and the world that it sees, for kernels."""
    from trihex.kernels.signatures import given
    from trihex.running.kernels.sensing import SeenWorld, Sight

    first, between_dx, between_dy = sensor.rays
    sight = given(
        Sight, dx=sensor.seen_dx, dy=sensor.seen_dy, first=first, between_dx=between_dx, between_dy=between_dy
    )
    layout = world.layout
    seen = given(
        SeenWorld,
        origin=layout.origin,
        pitch=layout.pitch,
        height=layout.height,
        width=layout.width,
        blocked=world.blocked,
    )
    return sight, seen
