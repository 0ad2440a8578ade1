"""A judge that draws every cell and looks at the corners of the polygons; slow, and for small areas."""

from collections import defaultdict
from functools import cache
from math import atan2, ceil

import numpy as np

from tests.oracles.doors import Openings
from trihex.kernels.codes import JUMP, WAIT


@cache
def drawn(tessellation_name, height, width):
    """Corners of each cell of the area and of a margin around it, and the cells around each corner."""
    from trihex import Tessellation

    tessellation = Tessellation(tessellation_name)
    corners, cells = {}, defaultdict(list)
    for x in range(-3, width + 3):
        for y in range(-2, height + 2):
            corners[x, y] = {tuple(np.round(c * 1e4).astype(int).tolist()) for c in tessellation.polygon_of_cell(x, y)}
            for corner in corners[x, y]:
                cells[corner].append((x, y))
    return corners, cells


class Rules:
    """The rules of a scenario, answered from the drawing; cells are pairs (x, y)."""

    def __init__(self, scenario):
        self.scenario, self.area = scenario, scenario.area
        self.corners, self.cells = drawn(self.area.tessellation.name, self.area.height, self.area.width)

    def is_inside(self, cell):
        return 0 <= cell[0] < self.area.width and 0 <= cell[1] < self.area.height

    def is_blocked(self, cell):
        return not self.is_inside(cell) or bool(self.area.barriers[cell[1], cell[0]])

    def vertex(self, start, end):
        """The corner that two cells share, None if they share an edge."""
        shared = self.corners[start] & self.corners[end]
        assert 1 <= len(shared) <= 2
        return min(shared) if len(shared) == 1 else None

    def is_corner_open(self, start, end):
        vertex = self.vertex(start, end)
        if vertex is None or self.scenario.corners == "allow":
            return True
        centre = {c: np.mean(list(self.corners[c]), axis=0) - vertex for c in self.cells[vertex]}
        ring = sorted(self.cells[vertex], key=lambda c: atan2(centre[c][1], centre[c][0]))
        ring = ring[ring.index(start) :] + ring[: ring.index(start)]
        one_way, other_way = ring[1 : ring.index(end)], ring[ring.index(end) + 1 :]
        if self.scenario.corners == "no-cut":
            return not any(map(self.is_blocked, one_way + other_way))
        return not any(map(self.is_blocked, one_way)) or not any(map(self.is_blocked, other_way))

    def neighbours(self, cell):
        """Each cell that a robot may move to from `cell`, with the cost of the move."""
        tessellation = self.area.tessellation
        for other in {c for corner in self.corners[cell] for c in self.cells[corner]} - {cell}:
            if self.is_blocked(other) or not self.is_corner_open(cell, other):
                continue
            if self.vertex(cell, other) is None:
                yield other, tessellation.edge_cost
            elif tessellation.neighbourhood == "full":
                (x0, y0), (x1, y1) = (np.ravel(tessellation.centre_of_cell(*c)) for c in (cell, other))
                length = np.hypot(x1[0] - x0[0], y1[0] - y0[0]) if np.ndim(x0) else np.hypot(x1 - x0, y1 - y0)
                yield other, 14 if tessellation.costs == "paper" else round(1000 * float(length))

    def places(self, cells):
        x, y = self.area.cell_to_xy(cells)
        return list(zip(x.tolist(), y.tolist(), strict=True))

    def reachable(self):
        """All cells from which a lone robot gets to a destination."""
        seen = set(self.places(self.scenario.destinations))
        stack = list(seen)
        while stack:
            for other, _ in self.neighbours(stack.pop()):
                if other not in seen:
                    seen.add(other)
                    stack.append(other)
        return seen


def judge(plan):
    """All conflicts of `plan`, as a sorted list of (kind, step, robots, cells)."""
    scenario, rules = plan.scenario, Rules(plan.scenario)
    tessellation, destinations = scenario.area.tessellation, set(rules.places(scenario.destinations))
    own = [plan.actions[a:b].tolist() for a, b in zip(plan.first_action, plan.first_action[1:], strict=False)]
    jumps = {at: rules.places(np.array([to]))[0] for at, to in plan.jumps.tolist()}
    place, openings = dict(enumerate(rules.places(scenario.robots))), Openings(scenario)
    start, parked_since, conflicts = dict(place), {}, []
    for r, own_start in enumerate(scenario.start_times.tolist()):
        early = [step for step, action in enumerate(own[r], 1) if action != WAIT and step <= own_start]
        if early and place[r] not in destinations:
            conflicts.append(("start", early[0], (r,), (place[r],)))
    for r in list(place):
        if place[r] in destinations:
            if own[r]:
                conflicts.append(("arrival", 0, (r,), (place[r],)))
            del place[r]
        elif not own[r]:
            parked_since[r] = 0
    for step in range(1, plan.steps + 1):
        before, passing, entering = dict(place), {}, defaultdict(list)
        acting = [r for r in sorted(place) if r not in parked_since]
        for r in acting:
            action = own[r][step - 1]
            at = place[r]
            to = at
            if action == JUMP:
                to = jumps[int(plan.first_action[r]) + step - 1]
                conflicts.append(("jump", step, (r,), (at, to)))
            elif action != WAIT:
                side = int(tessellation.orientation_of_cell(*at))
                dx, dy = tessellation.step_of_direction[side, action].tolist()
                to = (at[0] + dx, at[1] + dy)
            if not rules.is_inside(to):
                conflicts.append(("barrier", step, (r,), (at,)))
                del place[r]
                continue
            if action != WAIT and rules.is_blocked(to):
                conflicts.append(("barrier", step, (r,), (at, to)))
            if action < JUMP:
                if rules.vertex(at, to) is not None:
                    passing[r] = (rules.vertex(at, to), at, to)
                if not rules.is_blocked(to) and not rules.is_corner_open(at, to):
                    conflicts.append(("corner", step, (r,), (at, to)))
            if to != at and to not in destinations and openings(to, step) == 0:
                conflicts.append(("capacity", step, (r,), (to,)))
            place[r] = to
            if to in destinations:
                entering[to].append(r)
                if len(own[r]) > step:
                    conflicts.append(("arrival", step, (r,), (to,)))
        if scenario.crossing == "forbid":
            for r, (vertex, *ways) in passing.items():
                first = min(q for q in passing if passing[q][0] == vertex)
                if first != r:
                    conflicts.append(("crossing", step, (first, r), (*passing[first][1:], *ways)))
        for cell, robots in entering.items():
            limits = [openings(cell, step), ceil(scenario.destination_capacity or len(robots))]
            for r in robots[min(limit for limit in limits if limit is not None) :]:
                conflicts.append(("capacity", step, (r,), (cell,)))
            for r in robots:
                del place[r]
        holders = {}
        for r in sorted(place, key=lambda r: (parked_since.get(r, step), r)):
            holders.setdefault(place[r], r)
        for r in acting:
            if r in place and holders[place[r]] != r:
                holder = holders[place[r]]
                conflicts.append(("cell", step, tuple(sorted((r, holder))), (place[r],)))
        for r in acting:
            now = place.get(r)
            left, holder = before[r], holders.get(before[r])
            if now is not None and now != left and holder is not None and holder < r and before[holder] == now:
                if holder not in parked_since:
                    conflicts.append(("exchange", step, (holder, r), (now, left)))
        for r in acting:
            if r in place and len(own[r]) == step:
                parked_since[r] = step
    if parked_since:
        reachable = rules.reachable()
        for r, step in parked_since.items():
            if start[r] in reachable:
                conflicts.append(("arrival", step, (r,), (place[r],)))
    return sorted(conflicts)
