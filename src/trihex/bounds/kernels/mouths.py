"""When robots can arrive at best, if each destination has a mouth that lets in so many robots in each window of time.

Robots choose the destination, and each knows how soon it can be at which. A *slot* is a mouth in a window; sets of
slots that robots can fill are the independent sets of a transversal matroid, so the best is found greedily: in order
of time a slot is filled if it can be beside those filled before. A search goes back from the slot for a robot that has
none yet: from a mouth up to a window to all robots who could be there by then, and from one that has a slot to that
slot.

If there is none, whatever the search has seen is dead for ever. Then its window is the *label* of what was seen: the
first one in which a further robot could arrive that could be at that mouth by that time.
"""

from typing import NamedTuple

import numpy as np
from numba import types

from trihex.kernels.signatures import HELPER, IN_I32, IN_I64, OUT_BOOL, OUT_I32, OUT_I64, declared, kernel

# Entries of `state`: the window under way; robots served; looks in all; the number of the search under way; of this
# search: turns found, height of its stack, mouths seen; and whether all is done.
WINDOW, SERVED, LOOKS, STAMP, TURNS, HEIGHT, DOORS, DONE = range(8)
STATE_SIZE = 8


class Approach(NamedTuple):
    """Which robots can be at which mouth when."""

    places: IN_I64  # how many robots each mouth lets in in a window
    first: IN_I64  # mouth d is that of entries first[d] .. first[d + 1] - 1
    robot: IN_I32  # in order of window
    window: IN_I32  # the first one in which it can be there
    horizon: types.int64  # how many windows are looked at


class MouthSlots(NamedTuple):
    """Who has which slot, and what is known of all."""

    mouth: OUT_I32  # of each robot; -1: none yet
    window: OUT_I32  # of each robot
    next_unserved: OUT_I64  # of each mouth: all before have a slot
    label: OUT_I32  # of each mouth and window, mouth * horizon + window


class MouthSearch(NamedTuple):
    """What the search under way has seen."""

    seen_mouth: OUT_I64  # of each mouth: the last search that has seen it
    mouths: OUT_I64  # those that this one has seen
    reach: OUT_I64  # of each mouth: the last window seen
    next_robot: OUT_I64  # of each mouth: the first entry that has not been looked at
    dead_reach: OUT_I64  # the same for what is dead
    dead_robot: OUT_I64
    turn: OUT_I64  # of each mouth: the turn by which it was reached
    is_stacked: OUT_BOOL  # of each mouth
    stack: OUT_I64  # mouths
    seen_robot: OUT_I64  # of each robot: the last search that has seen it
    robot: OUT_I64  # of each turn: who would leave a slot to others; -1: the slot is that from which the search began
    before: OUT_I64  # of each turn: the turn by which the mouth was reached that it would go to


APPROACH, DOOR_SLOTS, DOOR_SEARCH = declared(Approach), declared(MouthSlots), declared(MouthSearch)


@HELPER
def _reach_of(mouth, search, state):
    """Return the last window of a mouth that is dead or has been seen by this search."""
    return search.reach[mouth] if search.seen_mouth[mouth] == state[STAMP] else search.dead_reach[mouth]


@HELPER
def _reach(mouth, window, robot, before, search, state):
    """Note that a slot might be left to others: `robot` would go to the mouth reached by turn `before`."""
    if search.seen_mouth[mouth] < state[STAMP]:
        search.seen_mouth[mouth] = state[STAMP]
        search.next_robot[mouth] = search.dead_robot[mouth]
        search.is_stacked[mouth] = False
        search.mouths[state[DOORS]] = mouth
        state[DOORS] += 1
    turn = state[TURNS]
    search.robot[turn] = robot
    search.before[turn] = before
    search.turn[mouth] = turn
    search.reach[mouth] = window
    state[TURNS] = turn + 1
    if not search.is_stacked[mouth]:
        search.is_stacked[mouth] = True
        search.stack[state[HEIGHT]] = mouth
        state[HEIGHT] += 1


