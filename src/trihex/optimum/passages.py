"""Passages: the lattice vertices that one robot passes in a step, and what it costs to enter and to leave them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario


@dataclass(frozen=True)
class Passages:
    """Ways between cells and lattice vertices: one each for a cell and a vertex that robots pass to or from there.

    Serves every corner rule: of two cells around a vertex that both have an open move through it, any two have one
    between them, unless they share an edge. For "no-squeeze" that is so because such cells belong to one run of three
    or more free cells, and no second such run has room around the vertex.

    Parameters
    ----------
    site, vertex : ndarray of int64
        Site of the cell, and place of the vertex in `vertices`; ascending.
    enter, leave : ndarray of int64
        What it costs to enter the vertex from the cell, and to leave it into the cell. Both together cost as much as
        the move; or less, where a vertex serves moves of several costs, but never so little that anybody came to a
        destination for less than the distance.
    vertices : ndarray of int64
        Numbers of the lattice vertices, ascending.
    distance : ndarray of int64
        Least cost to a destination of each of them; no more than that where they serve moves of several costs.
    """

    site: NDArray[np.int64]
    vertex: NDArray[np.int64]
    enter: NDArray[np.int64]
    leave: NDArray[np.int64]
    vertices: NDArray[np.int64]
    distance: NDArray[np.int64]


def make_passages(
    scenario: Scenario,
    sites: NDArray[np.int64],
    distance_of_site: NDArray[np.int32],
    cost_of_direction: NDArray[np.int64],
) -> Passages:
    """Find the passages from `sites`, all from which a destination can be reached."""
    own, vertex, target, cost = _moves_through_vertices(scenario, sites, cost_of_direction).T
    size = scenario.area.layout.size
    key, first = np.unique(own * size + vertex, return_inverse=True)
    last = np.searchsorted(key, target * size + vertex)
    site = key // size
    vertices, place = np.unique(key % size, return_inverse=True)
    away = distance_of_site[site].astype(np.int64)
    nearest = _least(vertices.size, place, away)
    # Whoever enters pays for the move, but may go by another that costs more to the nearest cell around; then entering
    # costs at least what it brings, and those who leave get back what nobody could save.
    enter = np.maximum(_least(site.size, first, cost), away - nearest[place])
    leave = _least(site.size, last, cost - enter[first])
    refund = np.maximum(-_least(vertices.size, place, leave), 0)
    return Passages(site, place, enter - refund[place], leave + refund[place], vertices, nearest + refund)


def _moves_through_vertices(
    scenario: Scenario, sites: NDArray[np.int64], cost_of_direction: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Return rows (site, lattice vertex, target, cost) of the moves that pass a vertex which others may not."""
    layout = scenario.area.layout
    rows = [np.empty((0, 4), dtype=np.int64)]
    for k in range(scenario.first_vertex_move, cost_of_direction.size):
        own = sites[(scenario.moves[sites] >> k & 1).astype(bool)]
        vertex = own + layout.vertex_of_direction[own & 1, k]
        target = own + layout.offset_of_direction[own & 1, k]
        rows.append(np.stack([own, vertex, target, np.full(own.size, cost_of_direction[k])], axis=1))
    return np.concatenate(rows)


def _least(size: int, place: NDArray[np.int64], values: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the least of the values at each place."""
    least = np.full(size, np.iinfo(np.int64).max)
    np.minimum.at(least, place, values)
    return least
