"""Gates: how soon the robots can arrive at best, if they hinder each other at a few chosen nodes only."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.bounds.cuts import Crowd
from trihex.record import Record

_BUDGET = 10_000_000


@dataclass(frozen=True, eq=False)
class GateNetwork(Record):
    """Gates, the steps between them, and the steps from the robots to them, on ways that pass no other gate.

    Robots of a crowd that can arrive without passing any gate belong to `free_steps`, the others to the lists.

    Parameters
    ----------
    steps_out : int32 array, shape (gates,)
        Least number of steps from being in a gate to arriving; -1 where each way out passes another gate.
    first_arc, arc_gate, arc_steps : arrays
        Gate g is entered from gate ``arc_gate[a]`` no sooner than ``arc_steps[a]`` steps later, for a in
        ``first_arc[g]:first_arc[g + 1]``.
    first_robot, robot, robot_steps : arrays
        Likewise by robots after their start, the nearest first.
    robot_count : int
        Number of robots in the lists.
    free_steps : int64 array
        Least number of steps of each robot that passes no gate.
    """

    steps_out: NDArray[np.int32]
    first_arc: NDArray[np.int64]
    arc_gate: NDArray[np.int32]
    arc_steps: NDArray[np.int32]
    first_robot: NDArray[np.int64]
    robot: NDArray[np.int32]
    robot_steps: NDArray[np.int32]
    robot_count: int
    free_steps: NDArray[np.int64]


def make_gate_network(crowd: Crowd, nodes: NDArray[np.int32]) -> GateNetwork:
    """Measure the ways between `nodes`, the robots and the destinations; one search in breadth for each gate."""
    return _Survey(crowd, np.unique(nodes)).network()


class _Survey:
    """The searches of `make_gate_network`, which share their arrays."""

    def __init__(self, crowd: Crowd, nodes: NDArray[np.int32]) -> None:
        self.crowd, self.nodes = crowd, nodes
        scenario, size = crowd.scenario, crowd.scenario.area.layout.size
        capacity = scenario.destination_capacity or 1
        # Only a destination passes more than one robot: it stands in the list once for each of them.
        self.is_destination = np.zeros(nodes.size, dtype=bool)
        self.is_destination[nodes < size] = crowd.is_destination[nodes[nodes < size]]
        self.copies = np.where(self.is_destination, capacity, 1)
        self.gate_of_node = np.full(crowd.node_count, -1, dtype=np.int32)
        self.gate_of_node[nodes] = np.arange(nodes.size)
        self.robot_at = np.full(crowd.node_count, -1, dtype=np.int32)
        self.robot_at[crowd.sites] = np.arange(crowd.sites.size)
        self.is_special = (self.gate_of_node >= 0) | (self.robot_at >= 0)
        self.is_special[:size] |= crowd.is_destination
        self.steps = np.full(crowd.node_count, -1, dtype=np.int32)
        self.queue = np.empty(crowd.node_count, dtype=np.int32)
        self.near_gate, self.gate_steps = np.empty((2, nodes.size), dtype=np.int32)
        self.near_robot, self.robot_steps = np.empty((2, crowd.sites.size), dtype=np.int32)

    def look(self, gate: int, starts: NDArray[np.int32]) -> tuple[list[NDArray[np.int32]], int]:
        """Return what lies around: gates and steps, robots and steps; and the steps to a destination (-1: none)."""
        from trihex.bounds.kernels import gates as kernels

        scenario, layout = self.crowd.scenario, self.crowd.scenario.area.layout
        count = np.zeros(3, dtype=np.int64)
        kernels.steps_from_gate(
            gate,
            starts,
            scenario.moves,
            layout.offset_of_direction,
            layout.vertex_of_direction,
            scenario.area.tessellation.edge_count,
            self.crowd.has_vertices,
            self.is_special,
            self.crowd.is_destination,
            self.gate_of_node,
            self.robot_at,
            self.steps,
            self.queue,
            self.near_gate,
            self.gate_steps,
            self.near_robot,
            self.robot_steps,
            count,
        )
        gates, robots = slice(int(count[0])), slice(int(count[1]))
        lists = [self.near_gate[gates], self.gate_steps[gates], self.near_robot[robots], self.robot_steps[robots]]
        return [part.copy() for part in lists], int(count[2])

    def network(self) -> GateNetwork:
        """Look around from the destinations, then from every gate."""
        crowd, size = self.crowd, self.crowd.scenario.area.layout.size
        (_, _, free, _), _ = self.look(
            -1, np.flatnonzero(crowd.is_destination & (self.gate_of_node[:size] < 0)).astype(np.int32)
        )
        self.robot_at[crowd.sites[free]] = -1
        steps_out, arcs, robots = [], [], []
        # The number of the first copy of each gate.
        first_copy = np.cumsum(self.copies) - self.copies
        for gate, node in enumerate(self.nodes.tolist()):
            is_vertex = node >= size
            starts = crowd.sites_around(node - size) if is_vertex else np.array([node], dtype=np.int32)
            (gates, gate_steps, near, robot_steps), out = self.look(gate, starts)
            # A vertex is passed in the step that leads into one of the cells around it, one step after the cell before.
            onto = ~self.is_destination[gates]
            into = gate_steps[onto] + int(is_vertex) - (self.nodes[gates[onto]] >= size)
            for _ in range(self.copies[gate]):
                arcs.append((first_copy[gates[onto]], into))
                robots.append((near, robot_steps + int(is_vertex)))
                steps_out.append(0 if self.is_destination[gate] else out)
        return GateNetwork(
            np.array(steps_out, dtype=np.int32),
            *_chained(arcs),
            *_chained(robots),
            crowd.sites.size - free.size,
            np.sort(crowd.steps[free]),
        )


def _chained(
    lists: list[tuple[NDArray[Any], NDArray[Any]]],
) -> tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.int32]]:
    """Return where each list begins in the concatenation of all, and that concatenation."""
    first = np.cumsum([0, *(len(one) for one, _ in lists)], dtype=np.int64)
    empty = np.empty(0, dtype=np.int32)
    one = np.concatenate([empty, *(one for one, _ in lists)]).astype(np.int32)
    other = np.concatenate([empty, *(other for _, other in lists)]).astype(np.int32)
    return first, one, other


def least_arrivals(
    crowd: Crowd,
    network: GateNetwork,
    horizon: int,
    most_looks: int,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[int, int, int]:
    """Return (steps of all robots served, number of them, last step looked at): the most that can arrive that soon.

    Robots without a gate on their way are among them. All are served if `horizon` and `most_looks` allow.
    """
    from trihex.bounds.kernels import gates as kernels

    gates, width = network.steps_out.size, horizon + 1
    slots = gates * width
    state = np.zeros(5, dtype=np.int64)
    is_used = np.zeros(slots, dtype=bool)
    onward, seen_in, seen_out = np.full(slots, -1, dtype=np.int32), *np.zeros((2, slots), dtype=np.int32)
    first_slot = np.full(crowd.sites.size, -1, dtype=np.int32)
    reach, dead_reach = np.full((2, gates), -1, dtype=np.int32)
    next_robot, dead_robot, next_unserved = (network.first_robot[:-1].copy() for _ in range(3))
    node, parent, changed, stack = np.empty((4, 2 * slots + 1), dtype=np.int32)
    way = np.empty(2 * slots + 1, dtype=np.uint8)
    looks = 0
    while state[kernels.SERVED] < network.robot_count and state[kernels.STEP] + 1 < width and looks < most_looks:
        kernels.arrive(
            network.steps_out,
            network.first_arc,
            network.arc_gate,
            network.arc_steps,
            network.first_robot,
            network.robot,
            network.robot_steps,
            network.robot_count,
            width,
            is_used,
            onward,
            seen_in,
            seen_out,
            first_slot,
            reach,
            next_robot,
            dead_reach,
            dead_robot,
            next_unserved,
            node,
            parent,
            way,
            changed,
            stack,
            state,
            min(_BUDGET, most_looks - looks),
        )
        looks = int(state[kernels.WORK])
        if progress is not None:
            progress(int(state[kernels.SERVED]), network.robot_count)
    served, total = int(state[kernels.SERVED]), int(state[kernels.TOTAL])
    return total + int(network.free_steps.sum()), served + network.free_steps.size, int(state[kernels.STEP])