@HELPER
def _is_awaited(mouth, approach, slots, search):
    """Tell whether a robot without slot can be at a mouth in time."""
    at, end = slots.next_unserved[mouth], approach.first[mouth + 1]
    while at < end and slots.mouth[approach.robot[at]] >= 0:
        at += 1
    slots.next_unserved[mouth] = at
    return at < end and approach.window[at] <= search.reach[mouth]


@HELPER
def _look_at_robots(mouth, approach, slots, search, state):
    """See the slots of all robots that can be at a mouth in time."""
    at, end = search.next_robot[mouth], approach.first[mouth + 1]
    first = at
    while at < end and approach.window[at] <= search.reach[mouth]:
        robot = approach.robot[at]
        at += 1
        if search.seen_robot[robot] < state[STAMP]:
            search.seen_robot[robot] = state[STAMP]
            if slots.window[robot] > _reach_of(slots.mouth[robot], search, state):
                _reach(slots.mouth[robot], slots.window[robot], robot, search.turn[mouth], search, state)
    search.next_robot[mouth] = at
    state[LOOKS] += at - first


@HELPER
def _find_robot(mouth, approach, slots, search, state):
    """Search from a slot for a robot that has none; return the mouth where it was found, or -1."""
    state[STAMP] += 1
    state[TURNS] = state[HEIGHT] = state[DOORS] = 0
    state[LOOKS] += 1
    _reach(mouth, state[WINDOW], -1, -1, search, state)
    while state[HEIGHT] > 0:
        state[HEIGHT] -= 1
        at = search.stack[state[HEIGHT]]
        search.is_stacked[at] = False
        if _is_awaited(at, approach, slots, search):
            return at
        _look_at_robots(at, approach, slots, search, state)
    return -1


@HELPER
def _serve(found, mouth, approach, slots, search, state):
    """Give a slot to the robot that was found, and to each who leaves his slot to another that where he would go."""
    robot = np.int64(approach.robot[slots.next_unserved[found]])
    turn = search.turn[found]
    while search.robot[turn] >= 0:
        other = search.robot[turn]
        slots.mouth[robot], slots.window[robot] = slots.mouth[other], slots.window[other]
        robot, turn = other, search.before[turn]
    slots.mouth[robot], slots.window[robot] = mouth, state[WINDOW]
    state[SERVED] += 1


@HELPER
def _give_up(approach, slots, search, state):
    """Label what a search has seen in vain."""
    for i in range(state[DOORS]):
        mouth = search.mouths[i]
        for window in range(search.dead_reach[mouth] + 1, search.reach[mouth] + 1):
            slots.label[mouth * approach.horizon + window] = state[WINDOW]
        search.dead_reach[mouth] = search.reach[mouth]
        search.dead_robot[mouth] = search.next_robot[mouth]


@kernel(types.void(APPROACH, DOOR_SLOTS, DOOR_SEARCH, OUT_I64, types.int64))
def queue_at_mouths(approach, slots, search, state, budget):
    """Fill slots in order of time until all robots have one and all is labelled, or about `budget` looks long."""
    most_looks = state[LOOKS] + budget
    while not state[DONE] and state[LOOKS] < most_looks:
        if state[WINDOW] == approach.horizon:
            state[DONE] = 1
            return
        is_last = state[SERVED] == len(slots.mouth)  # nobody is left: this window only labels
        for mouth in range(len(approach.places)):
            place = 0
            while place < approach.places[mouth] and search.dead_reach[mouth] < state[WINDOW]:
                place += 1
                found = _find_robot(mouth, approach, slots, search, state)
                if found < 0:
                    _give_up(approach, slots, search, state)
                else:
                    _serve(found, mouth, approach, slots, search, state)
        state[WINDOW] += 1
        if is_last:
            state[DONE] = 1
