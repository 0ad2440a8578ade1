"""Steps: robots step to the parents of their sites."""

import numpy as np
from numba import njit, types

from trihex.kernels.branches import BRANCH, GRID, LOAD, OFFSET, PARENT, PASSING, STEPS, TABLE, VERTEX
from trihex.kernels.signatures import OUT_BOOL, OUT_I32, OUT_I64, OUT_U8

_STEP = 1 << 32


@njit(types.void(GRID, types.int64, GRID, GRID), cache=True, nogil=True)
def order_robots(listed, active, node, spare):
    """Sort the first `active` robots `listed` (rows: site, robot) by the steps they are away, stable."""
    most = 0
    for i in range(active):
        most = max(most, node[listed[0, i], STEPS])
    first = np.zeros(most + 2, dtype=np.int64)
    for i in range(active):
        first[node[listed[0, i], STEPS] + 1] += 1
    for steps in range(most + 1):
        first[steps + 1] += first[steps]
    for i in range(active):
        steps = node[listed[0, i], STEPS]
        spare[0, first[steps]] = listed[0, i]
        spare[1, first[steps]] = listed[1, i]
        first[steps] += 1
    listed[:, :active] = spare[:, :active]


@njit(types.void(GRID, types.int64, GRID, GRID), cache=True, nogil=True, _nrt=False)
def count_arrivals(listed, active, node, arrivals):
    """Count in ``arrivals[branch, steps]`` the robots of each branch that are so many steps away."""
    arrivals[:] = 0
    last = arrivals.shape[1] - 1
    for i in range(active):
        site = listed[0, i]
        arrivals[node[site, BRANCH], min(node[site, STEPS], last)] += 1


@njit(
    types.UniTuple(types.int64, 3)(
        TABLE,
        types.int64,
        types.int64,
        types.int64,
        types.int64,
        types.int64,
        OUT_BOOL,
        OUT_I32,
        OUT_I64,
        GRID,
        GRID,
        GRID,
        OUT_I32,
        OUT_U8,
        OUT_I64,
        OUT_I64,
    ),
    cache=True,
    nogil=True,
    _nrt=False,
)
def follow(
    table,
    first_vertex_move,
    capacity,
    step,
    active,
    last_step,
    occupied,
    passed,
    entered,
    node,
    listed,
    spare,
    log_robot,
    log_action,
    log_end,
    arrival,
):
    """Let robots follow their branches up to `last_step` or until a log is full; return step, active robots, steps.

    The robots are `listed` (rows: site, robot) in order of the steps they are away. All that move come one step nearer,
    so those that move and those that wait stay in order, and one merge a step restores the order of all.
    """
    done = 0
    logged = 0
    while active > 0 and step < last_step and done < len(log_end) and logged + active <= len(log_robot):
        step += 1
        moved = 0
        waiting = 0
        for i in range(active):
            site = listed[0, i]
            robot = listed[1, i]
            parity = site & 1
            k = node[site, PARENT]
            target = site + table[OFFSET + parity, k]
            enters = node[site, STEPS] == 1
            is_free = not occupied[target]
            if is_free and k >= first_vertex_move:
                is_free = passed[site + table[VERTEX + parity, k]] != step
            if is_free and enters and capacity > 0:
                is_free = entered[target] < step * _STEP + capacity
            if not is_free:
                listed[0, waiting] = site
                listed[1, waiting] = robot
                waiting += 1
                continue
            occupied[site] = False
            node[site, LOAD] -= 1
            if k >= first_vertex_move:
                passed[site + table[VERTEX + parity, k]] = step
                node[site + table[VERTEX + parity, k], PASSING] -= 1
            log_robot[logged] = robot
            log_action[logged] = k
            logged += 1
            if enters:
                arrival[robot] = step
                if capacity > 0:
                    entered[target] = max(entered[target], step * _STEP) + 1
                continue
            occupied[target] = True
            spare[0, moved] = target
            spare[1, moved] = robot
            moved += 1
        # Merge from the back: the waiting ones already stand at the front of `listed`.
        active = moved + waiting
        at = active - 1
        while moved > 0:
            if waiting > 0 and node[listed[0, waiting - 1], STEPS] > node[spare[0, moved - 1], STEPS]:
                listed[0, at] = listed[0, waiting - 1]
                listed[1, at] = listed[1, waiting - 1]
                waiting -= 1
            else:
                listed[0, at] = spare[0, moved - 1]
                listed[1, at] = spare[1, moved - 1]
                moved -= 1
            at -= 1
        log_end[done] = logged
        done += 1
    return step, active, done
