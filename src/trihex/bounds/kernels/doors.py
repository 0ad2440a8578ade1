"""When robots can arrive at best, if each destination has a door that lets in so many robots in each window of time.

Robots choose the destination, and each knows how soon it can be at which. A *slot* is a door in a window; sets of slots
that robots can fill are the independent sets of a transversal matroid, so the best is found greedily: in order of time
a slot is filled if it can be beside those filled before. A search goes back from the slot for a robot that has none
yet: from a door up to a window to all robots who could be there by then, and from one that has a slot to that slot.

If there is none, whatever the search has seen is dead for ever. Then its window is the *label* of what was seen: the
first one in which a further robot could arrive that could be at that door by that time.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.signatures import HELPER, IN_I32, IN_I64, OUT_BOOL, OUT_I32, OUT_I64, declared, kernel

# Entries of `state`: the window under way; robots served; looks in all; the number of the search under way; of this
# search: turns found, height of its stack, doors seen; and whether all is done.
WINDOW, SERVED, LOOKS, STAMP, TURNS, HEIGHT, DOORS, DONE = range(8)
STATE_SIZE = 8


class Approach(NamedTuple):
    """Which robots can be at which door when."""

    places: IN_I64  # how many robots each door lets in in a window
    first: IN_I64  # door d is that of entries first[d] .. first[d + 1] - 1
    robot: IN_I32  # in order of window
    window: IN_I32  # the first one in which it can be there
    horizon: types.int64  # how many windows are looked at


class DoorSlots(NamedTuple):
    """Who has which slot, and what is known of all."""

    door: OUT_I32  # of each robot; -1: none yet
    window: OUT_I32  # of each robot
    next_unserved: OUT_I64  # of each door: all before have a slot
    label: OUT_I32  # of each door and window, door * horizon + window


class DoorSearch(NamedTuple):
    """What the search under way has seen."""

    seen_door: OUT_I64  # of each door: the last search that has seen it
    doors: OUT_I64  # those that this one has seen
    reach: OUT_I64  # of each door: the last window seen
    next_robot: OUT_I64  # of each door: the first entry that has not been looked at
    dead_reach: OUT_I64  # the same for what is dead
    dead_robot: OUT_I64
    turn: OUT_I64  # of each door: the turn by which it was reached
    is_stacked: OUT_BOOL  # of each door
    stack: OUT_I64  # doors
    seen_robot: OUT_I64  # of each robot: the last search that has seen it
    robot: OUT_I64  # of each turn: who would leave a slot to others; -1: the slot is that from which the search began
    before: OUT_I64  # of each turn: the turn by which the door was reached that it would go to


APPROACH, DOOR_SLOTS, DOOR_SEARCH = declared(Approach), declared(DoorSlots), declared(DoorSearch)


@HELPER
def _reach_of(door, search, state):
    """Return the last window of a door that is dead or has been seen by this search."""
    return search.reach[door] if search.seen_door[door] == state[STAMP] else search.dead_reach[door]


@HELPER
def _reach(door, window, robot, before, search, state):
    """Note that a slot might be left to others: `robot` would go to the door reached by turn `before`."""
    if search.seen_door[door] < state[STAMP]:
        search.seen_door[door] = state[STAMP]
        search.next_robot[door] = search.dead_robot[door]
        search.is_stacked[door] = False
        search.doors[state[DOORS]] = door
        state[DOORS] += 1
    turn = state[TURNS]
    search.robot[turn] = robot
    search.before[turn] = before
    search.turn[door] = turn
    search.reach[door] = window
    state[TURNS] = turn + 1
    if not search.is_stacked[door]:
        search.is_stacked[door] = True
        search.stack[state[HEIGHT]] = door
        state[HEIGHT] += 1


@HELPER
def _is_awaited(door, approach, slots, search):
    """Tell whether a robot without slot can be at a door in time."""
    at, end = slots.next_unserved[door], approach.first[door + 1]
    while at < end and slots.door[approach.robot[at]] >= 0:
        at += 1
    slots.next_unserved[door] = at
    return at < end and approach.window[at] <= search.reach[door]


@HELPER
def _look_at_robots(door, approach, slots, search, state):
    """See the slots of all robots that can be at a door in time."""
    at, end = search.next_robot[door], approach.first[door + 1]
    first = at
    while at < end and approach.window[at] <= search.reach[door]:
        robot = approach.robot[at]
        at += 1
        if search.seen_robot[robot] < state[STAMP]:
            search.seen_robot[robot] = state[STAMP]
            if slots.window[robot] > _reach_of(slots.door[robot], search, state):
                _reach(slots.door[robot], slots.window[robot], robot, search.turn[door], search, state)
    search.next_robot[door] = at
    state[LOOKS] += at - first


@HELPER
def _find_robot(door, approach, slots, search, state):
    """Search from a slot for a robot that has none; return the door where it was found, or -1."""
    state[STAMP] += 1
    state[TURNS] = state[HEIGHT] = state[DOORS] = 0
    state[LOOKS] += 1
    _reach(door, state[WINDOW], -1, -1, search, state)
    while state[HEIGHT] > 0:
        state[HEIGHT] -= 1
        at = search.stack[state[HEIGHT]]
        search.is_stacked[at] = False
        if _is_awaited(at, approach, slots, search):
            return at
        _look_at_robots(at, approach, slots, search, state)
    return -1


@HELPER
def _serve(found, door, approach, slots, search, state):
    """Give a slot to the robot that was found, and to each who leaves his slot to another that where he would go."""
    robot = np.int64(approach.robot[slots.next_unserved[found]])
    turn = search.turn[found]
    while search.robot[turn] >= 0:
        other = search.robot[turn]
        slots.door[robot], slots.window[robot] = slots.door[other], slots.window[other]
        robot, turn = other, search.before[turn]
    slots.door[robot], slots.window[robot] = door, state[WINDOW]
    state[SERVED] += 1


@HELPER
def _give_up(approach, slots, search, state):
    """Label what a search has seen in vain."""
    for i in range(state[DOORS]):
        door = search.doors[i]
        for window in range(search.dead_reach[door] + 1, search.reach[door] + 1):
            slots.label[door * approach.horizon + window] = state[WINDOW]
        search.dead_reach[door] = search.reach[door]
        search.dead_robot[door] = search.next_robot[door]


@kernel(types.void(APPROACH, DOOR_SLOTS, DOOR_SEARCH, OUT_I64, types.int64))
def queue_at_doors(approach, slots, search, state, budget):
    """Fill slots in order of time until all robots have one and all is labelled, or about `budget` looks long."""
    most_looks = state[LOOKS] + budget
    while not state[DONE] and state[LOOKS] < most_looks:
        if state[WINDOW] == approach.horizon:
            state[DONE] = 1
            return
        is_last = state[SERVED] == len(slots.door)  # nobody is left: this window only labels
        for door in range(len(approach.places)):
            place = 0
            while place < approach.places[door] and search.dead_reach[door] < state[WINDOW]:
                place += 1
                found = _find_robot(door, approach, slots, search, state)
                if found < 0:
                    _give_up(approach, slots, search, state)
                else:
                    _serve(found, door, approach, slots, search, state)
        state[WINDOW] += 1
        if is_last:
            state[DONE] = 1
