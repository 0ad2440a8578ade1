"""Who waits for whom, the slow way: every earlier owner of every thing, and what follows from what by sets."""

from itertools import pairwise

from tests.oracles.owners import Record


class Events:
    """For each waypoint (robot, number) of a plan those that must be reached before the robot goes there."""

    def __init__(self, plan):
        record, self.before, owners = Record(plan), {}, {}
        count = dict.fromkeys(range(plan.scenario.robot_count), 0)
        forbids = plan.scenario.following == "forbid"
        for robot, cell in enumerate(record.rules.places(plan.scenario.robots)):
            if cell not in record.destinations:
                owners.setdefault(("cell", cell), []).append((-1, (robot, 1)))
        for move in record.moves:
            count[move.robot] += 1
            here = move.robot, count[move.robot]
            self.before[here] = {(move.robot, here[1] - 1)}
            begin, end = move.begin, move.end
            if plan.scenario.forbids_crossing and move.vertex is not None:
                owners.setdefault(("vertex", move.vertex), []).append((begin, here, end, here))
            comes = begin if forbids else (begin + end) // 2
            if move.target in record.destinations:
                owners.setdefault(("destination", move.target), []).append((comes, here, end, here))
            else:
                owners.setdefault(("cell", move.target), []).append((comes, here, None, (move.robot, here[1] + 1)))
        self.naive = 0
        for thing, own in owners.items():
            own.sort(key=lambda stay: stay[0])
            most = plan.scenario.destination_capacity if thing[0] == "destination" else 1
            if thing[0] == "destination" and most is not None:
                self._take_turns(own, most)
            elif thing[0] != "destination":
                self._follow(own)

    def _follow(self, own):
        """Let each come after all that came before it."""
        for at, stay in enumerate(own[1:], 1):
            for other in own[:at]:
                if other[-1][0] != stay[1][0]:
                    self.naive += 1
                    self.before[stay[1]].add(other[-1])

    def _take_turns(self, own, most):
        """Let the n-th to come wait for the (n - most)-th to be done."""
        own.sort(key=lambda stay: (stay[0], stay[2], stay[1]))
        done = sorted(own, key=lambda stay: (stay[2], stay[0], stay[1]))
        for stay, other in zip(own[most:], done, strict=False):
            self.before[stay[1]].add(other[3])

    def closure(self):
        """Everything that must be reached before a robot leaves for each waypoint; itself too where that is a ring."""
        return closure_of(self.before)


def closure_of(before):
    """Return for each waypoint all that is before it, by spreading sets until nothing changes."""
    after = {here: set(own) for here, own in before.items()}
    changed = True
    while changed:
        changed = False
        for own in after.values():
            more = set().union(*(after.get(other, ()) for other in own)) - own
            own |= more
            changed |= bool(more)
    return after


def events_of(dependencies):
    """Return the same as `Events.before` from dependencies as trihex tells them."""
    before = {}
    for robot, (first, last) in enumerate(pairwise(dependencies.first_waypoint.tolist())):
        for waypoint in range(1, last - first):
            before[robot, waypoint] = {(robot, waypoint - 1)}
    for robot, waypoint, other, reached in dependencies.waits.tolist():
        before[robot, waypoint].add((other, reached))
    return before
