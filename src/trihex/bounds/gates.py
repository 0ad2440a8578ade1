"""Gates: a few chosen nodes, and how far apart they are, in ticks (steps where the clock is "steps")."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from trihex.bounds.demand import Demand
from trihex.record import Record

if TYPE_CHECKING:
    from trihex.bounds.kernels.nodes import NodeGraph


@dataclass(frozen=True, eq=False)
class GateNetwork(Record):
    """Gates, the steps between them, and the steps from the robots to them, on ways that pass no other gate.

    Robots that can arrive without passing any gate belong to `free_steps`, the others to the lists.

    Parameters
    ----------
    site, copy : int32 arrays, shape (gates,)
        The site that each gate is (-1: a lattice vertex), and which of its copies, from 0.
    gap : int32 array, shape (gates,)
        How many ticks there are at least between two robots that pass a gate.
    steps_out : int32 array, shape (gates,)
        Least number of ticks from being in a gate to arriving; -1 where each way out passes another gate.
    first_arc, arc_gate, arc_steps : arrays
        Gate g is entered from gate ``arc_gate[a]`` no sooner than ``arc_steps[a]`` steps later, for a in
        ``first_arc[g]:first_arc[g + 1]``.
    first_robot, robot, robot_steps : arrays
        Likewise by robots after step 0, the earliest first.
    robot_count : int
        Number of robots in the lists.
    free_steps : int64 array
        Least number of ticks of each robot that passes no gate.
    """

    site: NDArray[np.int32]
    copy: NDArray[np.int32]
    gap: NDArray[np.int32]
    steps_out: NDArray[np.int32]
    first_arc: NDArray[np.int64]
    arc_gate: NDArray[np.int32]
    arc_steps: NDArray[np.int32]
    first_robot: NDArray[np.int64]
    robot: NDArray[np.int32]
    robot_steps: NDArray[np.int32]
    robot_count: int
    free_steps: NDArray[np.int64]


def make_gate_network(demand: Demand, nodes: NDArray[np.int32]) -> GateNetwork:
    """Measure the ways between `nodes`, the robots and the destinations; one search in breadth for each gate."""
    return Survey(demand, np.unique(nodes)).network()


def robots_past(demand: Demand, nodes: NDArray[np.int32]) -> NDArray[np.bool_]:
    """Tell of each robot whether it can only arrive past one of `nodes`, or starts there."""
    return Survey(demand, np.unique(nodes)).robots_past()


class Survey:
    """Searches around gates or destinations, which share their arrays.

    Parameters
    ----------
    demand : Demand
    nodes : int32 array
        The gates.
    graph : NodeGraph, optional
        With other durations, and other `steps` to the nearest destination, than those of the nodes.
    detour : int, optional
        How much longer than to the nearest destination the way may be.
    """

    def __init__(
        self, demand: Demand, nodes: NDArray[np.int32], graph: NodeGraph | None = None, detour: int = 2**30
    ) -> None:
        from trihex.bounds.kernels.gates import Landmarks, Surroundings
        from trihex.kernels.signatures import given

        self.graph = demand.nodes.graph if graph is None else graph
        lines = np.unique(self.graph.duration).size
        self.demand, self.nodes = demand, nodes
        size, count = demand.scenario.area.layout.size, demand.nodes.count
        # Only a destination passes more than one robot: it stands in the list once for each of them.
        self.is_destination = np.zeros(nodes.size, dtype=bool)
        self.is_destination[nodes < size] = demand.nodes.is_destination[nodes[nodes < size]]
        self.copies = demand.nodes.places(nodes)
        self.gate_of_node = np.full(count, -1, dtype=np.int32)
        self.gate_of_node[nodes] = np.arange(nodes.size)
        self.robot_at = np.full(count, -1, dtype=np.int32)
        self.robot_at[demand.sites] = np.arange(demand.sites.size)
        is_special = (self.gate_of_node >= 0) | (self.robot_at >= 0)
        is_special[:size] |= demand.nodes.is_destination
        self.landmarks = given(Landmarks, is_special=is_special, gate_of_node=self.gate_of_node, robot_at=self.robot_at)
        near_gate, gate_steps = np.empty((2, nodes.size), dtype=np.int32)
        near_robot, robot_steps = np.empty((2, demand.sites.size), dtype=np.int32)
        self.found = Surroundings(
            near_gate=near_gate,
            gate_steps=gate_steps,
            near_robot=near_robot,
            robot_steps=robot_steps,
            count=np.zeros(3, dtype=np.int64),
            steps=np.full(count, -1, dtype=np.int32),
            queue=np.empty(lines * count, dtype=np.int32),
            when=np.empty(lines * count, dtype=np.int32),
            head=np.zeros(lines, dtype=np.int64),
            tail=np.zeros(lines, dtype=np.int64),
            detour=detour,
        )

    def look(self, gate: int, starts: NDArray[np.int32]) -> tuple[list[NDArray[np.int32]], int]:
        """Return what lies around: gates and steps, robots and steps; and the steps to a destination (-1: none)."""
        from trihex.bounds.kernels import gates as kernels

        found = self.found
        kernels.look_around(gate, starts, self.graph, self.landmarks, found)
        gates, robots, out = found.count.tolist()
        near = [found.near_gate[:gates], found.gate_steps[:gates]]
        near += [found.near_robot[:robots], found.robot_steps[:robots]]
        return [part.copy() for part in near], out

    @property
    def visits(self) -> int:
        """How many nodes the last search has come to."""
        found = self.found
        return int((found.tail - np.arange(found.tail.size) * found.steps.size).sum())

    def robots_past(self) -> NDArray[np.bool_]:
        """Tell of each robot whether it cannot arrive without passing a gate."""
        is_past = np.ones(self.demand.sites.size, dtype=bool)
        is_past[self._free()] = False
        return is_past

    def _free(self) -> NDArray[np.int32]:
        """Return the robots that can arrive without passing a gate."""
        size = self.demand.scenario.area.layout.size
        is_start = self.demand.nodes.is_destination & (self.gate_of_node[:size] < 0)
        (_, _, free, _), _ = self.look(-1, np.flatnonzero(is_start).astype(np.int32))
        return np.asarray(free)

    def network(self) -> GateNetwork:
        """Look around from the destinations, then from every gate."""
        demand, size = self.demand, self.demand.scenario.area.layout.size
        free = self._free()
        self.robot_at[demand.sites[free]] = -1
        steps_out, arcs, robots = [], [], []
        # The number of the first copy of each gate.
        first_copy = np.cumsum(self.copies) - self.copies
        for gate, node in enumerate(self.nodes.tolist()):
            is_vertex = node >= size
            through = demand.nodes.vertex_duration if is_vertex else 0
            starts = demand.nodes.sites_around(node - size) if is_vertex else np.array([node], dtype=np.int32)
            (gates, gate_steps, near, robot_steps), out = self.look(gate, starts)
            # A vertex is passed when a robot comes into one of the cells around it, a move after the cell before.
            onto = ~self.is_destination[gates]
            into = gate_steps[onto] + through
            into[self.nodes[gates[onto]] >= size] -= demand.nodes.vertex_duration
            when = robot_steps + through + demand.start_times[near]
            order = np.argsort(when, kind="stable")
            for _ in range(self.copies[gate]):
                arcs.append((first_copy[gates[onto]], into))
                robots.append((near[order], when[order]))
                steps_out.append(0 if self.is_destination[gate] else out)
        site = np.where(self.nodes < size, self.nodes, -1).astype(np.int32)
        copy = np.arange(self.copies.sum()) - np.repeat(first_copy, self.copies)
        return GateNetwork(
            np.repeat(site, self.copies),
            copy.astype(np.int32),
            demand.nodes.headways(self.nodes).astype(np.int32),
            np.array(steps_out, dtype=np.int32),
            *_chained(arcs),
            *_chained(robots),
            demand.sites.size - free.size,
            np.sort(demand.steps[free]),
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
