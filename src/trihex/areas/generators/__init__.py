"""Generators: random areas of five kinds, the same for the same seed."""

from __future__ import annotations

from collections.abc import Callable

from trihex.areas.area import Area
from trihex.areas.generators.caves import make_caves_area
from trihex.areas.generators.maze import make_maze_area
from trihex.areas.generators.random import make_random_area
from trihex.areas.generators.rooms import make_rooms_area
from trihex.areas.generators.warehouse import make_warehouse_area

GENERATORS: dict[str, Callable[..., Area]] = {
    "random": make_random_area,
    "rooms": make_rooms_area,
    "maze": make_maze_area,
    "caves": make_caves_area,
    "warehouse": make_warehouse_area,
}

__all__ = [
    "GENERATORS",
    "make_caves_area",
    "make_maze_area",
    "make_random_area",
    "make_rooms_area",
    "make_warehouse_area",
]
