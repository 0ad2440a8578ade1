"""Owners: who owns a cell or a lattice vertex, and until when.

Time is counted in half ticks, whole numbers: tick t is half tick 2t, and the middle of a move that lasts d from there
is 2t + d. Since the judge knows the whole plan, he knows when a robot will leave as soon as it comes. So of all that
came to a place he keeps but the one that stays the longest: who comes later comes too early if that one is still there.
"""

from typing import NamedTuple

import numpy as np

from trihex.judging.kernels.findings import CAPACITY, CROSSING, EXCHANGE, NONE, OWNED, note
from trihex.kernels.signatures import HELPER, OUT_I32, declared

NEVER = 2**31 - 1  # the half tick in which a robot leaves that stays for good


class Owners(NamedTuple):
    """Who stays the longest of those that came to each place so far."""

    place: OUT_I32  # what lies at each site: see `law`; this judge does not write there who is where
    holder: OUT_I32  # of each site; -1: nobody came yet
    until: OUT_I32  # until which half tick; of a destination: how many are entering it
    vertex_holder: OUT_I32  # the same of each lattice vertex, if crossing is forbidden
    vertex_until: OUT_I32


class Movers(NamedTuple):
    """The robots of a plan, as the judge of owners follows them."""

    here: OUT_I32  # where the last move of each came from; where it is, as long as it has not moved
    target: OUT_I32  # where that leads
    ends: OUT_I32  # the half tick in which it ends
    due: OUT_I32  # the half tick in which the robot is to be judged next; negative once it acts no more
    phase: OUT_I32  # what it does then: `LEAVES`, `COMES` or `VANISHES`
    coming: OUT_I32  # the action by which it leaves next, counted from its first
    active: OUT_I32  # those that act, ascending
    turn: OUT_I32  # room for those whose turn it is in this tick


_U = np.uint64
OWNERS, MOVERS = declared(Owners), declared(Movers)


@HELPER
def hold(robot, site, end, owners):
    """Let a robot own a cell from now on to before `end`."""
    if end > owners.until[_U(site)]:
        owners.holder[_U(site)] = robot
        owners.until[_U(site)] = end


@HELPER
def judge_owner(robot, site, begin, owners, findings):
    """Judge whether another owns the cell that a robot begins to own."""
    other = np.int64(owners.holder[_U(site)])
    if owners.until[_U(site)] > begin and other != robot:  # itself where a file has it jump to where it is
        both = min(other, robot), max(other, robot)
        note(findings, begin // 2 + 1, OWNED, both, (site, NONE, NONE, NONE))


@HELPER
def own_vertex(deed, begin, end, movers, owners, findings):
    """Let a robot own a lattice vertex while it moves, and judge whether another owns it then."""
    other, until = np.int64(owners.vertex_holder[deed.vertex]), np.int64(owners.vertex_until[deed.vertex])
    if until > begin:
        sites = np.int64(movers.here[other]), np.int64(movers.target[other]), deed.here, deed.target
        if other < deed.robot:
            note(findings, deed.step, CROSSING, (other, deed.robot), sites)
        else:
            note(findings, deed.step, CROSSING, (deed.robot, other), (sites[2], sites[3], sites[0], sites[1]))
    if end > until:
        owners.vertex_holder[deed.vertex] = deed.robot
        owners.vertex_until[deed.vertex] = end


@HELPER
def judge_exchange(deed, begin, movers, owners, findings):
    """Judge whether the owner of the cell where a robot goes is on its way from there to where that one comes from."""
    other = np.int64(owners.holder[deed.target])
    if other < 0 or owners.until[deed.target] <= begin or movers.ends[other] <= begin:
        return
    if movers.here[other] == deed.target and movers.target[other] == deed.here:
        both = min(other, deed.robot), max(other, deed.robot)
        sites = (deed.target, deed.here) if other < deed.robot else (deed.here, deed.target)
        note(findings, deed.step, EXCHANGE, both, (sites[0], sites[1], NONE, NONE))


@HELPER
def enter(robot, site, begin, capacity, owners, findings):
    """Let a robot enter a destination, and judge whether there is room for it."""
    owners.until[site] += 1
    if capacity > 0 and owners.until[site] > capacity:
        note(findings, begin // 2 + 1, CAPACITY, (robot, NONE), (site, NONE, NONE, NONE))
