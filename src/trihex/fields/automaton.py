"""Automaton: cells that all change at once by one local rule, CA = (N^n, Q, A, f) of section III of the paper."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trihex.areas import Tessellation
from trihex.errors import AutomatonError, check_choice
from trihex.record import Record, read_only

PERIODIC = "periodic"

States = NDArray[np.int64]
Rule = Callable[[States, States], ArrayLike]


class LastGeneration(NamedTuple):
    """The configuration in which a run of an automaton ended, and the number of that generation."""

    configuration: States
    number: int


@dataclass(frozen=True, eq=False)
class CellularAutomaton(Record):
    """A cellular automaton (N^n, Q, A, f) in n = 1, 2 or 3 dimensions; any local rule f that numpy can express.

    Parameters
    ----------
    neighbourhood : Tessellation, its name, or array_like of int
        A, the cells that a cell looks at. A tessellation stands for its neighbours in the order of its directions.
        Otherwise offsets: whole numbers dx (n = 1), pairs (dx, dy) or triples (dx, dy, dz). Two such lists, of shape
        (2, len(A), 2), are the offsets for the two orientations of the cells of `tessellation`. The cell itself need
        not be listed: f is always given its state. Kept as int64, shape (1 or 2, len(A), n).
    states : int or iterable of int
        Q, the states a cell may take; a number q stands for 0..q-1. Every configuration is checked against it.
    rule : callable
        f, called as ``rule(own, neighbours)`` for all cells at once: `own` holds the state of each cell (int64, the
        shape of the configuration, read-only), ``neighbours[k]`` the state of its neighbour number k (int64, shape
        (len(A), ...), free to be overwritten). It returns the next state of each cell: whole numbers or booleans, in
        the shape of `own`.
    boundary : int or "periodic"
        The state of everything outside of the configuration, or "periodic": what leaves it on one side comes back on
        the other. Default: 0.
    tessellation : Tessellation or str, optional
        What gives cells their orientation; needed only beside two lists of offsets.

    Raises
    ------
    AutomatonError
        If the neighbourhood, the states or the boundary make no automaton.

    Notes
    -----
    Configurations are arrays of n dimensions, indexed [x], [y, x] or [z, y, x]: x is always the last axis.

    Examples
    --------
    Rule 90: a cell becomes the exclusive or of its two neighbours.

    >>> rule_90 = CellularAutomaton([-1, 1], states=2, rule=lambda own, near: near[0] ^ near[1])
    >>> for row in rule_90.generations([0, 0, 0, 0, 1, 0, 0, 0, 0], limit=3):
    ...     print(*row, sep="")
    000010000
    000101000
    001000100
    010101010
    """

    neighbourhood: NDArray[np.int64]
    states: range | tuple[int, ...]
    rule: Rule
    boundary: int | str = 0
    tessellation: Tessellation | None = None

    def __post_init__(self) -> None:
        given: Any = self.neighbourhood
        if isinstance(given, str):
            given = Tessellation(given)
        if isinstance(given, Tessellation):
            self._set("tessellation", given)
            given = given.step_of_direction
        elif isinstance(self.tessellation, str):
            self._set("tessellation", Tessellation(self.tessellation))
        self._set("neighbourhood", read_only(_offsets_from(given, self.tessellation)))
        self._set("states", _states_from(self.states))
        if not callable(self.rule):
            raise AutomatonError(f"rule must be a function of (own, neighbours), not {self.rule!r:.80}")
        if isinstance(self.boundary, str):
            check_choice("boundary", self.boundary, [PERIODIC], AutomatonError)
        elif not _is_whole(self.boundary) or self.boundary not in self.states:
            raise AutomatonError(f"boundary must be {PERIODIC!r} or a state of {self._q}, not {self.boundary!r}")

    @property
    def dimensions(self) -> int:
        """n, the number of dimensions: 1, 2 or 3."""
        return int(self.neighbourhood.shape[2])

    def generations(self, configuration: ArrayLike, limit: int | None = None) -> Iterator[States]:
        """Yield the configurations one by one, generation 0 (the given one) first, as read-only arrays.

        It ends with the last generation that differs from the one before; an automaton that never comes to rest goes
        on for ever unless it is given a `limit`.

        Parameters
        ----------
        configuration : array_like of int or bool, n dimensions
        limit : int, optional
            The number of the last generation to yield.

        Raises
        ------
        AutomatonError
            If the configuration does not fit, or the rule gives something that is no configuration.
        """
        states = self._checked("configuration", configuration)
        if limit is not None and not (_is_whole(limit) and limit >= 0):
            raise AutomatonError(f"limit must be a whole number from 0, not {limit!r}")
        self._check_wrap(states.shape)
        return self._generations(states, limit)

    def run(self, configuration: ArrayLike, limit: int | None = None) -> LastGeneration:
        """Return the last of `generations` and its number; a number below `limit` tells that it came to rest."""
        number, states = deque(enumerate(self.generations(configuration, limit)), maxlen=1).pop()
        return LastGeneration(states, number)

    def next_generation(self, configuration: ArrayLike) -> States:
        """Return the generation after `configuration`, which may be equal to it."""
        states = self._checked("configuration", configuration)
        self._check_wrap(states.shape)
        return self._next(states)

    def _generations(self, states: States, limit: int | None) -> Iterator[States]:
        number = 0
        yield states
        while limit is None or number < limit:
            before, states = states, self._next(states)
            if np.array_equal(before, states):
                return
            number += 1
            yield states

    def _next(self, states: States) -> States:
        return self._checked("what rule returns", self.rule(states, self._neighbours(states)), states.shape)

    def _neighbours(self, states: States) -> States:
        """Return the state of each neighbour of each cell, shape (len(A), *shape of the configuration)."""
        offsets = self.neighbourhood[:, :, ::-1]  # in the order of the axes: x is the last one
        before, after = -offsets.min(axis=(0, 1), initial=0), offsets.max(axis=(0, 1), initial=0)
        margins = list(zip(before.tolist(), after.tolist(), strict=True))
        if self.boundary == PERIODIC:
            padded = np.pad(states, margins, mode="wrap")
        else:
            padded = np.pad(states, margins, constant_values=int(self.boundary))
        neighbours = np.empty((offsets.shape[1], *states.shape), dtype=np.int64)
        is_odd = np.zeros(states.shape, dtype=bool)
        if len(offsets) == 2 and self.tessellation is not None:
            y, x = np.ogrid[: states.shape[0], : states.shape[1]]
            is_odd = self.tessellation.orientation_of_cell(x, y).astype(bool)
        for orientation, steps in enumerate(offsets):
            for k, step in enumerate(steps + before):
                shifted = padded[tuple(slice(i, i + n) for i, n in zip(step, states.shape, strict=True))]
                if orientation == 0:
                    neighbours[k] = shifted
                elif (steps[k] != offsets[0, k]).any():
                    np.copyto(neighbours[k], shifted, where=is_odd)
        return neighbours

    def _check_wrap(self, shape: tuple[int, ...]) -> None:
        """Refuse a periodic boundary at which cells of one orientation would meet their own kind."""
        if self.boundary == PERIODIC and self.tessellation is not None:
            height, width = shape
            at_edges = self.tessellation.orientation_of_cell([0, width, 0], [0, 0, height])
            for side, length, there in (("width", width, at_edges[1]), ("height", height, at_edges[2])):
                if there != at_edges[0]:
                    name = self.tessellation.name
                    raise AutomatonError(f"{side} of a periodic {name} configuration must be even, not {length}")

    @property
    def _q(self) -> str:
        if isinstance(self.states, range):
            return f"{self.states[0]}..{self.states[-1]}"
        return f"{{{', '.join(map(str, self.states))}}}"

    def _checked(self, what: str, given: ArrayLike, shape: tuple[int, ...] | None = None) -> States:
        """Return `given` as a configuration, or raise an error that begins with `what`."""
        try:
            array = np.asarray(given)
        except ValueError:
            raise AutomatonError(f"{what} must be a full array: its rows differ in length") from None
        if array.dtype.kind not in "biu":
            raise AutomatonError(f"{what} must hold whole numbers, not {array.dtype}")
        if shape is not None and array.shape != shape:
            raise AutomatonError(f"{what} must have the shape of the configuration, {shape}, not {array.shape}")
        if array.ndim != self.dimensions or array.size == 0:
            raise AutomatonError(f"{what} must be a filled array of {self.dimensions} dimensions, not {array.shape}")
        if isinstance(self.states, range):
            wrong = (array < self.states[0]) | (array > self.states[-1])
        else:
            wrong = ~np.isin(array, self.states)
        if wrong.any():
            at = np.unravel_index(int(np.argmax(wrong)), wrong.shape)
            cell = tuple(int(i) for i in reversed(at))
            raise AutomatonError(f"{what} must hold states of {self._q}; cell {cell} holds {array[at]}")
        # A copy, so that nobody who holds the caller's array can change a generation that was handed out.
        return read_only(np.array(array, dtype=np.int64, order="C"))


def _is_whole(value: object) -> bool:
    return isinstance(value, int | np.integer) and not isinstance(value, bool)


def _offsets_from(given: Any, tessellation: Tessellation | None) -> NDArray[np.int64]:
    """Return offsets as an array of shape (1 or 2 orientations, len(A), n), or raise an error that names the rule."""
    try:
        array = np.asarray(list(given) if isinstance(given, Iterable) and not isinstance(given, np.ndarray) else given)
    except ValueError:  # ragged
        array = np.empty(0, dtype=object)
    if array.dtype.kind not in "iu" or array.size == 0 or array.ndim not in (1, 2, 3):
        wanted = "a tessellation, its name, or offsets dx, (dx, dy) or (dx, dy, dz)"
        raise AutomatonError(f"neighbourhood must be {wanted}, not {given!r:.80}")
    if array.ndim < 3:
        array = array.reshape(1, len(array), -1)
    orientations, _, dimensions = array.shape
    if dimensions > 3:
        raise AutomatonError(f"neighbourhood must have 1, 2 or 3 dimensions, not {dimensions}")
    if tessellation is not None and dimensions != 2:
        raise AutomatonError(f"neighbourhood must have 2 dimensions on a tessellation, not {dimensions}")
    if orientations > 2 or (orientations == 2 and tessellation is None):
        raise AutomatonError(
            "neighbourhood may be two lists of offsets only beside a tessellation, one per orientation"
        )
    for offsets in array.tolist():
        twice = [offset for i, offset in enumerate(offsets) if offset in offsets[:i]]
        if twice:
            raise AutomatonError(f"neighbourhood must not list an offset twice: {tuple(twice[0])}")
    return np.array(array, dtype=np.int64)


def _states_from(given: Any) -> range | tuple[int, ...]:
    """Return Q as an ascending range if it has no gaps, else as an ascending tuple."""
    if _is_whole(given) and given > 0:
        return range(int(given))
    if isinstance(given, range) and given.step == 1 and len(given):
        return given
    try:
        states = sorted(set(given))
    except TypeError:
        states = []
    if not states or not all(_is_whole(state) and abs(state) < 2**62 for state in states):
        raise AutomatonError(f"states must be a whole number above 0 or a set of whole numbers, not {given!r:.80}")
    if states[-1] - states[0] == len(states) - 1:
        return range(int(states[0]), int(states[-1]) + 1)
    return tuple(int(state) for state in states)
