"""Playback: what all robots together do in each step of a plan."""

from typing import NamedTuple

from numba import types

from trihex.kernels.actions import ACTIONS, site_after, times_of
from trihex.kernels.codes import JUMP, NOT_REACHED, WAIT
from trihex.kernels.signatures import IN_BOOL, IN_I32, OUT_I64, declared, kernel


class StepSums(NamedTuple):
    """Sums over all robots by step, from 0 to the last."""

    moving: OUT_I64  # robots that move in the step
    waiting: OUT_I64  # robots that wait in it
    arriving: OUT_I64  # robots whose last step it is
    spent: OUT_I64  # what the step costs those that arrive
    lost: OUT_I64  # how much of that brings them no nearer


@kernel(types.void(IN_I32, ACTIONS, IN_I32, types.int64, IN_I32, IN_BOOL, IN_I32, declared(StepSums)))
def count_steps(start, actions, cost, waiting_cost, duration, arrived, distance, sums):
    """Add up for each step who moves, waits and arrives, the time spent, and how much of it was no way forward.

    The counts are of all robots, the times of those that arrive only. `cost` is that of each direction, `distance`
    the N-scheme by site, both of the fastest; an action loses what it costs less what it brings its robot nearer; a
    jump costs nothing. An action that lasts several steps, of the fastest ``duration[its byte]``, is paid step by step;
    what it loses is lost in the first.
    """
    for robot in range(len(start)):
        site, arrives = start[robot], arrived[robot]
        step = 1  # in which the next action begins
        for i in range(actions.first[robot], actions.first[robot + 1]):
            action = actions.action[i]
            times = times_of(robot, action, actions)
            lasts = duration[action] * times
            to = site
            price = waiting_cost
            if action == WAIT:
                sums.waiting[step] += 1
            else:
                sums.moving[step] += 1
                for later in range(step + 1, step + lasts):
                    sums.moving[later] += 1
                to = site_after(site, i, actions)
                price = 0 if action == JUMP else cost[action] * times
            if arrives:
                if lasts == 1:
                    sums.spent[step] += price
                else:  # bit by bit
                    for later in range(step, step + lasts):
                        sums.spent[later] += price // lasts
                sums.lost[step] += price
                if distance[site] != NOT_REACHED and distance[to] != NOT_REACHED:
                    sums.lost[step] += (distance[to] - distance[site]) * types.int64(actions.slowness[robot])
            site = to
            step += lasts
        if arrives:
            sums.arriving[step - 1] += 1
