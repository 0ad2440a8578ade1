"""How soon robots can arrive at best, if they hinder each other at certain gates only.

A gate passes one robot in each *window*, ``gap[gate]`` ticks long; everywhere else there is room for all. A *slot* is a
gate in a window, ``gate * width + window``, where `width` is the number of windows looked at. Slots that can be opened
in order form a matroid, so the number served by each tick is the largest possible. Where moves last one step and others
may follow at once, windows and ticks are steps.

The windows of a gate are shifted by how far it lies from the destinations, so that window w is that of robots which
would arrive from ``w * gap`` on if nothing held them up any more. What is called steps here is what they have lost by
then: `arc_steps` on the way from gate to gate, `steps_out` after the last.

Searches look for *ins* (who might enter a slot) and *outs* (what leaves it); as *halves* the out of a slot bears its
number, the in that plus the number of slots, so that outs, which are looked at most, lie close together.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.signatures import (
    HELPER,
    IN_I32,
    IN_I64,
    OUT_BOOL,
    OUT_I32,
    OUT_I64,
    declared,
    kernel,
)

SINK = -2
DEAD = 2**31 - 1
# Entries of `state`: the tick under way; robots served; looks in all; the number of the search under way; of this
# search: halves found, height of its stack.
STEP, SERVED, LOOKS, STAMP, FOUND, HEIGHT = range(6)
_NONE = np.int64(-1)


class Gates(NamedTuple):
    """Gates, the steps between them, and the steps from the robots to them: see `GateNetwork`."""

    gap: IN_I32  # how many ticks a window of each gate is long
    steps_out: IN_I32  # from each gate to a destination, -1: each way passes another gate
    first_arc: IN_I64  # gate g is entered by the arcs first_arc[g] .. first_arc[g + 1] - 1
    arc_gate: IN_I32  # from which gate
    arc_steps: IN_I32  # how many steps later
    first_robot: IN_I64  # likewise by robots, the nearest first
    robot: IN_I32
    robot_window: IN_I32  # the first in which it can be there
    robots: types.int64  # how many robots there are in the lists
    width: types.int64  # windows of a gate that slots are numbered by
    horizon: types.int64  # the last tick to look at


class GateSlots(NamedTuple):
    """Who is served, and by which slots."""

    is_used: OUT_BOOL  # of each slot: whether a robot passes it
    onward: OUT_I32  # of each slot: the slot that the robot enters next, `SINK` for a destination
    first_slot: OUT_I32  # of each robot: the first slot that it passes, -1: not served
    next_unserved: OUT_I64  # of each gate: where in its list of robots the first may be that is not served
    arrival: OUT_I32  # the ticks in which robots arrive, ascending


class GateSearch(NamedTuple):
    """The search for one more robot to be served."""

    seen: OUT_I32  # of each half: the last search that has seen it; `DEAD` where that is of no use ever after
    half: OUT_I32  # the halves found, in their order
    parent: OUT_I32  # from which of them each was found, -1: the first
    changed: OUT_I32  # for which robot, if it is an in found from another
    stack: OUT_I32  # those from which to look on
    reach: OUT_I32  # of each gate: the last window for which all who might enter it have been looked at
    next_robot: OUT_I64  # of each gate: robots up to this one in its list have been looked at
    dead_reach: OUT_I32  # `reach` by all searches that failed
    dead_robot: OUT_I64  # likewise `next_robot`


GATES, GATE_SLOTS, GATE_SEARCH = declared(Gates), declared(GateSlots), declared(GateSearch)


@HELPER
def _see(half, parent, search, state):
    """Put a half of a slot on the stack, unless this search has seen it."""
    if search.seen[half] >= state[STAMP]:
        return
    search.seen[half] = state[STAMP]
    found = state[FOUND]
    search.half[found] = half
    search.parent[found] = parent
    search.stack[state[HEIGHT]] = found
    state[FOUND] = found + 1
    state[HEIGHT] += 1


@HELPER
def _look_from_out(slot, at, slots, search, state):
    """See the in from which a robot would leave by this out: that of the slot, or where its robot now goes."""
    first_in = len(slots.onward)
    if not slots.is_used[slot]:
        _see(first_in + slot, at, search, state)
    elif slots.onward[slot] >= 0:
        _see(first_in + np.int64(slots.onward[slot]), at, search, state)


@HELPER
def _is_awaited(gate, when, gates, slots):
    """Tell whether a robot that is not served yet can be in a gate in this window."""
    at, end = slots.next_unserved[gate], gates.first_robot[gate + 1]
    while at < end and slots.first_slot[gates.robot[at]] >= 0:
        at += 1
    slots.next_unserved[gate] = at
    return at < end and gates.robot_window[at] <= when


@HELPER
def _look_at_arcs(gate, when, at, gates, search, state):
    """See the outs of slots from which a gate can be entered in window `when`, if not in the last one looked at."""
    # The first tick that is too late, by now and when it was looked at last.
    end = (when + 1) * np.int64(gates.gap[gate])
    seen_end = (search.reach[gate] + 1) * np.int64(gates.gap[gate])
    for arc in range(gates.first_arc[gate], gates.first_arc[gate + 1]):
        steps, gap = np.int64(gates.arc_steps[arc]), np.int64(gates.gap[gates.arc_gate[arc]])
        slot_at_0 = np.int64(gates.arc_gate[arc]) * gates.width
        first = slot_at_0 + max(np.int64(0), (seen_end - steps - 1) // gap + 1)
        last = slot_at_0 + (end - steps - 1) // gap
        state[LOOKS] += max(np.int64(0), last + 1 - first)
        for slot in range(first, last + 1):
            _see(slot, at, search, state)


@HELPER
def _look_at_robots(gate, when, at, gates, slots, search, state):
    """See the ins by which served robots begin that can be in a gate in window `when`, and go elsewhere now."""
    # Most looks are spent here; so it is asked here already who has been seen, and by indices that cannot be negative:
    # together 15 % of all.
    first_in, stamp = len(slots.onward), state[STAMP]
    first, end = search.next_robot[gate], gates.first_robot[gate + 1]
    i = first
    while i < end and gates.robot_window[i] <= when:
        slot = np.int64(slots.first_slot[np.uint64(gates.robot[i])])
        if slot >= 0 and search.seen[np.uint64(first_in + slot)] < stamp:
            search.changed[state[FOUND]] = gates.robot[i]
            _see(first_in + slot, at, search, state)
        i += 1
    state[LOOKS] += i - first
    search.next_robot[gate] = i


@HELPER
def _look_from_in(gate, when, at, gates, slots, search, state):
    """See all by which a gate might be entered at step `when`."""
    slot = gate * gates.width + when
    if slots.is_used[slot]:
        _see(slot, at, search, state)
    if when > search.reach[gate]:
        _look_at_arcs(gate, when, at, gates, search, state)
        search.reach[gate] = when
        _look_at_robots(gate, when, at, gates, slots, search, state)


@HELPER
def _find_robot(root, gates, slots, search, state):
    """Search back from the out of a slot for a robot that is not served; return where it was found, or -1."""
    state[STAMP] += 1
    state[FOUND] = state[HEIGHT] = 0
    for gate in range(len(gates.steps_out)):
        search.reach[gate] = search.dead_reach[gate]
        search.next_robot[gate] = search.dead_robot[gate]
    _see(root, _NONE, search, state)
    while state[HEIGHT] > 0:
        state[HEIGHT] -= 1
        state[LOOKS] += 1
        at = np.int64(search.stack[state[HEIGHT]])
        half = np.int64(search.half[at])
        if half < len(slots.onward):
            _look_from_out(half, at, slots, search, state)
            continue
        slot = half - len(slots.onward)
        gate = slot // gates.width
        when = slot - gate * gates.width
        if _is_awaited(gate, when, gates, slots):
            return at
        _look_from_in(gate, when, at, gates, slots, search, state)
    return _NONE


@HELPER
def _give_up(search, state):
    """Remember that what a failing search has seen is of no use ever after."""
    for i in range(state[FOUND]):
        search.seen[search.half[i]] = DEAD
    for gate in range(len(search.reach)):
        search.dead_reach[gate] = search.reach[gate]
        search.dead_robot[gate] = search.next_robot[gate]


@HELPER
def _serve(at, root, gates, slots, search):
    """Lead the robot that a search has found through the slots on its way, and others around."""
    count = len(slots.onward)
    slot = search.half[at] - count
    slots.first_slot[gates.robot[slots.next_unserved[slot // gates.width]]] = slot
    while search.parent[at] >= 0:
        half, half_ahead = search.half[at], search.half[search.parent[at]]
        slot, ahead = half % count, half_ahead % count
        if half >= count and half_ahead >= count:  # a robot begins by another slot
            slots.first_slot[search.changed[at]] = ahead
        elif half >= count:  # where the slots differ, the robot that came there comes no more
            slots.is_used[slot] |= slot == ahead
        elif slot == ahead:  # who passed this slot goes elsewhere, and nobody comes in its place
            slots.is_used[slot] = False
        else:
            slots.onward[slot] = ahead
        at = np.int64(search.parent[at])
    slots.onward[root] = SINK


@kernel(types.void(GATES, GATE_SLOTS, GATE_SEARCH, OUT_I64, types.int64))
def serve_robots(gates, slots, search, state, budget):
    """Serve as many robots as possible by each tick in turn, about `budget` looks long or until all are served.

    In tick T, from every gate g that leads to a destination in ``steps_out[g]`` steps and whose window begins at
    T - steps_out[g], a search runs back from that slot along residual arcs for a robot that is not served yet.
    """
    most_looks = state[LOOKS] + budget
    while state[SERVED] < gates.robots and state[STEP] < gates.horizon and state[LOOKS] < most_looks:
        state[STEP] += 1
        for gate in range(len(gates.steps_out)):
            begin, gap = state[STEP] - gates.steps_out[gate], np.int64(gates.gap[gate])
            if gates.steps_out[gate] < 0 or begin < 0 or begin % gap or state[SERVED] == gates.robots:
                continue
            root = gate * gates.width + begin // gap
            if search.seen[root] == DEAD:
                continue
            at = _find_robot(root, gates, slots, search, state)
            if at < 0:
                _give_up(search, state)
            else:
                _serve(at, root, gates, slots, search)
                slots.arrival[state[SERVED]] = state[STEP]
                state[SERVED] += 1
