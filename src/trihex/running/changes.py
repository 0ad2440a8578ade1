"""Changes: the cells that an event makes into something else, or why it cannot."""

from __future__ import annotations

import numpy as np

from trihex.areas import Area, World
from trihex.errors import AreaError, ExecutionError, MissingExtraError
from trihex.running.events import OF_SHAPES, Event, Points
from trihex.running.fleet import Fleet
from trihex.running.obstacles import Obstacles


def cell_at(area: Area, place: tuple[int, int] | None, metres: Points | None = None) -> int:
    """Return the number of the cell that an event names; raises ExecutionError if it lies outside."""
    if metres is not None:
        try:
            return int(area.metres_to_cell(*metres[0]))
        except AreaError as error:
            raise ExecutionError(str(error)) from None
    if place is None:
        raise ExecutionError("the event names no cell")
    x, y = place
    if not (0 <= x < area.width and 0 <= y < area.height):
        raise ExecutionError(f"({x}, {y}) lies outside the area")
    return y * area.width + x


def changes_of(event: Event, world: World, fleet: Fleet, obstacles: Obstacles) -> dict[str, tuple[int, ...]]:
    """Return what an event that concerns cells changes, as an `Occurrence` has it.

    Parameters
    ----------
    event : Event
        A barrier that comes or goes, or a destination that opens, closes or moves. Of many cells those change that can.
    world : World
        As it is before the event.
    fleet : Fleet
        The robots.
    obstacles : Obstacles
        What has come to stand in the world so far; brought up to date.

    Raises
    ------
    ExecutionError
        If it cannot happen.
    """
    area = world.area
    if event.zone is not None:
        cells = _cells_of_zone(area, event.zone)
        changes = _changes_of_many(event, cells, world, fleet)
        obstacles.fill(changes.get("blocked", ()))
        obstacles.clear(changes.get("freed", ()))
        return changes
    if event.metres is not None and event.kind in OF_SHAPES:
        return _changes_of_shape(event, world, fleet, obstacles)
    cell = cell_at(area, event.cell, event.metres)
    if event.kind == "barrier":
        obstacles.fill([_check_clear(cell, world, fleet)])
        return {"blocked": (cell,)}
    if event.kind == "clear":
        if not world.is_barrier(cell):
            raise ExecutionError(f"{area.name_of_cell(cell)} is no barrier")
        obstacles.clear([cell])
        return {"freed": (cell,)}
    if event.kind == "open":
        return {"opened": (_check_new(cell, world),)}
    if cell not in world.destinations:
        raise ExecutionError(f"{area.name_of_cell(cell)} is no destination")
    if event.kind == "close":
        return {"closed": (cell,)}
    return {"closed": (cell,), "opened": (_check_new(cell_at(area, event.to, event.to_metres), world),)}


def _changes_of_shape(event: Event, world: World, fleet: Fleet, obstacles: Obstacles) -> dict[str, tuple[int, ...]]:
    """Return what changes where an obstacle comes, or goes: then cells are free in which nothing else stands."""
    area = world.area
    try:
        cells = set(area.cells_touched(event.metres).tolist())
    except (AreaError, MissingExtraError) as error:
        raise ExecutionError(str(error)) from None
    if event.kind == "clear":
        cells = obstacles.take(cells) - set(np.flatnonzero(area.barriers).tolist())
        return _changes_of_many(event, cells, world, fleet)
    changes = _changes_of_many(event, cells, world, fleet)
    obstacles.put(cells)
    return changes


def _cells_of_zone(area: Area, name: str) -> set[int]:
    try:
        return set(area.cells_of_zone(name).tolist())
    except AreaError as error:
        raise ExecutionError(str(error)) from None


def _changes_of_many(event: Event, cells: set[int], world: World, fleet: Fleet) -> dict[str, tuple[int, ...]]:
    """Return what changes of many cells; raises ExecutionError if none can."""
    barred = {cell for cell in cells if world.is_barrier(cell)}
    taken = cells & set(fleet.cells_owned.reshape(-1).tolist())
    goals = cells & world.destinations
    if event.kind == "barrier":  # whoever wanted to go there cannot
        changes = {"blocked": cells - barred - taken, "closed": goals - taken, "left_out": taken - barred}
    elif event.kind == "clear":
        changes = {"freed": barred}
    elif event.kind == "open":
        changes = {"opened": cells - barred - goals}
    else:
        changes = {"closed": goals}
    if not any(changes.values()):
        what = {
            "barrier": "free",
            "clear": "a barrier",
            "open": "free and no destination yet",
            "close": "a destination",
        }
        raise ExecutionError(f"no cell of {event.place} is {what[event.kind]}")
    return {name: tuple(sorted(own)) for name, own in changes.items()}


def _check_clear(cell: int, world: World, fleet: Fleet) -> int:
    """Return a cell that can become a barrier."""
    if world.is_barrier(cell):
        raise ExecutionError(f"{world.area.name_of_cell(cell)} is a barrier already")
    if cell in world.destinations:
        raise ExecutionError(f"{world.area.name_of_cell(cell)} is a destination, close it first")
    if owner := fleet.words_of_owner(cell):
        raise ExecutionError(owner)
    return cell


def _check_new(cell: int, world: World) -> int:
    """Return a cell that can become a destination."""
    if world.is_barrier(cell):
        raise ExecutionError(f"{world.area.name_of_cell(cell)} is a barrier")
    if cell in world.destinations:
        raise ExecutionError(f"{world.area.name_of_cell(cell)} is a destination already")
    return cell
