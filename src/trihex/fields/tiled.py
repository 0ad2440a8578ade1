"""Tiled fields: the N-scheme of an area larger than memory, in a file, tile by tile until no border changes."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable, Iterable
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from dataclasses import dataclass
from heapq import heappop, heappush
from operator import index
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.areas import CORNERS, Tessellation, tessellation_from
from trihex.errors import FormatError, ScenarioError, check_choice, check_path, check_whole
from trihex.fields.tile import SUFFIXES, Ground, Neighbour, open_cells, settle_tile
from trihex.files import check_output
from trihex.kernels.codes import NOT_REACHED
from trihex.record import Record

Progress = Callable[[int, int], None]
TILE_SIDE = 2048
_VISITED, _AWAKE = 1, 2  # bits of a tile in the journal


@dataclass(frozen=True, eq=False)
class TiledField(Record):
    """An N-scheme in a file.

    Parameters
    ----------
    path : Path
        int32 of shape (height, width), as `NScheme.distance`.
    shape : (int, int)
    tile_count : int
    visit_count : int
        How many times a tile was settled in this run.
    """

    path: Path
    shape: tuple[int, int]
    tile_count: int
    visit_count: int


def make_tiled_field(
    area: str | os.PathLike[str],
    destinations: Iterable[tuple[int, int]],
    out: str | os.PathLike[str],
    tessellation: Tessellation | str = "hexagonal",
    *,
    corners: str = "allow",
    side: int = TILE_SIDE,
    executor: Executor | None = None,
    workers: int = 1,
    progress: Progress | None = None,
) -> TiledField:
    """Compute the N-scheme of an area in a file, into a file, with the memory of a few tiles.

    The automaton is local: a tile is settled to the fixed point that its halo allows, and whichever neighbour can be
    lowered through it is woken, the nearest to a destination first, until all sleep. The result is that of
    `make_n_scheme`, cell by cell. Beside `out` lie ``out.part`` and a journal ``out.tiles`` until it is done; after a
    kill at any moment the same call goes on.

    Parameters
    ----------
    area : path
        .npy or .zarr, shape (height, width): booleans or whole numbers, 0 where a cell is free.
    destinations : sequence of (x, y)
    out : path
        .npy or .zarr.
    tessellation : Tessellation or str
    corners : str
        As in `Scenario`.
    side : int
        Cells along a tile, even. A worker needs about 20 bytes for each cell of a tile.
    executor : concurrent.futures.Executor, optional
        Where tiles are settled: a pool of processes or threads, or ``dask.distributed.Client.get_executor()``. All
        must see the same files. Default: in this process.
    workers : int
        How many tiles are under way at once, with an `executor`.
    progress : callable, optional
        Called with (tiles that are visited and asleep, tiles).

    Raises
    ------
    ScenarioError
        If a destination lies outside or on a barrier, or a rule does not exist.
    FormatError
        If `area` is no such array, or what lies beside `out` is the beginning of another field.
    """
    tessellation = tessellation_from(tessellation)
    check_choice("corners", corners, CORNERS, ScenarioError)
    check_path(area, "area")
    check_path(out, "out")
    check_whole("side of a tile", side, 2, None, ScenarioError)
    if side % 2:
        raise ScenarioError(f"side of a tile must be an even number from 2 on, not {side}")
    area, out = Path(area), Path(out)
    check_choice(f"{out}: the suffix of a field", out.suffix.lower(), SUFFIXES, FormatError)
    cells = open_cells(area)
    places = _checked(cells, destinations)
    part = out.with_name(out.name + ".part")
    ground = Ground(os.fspath(area.resolve()), os.fspath(part.resolve()), tessellation, corners, places, side)
    journal = _Journal(ground, area, cells.shape, out.with_name(out.name + ".tiles"))
    if journal.is_new:
        check_output(part)
        _make_file(part, cells.shape, side)
    del cells
    visits = _settle_all(ground, journal, executor, workers, progress)
    _blank(ground, journal)
    if out.is_dir():
        shutil.rmtree(out)
    os.replace(part, out)
    journal.path.unlink()
    return TiledField(out, journal.shape, journal.state.size, visits)


def _checked(cells: Any, destinations: Iterable[tuple[int, int]]) -> tuple[tuple[int, int], ...]:
    """Return the destinations if they are free cells."""
    height, width = cells.shape
    try:
        places = tuple((index(x), index(y)) for x, y in _pairs(destinations))
    except (TypeError, ValueError):
        raise ScenarioError(f"destinations must be pairs of integers (x, y), not {destinations!r:.80}") from None
    if not places:
        raise ScenarioError("destinations must name at least one cell")
    for number, (x, y) in enumerate(places):
        if not (0 <= x < width and 0 <= y < height):
            where = f"x is 0..{width - 1}, y is 0..{height - 1}"
            raise ScenarioError(f"destination {number}: cell ({x}, {y}) lies outside the area: {where}")
        if cells[y, x]:
            raise ScenarioError(f"destination {number} must stand on a free cell; ({x}, {y}) is a barrier")
    return places


def _pairs(places: Any) -> Any:
    """Return `places`, or one place (x, y) as the only one."""
    is_pair = isinstance(places, tuple) and len(places) == 2 and all(hasattr(one, "__index__") for one in places)
    return [places] if is_pair else places


def _make_file(path: Path, shape: tuple[int, int], side: int) -> None:
    """Make the file of a field; where nothing is written yet it takes no room on most disks."""
    if ".zarr" in path.suffixes:
        import zarr

        zarr.create_array(path, shape=shape, chunks=(side, side), dtype="int32", fill_value=NOT_REACHED, overwrite=True)
    else:
        np.lib.format.open_memmap(path, mode="w+", dtype=np.int32, shape=shape)


class _Journal:
    """What was done so far, a byte for each tile in a file: killed at any moment, no work is lost that matters.

    A tile that is being settled is not visited in the file, and awake: were it torn, it would be solved afresh.
    """

    def __init__(self, ground: Ground, area: Path, shape: tuple[int, int], path: Path) -> None:
        self.path, self.shape = path, (int(shape[0]), int(shape[1]))
        self.rows, self.columns = (-(-length // ground.side) for length in self.shape)
        status = area.stat()
        known = {"shape": self.shape, "bytes": status.st_size, "changed": status.st_mtime_ns, "side": ground.side}
        kind = ground.tessellation
        known |= {"tessellation": kind.name, "neighbourhood": kind.neighbourhood, "costs": kind.costs}
        known |= {"corners": ground.corners, "destinations": ground.destinations}
        known |= {"clock": kind.clock} if kind.clock != "steps" else {}  # which came later
        head = json.dumps(known).encode() + b"\n"
        self.offset, count = len(head), self.rows * self.columns
        self.is_new = not (path.exists() and Path(ground.distance).exists())
        if self.is_new:
            self.state = np.zeros(count, dtype=np.uint8)
            for x, y in ground.destinations:
                self.state[y // ground.side * self.columns + x // ground.side] = _AWAKE
            self.fresh = head + self.state.tobytes()
        else:
            content = path.read_bytes()
            if content[: len(head)] != head or len(content) != len(head) + count:
                raise FormatError(f"{path}: is of another field; remove it and {ground.distance} to begin this one")
            self.state = np.frombuffer(content[len(head) :], dtype=np.uint8).copy()

    def open(self) -> Any:
        """Return the file to write to, begun if there is none."""
        if self.is_new:
            self.path.write_bytes(self.fresh)
        return open(self.path, "r+b", buffering=0)

    def note(self, file: Any, tile: int, state: int) -> None:
        """Write down the state of a tile."""
        self.state[tile] = state
        os.pwrite(file.fileno(), bytes([state]), self.offset + tile)

    def visited_around(self, visited: NDArray[np.bool_], tile: int) -> NDArray[np.bool_]:
        """Return which of the tiles around one, itself in the middle, are visited."""
        row, column = divmod(tile, self.columns)
        padded = np.zeros((3, 3), dtype=bool)
        table = visited.reshape(self.rows, self.columns)
        for south in range(max(row - 1, 0), min(row + 2, self.rows)):
            for east in range(max(column - 1, 0), min(column + 2, self.columns)):
                padded[south - row + 1, east - column + 1] = table[south, east]
        return padded


def _settle_all(
    ground: Ground, journal: _Journal, executor: Executor | None, workers: int, progress: Progress | None
) -> int:
    """Settle tiles until all sleep; return how often one was settled."""
    visited = (journal.state & _VISITED).astype(bool)
    awake = {int(tile): 0 for tile in np.flatnonzero(journal.state & _AWAKE)}  # with the least value that woke it
    queue = [(0, tile) for tile in awake]
    under_way: dict[Future[dict[Neighbour, int]], int] = {}
    visits = 0
    with journal.open() as file:
        while awake or under_way:
            busy = set(under_way.values())
            held = []
            while queue and len(under_way) < max(workers, 1):
                value, tile = heappop(queue)
                if awake.get(tile) != value:
                    continue  # it was woken by a lower value since, or settled
                if tile in busy:
                    held.append((value, tile))
                    continue
                del awake[tile]
                busy.add(tile)
                journal.note(file, tile, _AWAKE)
                task = (ground, *divmod(tile, journal.columns), journal.visited_around(visited, tile))
                under_way[_submit(executor, task)] = tile
            for entry in held:
                heappush(queue, entry)
            done = next(iter(wait(under_way, return_when=FIRST_COMPLETED).done))
            tile = under_way.pop(done)
            woken = done.result()
            visits, visited[tile] = visits + 1, True
            for (south, east), value in woken.items():
                other = tile + south * journal.columns + east
                if value < awake.get(other, NOT_REACHED):
                    awake[other] = value
                    heappush(queue, (value, other))
                    if other not in under_way.values():
                        journal.note(file, other, int(journal.state[other]) | _AWAKE)
            journal.note(file, tile, _VISITED | (_AWAKE if tile in awake else 0))
            if progress is not None:
                progress(int(visited.sum()) - sum(bool(visited[t]) for t in awake), visited.size)
    return visits


def _submit(executor: Executor | None, task: tuple[Any, ...]) -> Future[dict[Neighbour, int]]:
    """Return the future of a tile; without an executor it is settled here and now."""
    if executor is not None:
        return executor.submit(settle_tile, *task)
    future: Future[dict[Neighbour, int]] = Future()
    future.set_result(settle_tile(*task))
    return future


def _blank(ground: Ground, journal: _Journal) -> None:
    """Write `NOT_REACHED` to tiles that were never woken."""
    field = open_cells(ground.distance, "r+")
    for tile in np.flatnonzero(~journal.state & _VISITED):
        row, column = divmod(int(tile), journal.columns)
        rows = slice(row * ground.side, (row + 1) * ground.side)
        field[rows, column * ground.side : (column + 1) * ground.side] = NOT_REACHED
