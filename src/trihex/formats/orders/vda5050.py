"""VDA 5050: order messages for each robot, the first with what it may do at once, the next as others make way."""

from __future__ import annotations

import json
import os
from collections import defaultdict
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from hashlib import sha256
from itertools import pairwise
from typing import Any

from trihex.errors import FormatError
from trihex.files import new_file
from trihex.formats.orders.course import Course

FORMAT = "trihex VDA 5050 orders"
VERSION = "2.1.0"
MANUFACTURER = "trihex"
# A robot's waypoint i is the node of this sequence id; the edge to it comes just before.
_PER_WAYPOINT = 2
_START = datetime(1970, 1, 1, tzinfo=UTC)


def write_vda5050(course: Course, path: str | os.PathLike[str]) -> None:
    """Write all order messages, robot by robot, each with what must have happened before it may be sent.

    Raises
    ------
    AreaError
        If the area has no frame: nodes are in metres.
    FormatError
        If robots wait for each other in a ring.
    """
    plan = course.dependencies.plan
    frame = plan.scenario.area.metres
    if course.dependencies.rings:
        ring = ", ".join(str(robot) for robot in course.dependencies.rings[0][:8, 0].tolist())
        raise FormatError(f"{path}: orders know no common clock, and robots {ring} all move at once; forbid following")
    head = {
        "format": FORMAT,
        "version": 1,
        "robot_radius": frame.robot_radius,
        "sentence": course.dependencies.sentence,
    }
    orders = _Orders(course)
    with new_file(path) as part, open(part, "w", encoding="ascii", newline="\n") as file:
        file.write(json.dumps(head)[:-1] + ', "messages": [')
        for number, message in enumerate(orders.messages()):
            file.write(f"{',' if number else ''}\n{json.dumps(message)}")
        file.write("\n]}\n")


class _Orders:
    """What the messages to all robots say."""

    def __init__(self, course: Course) -> None:
        self.course = course
        plan = course.dependencies.plan
        self.map_id = plan.scenario.area.name or "map"
        digest = sha256(plan.scenario.robots.tobytes() + plan.actions.tobytes()).hexdigest()[:8]
        self.order_id = f"{digest}-robot-{{}}"
        self.before: dict[tuple[int, int], list[tuple[int, int]]] = defaultdict(list)
        for robot, waypoint, other, reached in course.dependencies.waits.tolist():
            self.before[robot, waypoint].append((other, reached))
        cells = plan.scenario.area.cell_to_xy(course.dependencies.cell_of_waypoint)
        self.cell_x, self.cell_y = (column.tolist() for column in cells)

    def messages(self) -> Iterator[dict[str, Any]]:
        """Yield the messages to each robot that has somewhere to go, in the order in which they are to be sent."""
        for robot in range(self.course.dependencies.plan.scenario.robot_count):
            last = len(self.course.rows_of(robot)) - 1
            if last == 0:
                continue
            # Each stretch begins where the robot must stop until others have made way.
            stops = [0, *(at - 1 for at in range(2, last + 1) if self.before[robot, at]), last]
            if self.before[robot, 1]:
                stops.insert(0, 0)  # it may not even begin: its base is the node on which it stands
            for update, (first, end) in enumerate(pairwise(stops)):
                horizon = stops[min(update + 2, len(stops) - 1)]
                yield self._message(robot, update, (first, end, horizon))

    def _message(self, robot: int, update: int, stretch: tuple[int, int, int]) -> dict[str, Any]:
        first, end, horizon = stretch
        rows, name = self.course.rows_of(robot), f"robot-{robot}"
        nodes = [self._node(rows[at], at, at <= end) for at in range(first, horizon + 1)]
        edges = [self._edge(rows[at], at, at <= end) for at in range(first + 1, horizon + 1)]
        others = self.before[robot, first + 1] if update else []
        stamp = (_START + timedelta(seconds=float(self.course.earliest[rows[first]]))).isoformat(
            timespec="milliseconds"
        )
        return {
            "robot": robot,
            "after": [
                {"robot": other, "serialNumber": f"robot-{other}", "lastNodeSequenceId": _PER_WAYPOINT * reached}
                for other, reached in others
            ],
            "topic": f"uagv/v2/{MANUFACTURER}/{name}/order",
            "order": {
                "headerId": update,
                "timestamp": stamp.replace("+00:00", "Z"),
                "version": VERSION,
                "manufacturer": MANUFACTURER,
                "serialNumber": name,
                "orderId": self.order_id.format(robot),
                "orderUpdateId": update,
                "nodes": nodes,
                "edges": edges,
            },
        }

    def _name(self, row: int) -> str:
        return f"cell_{self.cell_x[row]}_{self.cell_y[row]}"

    def _node(self, row: int, waypoint: int, is_released: bool) -> dict[str, Any]:
        x, y = (round(float(column[row]), 6) + 0.0 for column in (self.course.x, self.course.y))
        return {
            "nodeId": self._name(row),
            "sequenceId": _PER_WAYPOINT * waypoint,
            "released": is_released,
            "nodePosition": {"x": x, "y": y, "mapId": self.map_id, "allowedDeviationXY": 0.0},
            "actions": [],
        }

    def _edge(self, row: int, waypoint: int, is_released: bool) -> dict[str, Any]:
        start, end = self._name(row - 1), self._name(row)
        return {
            "edgeId": f"{start}-{end}",
            "sequenceId": _PER_WAYPOINT * waypoint - 1,
            "released": is_released,
            "startNodeId": start,
            "endNodeId": end,
            "maxSpeed": self.course.speed,
            "actions": [],
        }
