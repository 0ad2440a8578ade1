"""Balance: parts of crowded branches are led to others as long as that makes the total time less."""

import numpy as np
from numba import njit, types

from trihex.kernels.branches import (
    BRANCH,
    GRID,
    IS_DESTINATION,
    LOAD,
    MOVES,
    OFFSET,
    PARENT,
    REVERSE,
    STEPS,
    TABLE,
    WAY,
    add_load,
    label,
    turn,
)
from trihex.kernels.branches_search import (
    AGE,
    BEST,
    COMING,
    FIRST_VERTEX_MOVE,
    LEAVING,
    LIGHT,
    MOST_COST,
    NUMBER,
    OWN,
    VISITS,
    WAITING_COST,
    WIDE,
    search,
)
from trihex.kernels.signatures import IN_BOOL, IN_I32, OUT_I32, OUT_I64

# Columns of `queue`, a row for each branch: sum of the steps in which its robots arrive; the longest wait of any; the
# most robots that are tried to be led away at once; whether nothing helps it any more.
SUM, LONGEST, TRIED, STUCK = range(4)
QUEUE_COLUMNS = 4
# Part of the load up to which robots in the way are simply taken along, and by which a part of a branch may shrink on
# its way up and still count as the same.
_LIGHT_PART = 4
_SAME = 0.8
_LADDER = 0.6
_TRIES = 4
_RUN = 64


@njit(types.int64(GRID, types.int64), cache=True, nogil=True, _nrt=False)
def sum_of_arrivals(arrivals, branch):
    """Return the sum of the steps in which the robots of a branch arrive, one a step."""
    waiting = 0
    total = np.int64(0)
    last = arrivals.shape[1]
    for step in range(last):
        waiting += arrivals[branch, step]
        if waiting > 0:
            total += step
            waiting -= 1
    return total + waiting * last + waiting * (waiting - 1) // 2


@njit(types.void(GRID, types.int64, GRID, types.Array(types.int64, 2, "C")), cache=True, nogil=True, _nrt=False)
def fill_slots(arrivals, branch, slot, queue):
    """Fill ``slot[branch, step]``, the step in which one more robot that is `step` steps away would arrive."""
    waiting = 0
    last = arrivals.shape[1]
    for step in range(last):
        waiting += arrivals[branch, step]
        slot[branch, step] = waiting
        waiting -= waiting > 0
    free = last + waiting
    longest = 0
    for step in range(last - 1, -1, -1):
        if slot[branch, step] == 0:
            free = step
        slot[branch, step] = free
        if arrivals[branch, step] > 0:
            longest = max(longest, free - 1 - step)
    queue[branch, SUM] = sum_of_arrivals(arrivals, branch)
    queue[branch, LONGEST] = longest


@njit(
    types.void(types.int64, OUT_I64, TABLE, IN_BOOL, GRID, GRID, OUT_I64, OUT_I32, GRID),
    cache=True,
    nogil=True,
    _nrt=False,
)
def _take_back(count, told, table, occupied, node, arrivals, touched, found, turned):
    """Undo the first `count` turns, the last first."""
    for i in range(count - 1, -1, -1):
        site = turned[i, 0]
        if node[site, LOAD] > 0:
            turn(site, turned[i, PARENT], table, told[FIRST_VERTEX_MOVE], occupied, node, arrivals, touched, found)
        else:
            for column in range(PARENT, WAY + 1):
                node[site, column] = turned[i, column]


@njit(
    types.UniTuple(types.int64, 2)(
        OUT_I64, types.int64, OUT_I64, TABLE, IN_BOOL, GRID, GRID, OUT_I64, OUT_I32, GRID
    ),
    cache=True,
    nogil=True,
    _nrt=False,
)
def _lead(path, length, told, table, occupied, node, arrivals, touched, found, turned):
    """Turn the sites of a path, its end first; return how many, and the change in cost less waiting cost times steps.

    The number is -1, and all is as before, if that makes a circle. ``turned`` keeps what the sites were before.
    """
    count = 0
    extra = np.int64(0)
    for i in range(length):
        site = path[i] >> 1
        state = path[i] & 1
        load = node[site, LOAD]
        k = -1
        if i == 0:
            if state == COMING and load > 0 and node[site, BRANCH] != told[OWN]:
                continue  # it ends here, in another branch
            for j in range(table.shape[1]):
                if node[site, MOVES] >> j & 1 and k < 0:
                    if node[site + table[OFFSET + (site & 1), j], MOVES] & IS_DESTINATION:
                        k = j
        else:
            if path[i - 1] & 1 == LEAVING:
                continue  # the next is pushed out of its branch; this one stays
            target = path[i - 1] >> 1
            for j in range(table.shape[1]):
                if site + table[OFFSET + (site & 1), j] == target:
                    k = j
        if load > 0 and node[site, PARENT] == k:
            continue
        turned[count, 0] = site
        for column in range(PARENT, WAY + 1):
            turned[count, column] = node[site, column]
        before = node[site, WAY] - told[WAITING_COST] * node[site, STEPS]
        is_led = k >= 0 and (load > 0 or state == COMING)
        if is_led:
            is_led = turn(site, k, table, told[FIRST_VERTEX_MOVE], occupied, node, arrivals, touched, found)
        if not is_led:
            _take_back(count, told, table, occupied, node, arrivals, touched, found, turned)
            return -1, 0
        count += 1
        extra += load * (node[site, WAY] - told[WAITING_COST] * node[site, STEPS] - before)
    return count, extra


@njit(types.int64(IN_I32, types.int64, types.float64, TABLE, GRID, OUT_I32), cache=True, nogil=True, _nrt=False)
def _list_parts(gate_sites, branch, most, table, node, found):
    """List the largest parts of a branch with a load up to `most`, without those far smaller; return how many.

    `found` is split: the parts at its start, the sites still to look at at its end.
    """
    parts = 0
    first = len(found)
    for i in range(3 * branch, 3 * branch + 3):
        site = gate_sites[i]
        if site >= 0 and node[site, LOAD] > 0 and node[site, BRANCH] == branch and node[site, STEPS] == 1:
            first -= 1
            found[first] = site
    while first < len(found) and parts < first:
        site = found[first]
        first += 1
        if node[site, LOAD] <= most:
            if node[site, LOAD] > most * _LADDER:
                found[parts] = site
                parts += 1
            continue
        for k in range(table.shape[1]):
            if node[site, MOVES] >> k & 1:
                child = site + table[OFFSET + (site & 1), k]
                if node[child, LOAD] > 0 and node[child, PARENT] == table[REVERSE + (site & 1), k] and first > parts:
                    first -= 1
                    found[first] = child
    return parts


@njit(types.int64(types.int64, TABLE, GRID, OUT_I32), cache=True, nogil=True, _nrt=False)
def _list_run(part, table, node, sources):
    """List the sites up from `part` through which nearly all of its load comes, the uppermost first."""
    count = 0
    site = part
    while site >= 0 and count < _RUN:
        sources[count] = site
        count += 1
        heaviest = -1
        for k in range(table.shape[1]):
            if node[site, MOVES] >> k & 1:
                child = site + table[OFFSET + (site & 1), k]
                if node[child, PARENT] == table[REVERSE + (site & 1), k]:
                    if node[child, LOAD] > 0 and node[child, LOAD] >= _SAME * node[part, LOAD]:
                        heaviest = child
        site = heaviest
    for i in range(count // 2):
        sources[i], sources[count - 1 - i] = sources[count - 1 - i], sources[i]
    return count


@njit(
    types.boolean(
        types.int64,
        IN_I32,
        OUT_I64,
        TABLE,
        types.int64,
        IN_BOOL,
        GRID,
        GRID,
        GRID,
        GRID,
        types.Array(types.int64, 2, "C"),
        OUT_I64,
        OUT_I32,
        OUT_I32,
        GRID,
        OUT_I64,
        WIDE,
        OUT_I64,
        OUT_I64,
    ),
    cache=True,
    nogil=True,
    _nrt=False,
)
def _relieve(
    branch,
    gate_sites,
    told,
    table,
    waiting_cost,
    occupied,
    node,
    mark,
    arrivals,
    slot,
    queue,
    touched,
    found,
    sources,
    turned,
    bucket,
    waiting,
    closed,
    path,
):
    """Lead one part of a crowded branch away, a large one if possible; tell whether that was possible."""
    told[AGE] += 1
    told[OWN] = branch
    last = slot.shape[1] - 1
    most = float(min(queue[branch, TRIED], queue[branch, LONGEST]))
    while most >= 1:
        parts = _list_parts(gate_sites, branch, most, table, node, found)
        tries = min(parts, _TRIES)
        for t in range(tries):  # the heaviest first
            for i in range(t + 1, parts):
                if node[found[i], LOAD] > node[found[t], LOAD]:
                    found[t], found[i] = found[i], found[t]
            sources[_RUN + t] = found[t]
        for t in range(tries):
            count = _list_run(sources[_RUN + t], table, node, sources)
            top = sources[0]
            steps = min(node[top, STEPS], last)
            load = node[top, LOAD]
            told[NUMBER] += 1
            told[LIGHT] = max(1, load // _LIGHT_PART)
            saved = told[WAITING_COST] * (slot[branch, steps] - steps - load)
            told[BEST] = min(node[top, WAY] + saved, MOST_COST)
            length = search(sources, count, told, table, node, mark, slot, bucket, waiting, closed, path)
            if length == 0:
                continue
            touched[0] = 0
            turns, extra = _lead(path, length, told, table, occupied, node, arrivals, touched, found, turned)
            if turns < 0:
                continue
            gain = -extra
            for i in range(1, 1 + touched[0]):
                gain += waiting_cost * (queue[touched[i], SUM] - sum_of_arrivals(arrivals, touched[i]))
            if gain <= 0:
                _take_back(turns, told, table, occupied, node, arrivals, touched, found, turned)
                continue
            for i in range(1, 1 + touched[0]):
                fill_slots(arrivals, touched[i], slot, queue)
                queue[touched[i], STUCK] = 0
            queue[branch, TRIED] = max(1, int(most / _LADDER))
            return True
        most *= _LADDER
    queue[branch, STUCK] = 1
    queue[branch, TRIED] = MOST_COST
    return False


@njit(
    types.boolean(
        types.int64,
        IN_I32,
        OUT_I64,
        TABLE,
        types.int64,
        IN_BOOL,
        GRID,
        GRID,
        GRID,
        GRID,
        types.Array(types.int64, 2, "C"),
        OUT_I64,
        OUT_I32,
        OUT_I32,
        GRID,
        OUT_I64,
        WIDE,
        OUT_I64,
        OUT_I64,
    ),
    cache=True,
    nogil=True,
)
def balance(
    budget,
    gate_sites,
    told,
    table,
    waiting_cost,
    occupied,
    node,
    mark,
    arrivals,
    slot,
    queue,
    touched,
    found,
    sources,
    turned,
    bucket,
    waiting,
    closed,
    path,
):
    """Relieve the branches, those with the longest waits first; tell whether it is done before `budget` is spent.

    ``told[VISITS]`` counts the sites that searches have visited.
    """
    branches = len(queue)
    is_done = False
    while not is_done:
        is_done = True
        for branch in np.argsort(-queue[:, LONGEST]):
            while queue[branch, LONGEST] > 0 and not queue[branch, STUCK]:
                if told[VISITS] >= budget:
                    return False
                if _relieve(
                    branch,
                    gate_sites,
                    told,
                    table,
                    waiting_cost,
                    occupied,
                    node,
                    mark,
                    arrivals,
                    slot,
                    queue,
                    touched,
                    found,
                    sources,
                    turned,
                    bucket,
    waiting,
                    closed,
                    path,
                ):
                    is_done = False
    return True


@njit(
    types.void(
        IN_I32, IN_I32, OUT_I64, TABLE, IN_BOOL, GRID, GRID, GRID, GRID, OUT_I64, OUT_I32, OUT_I32, GRID, OUT_I64, WIDE, OUT_I64, OUT_I64
    ),
    cache=True,
    nogil=True,
    _nrt=False,
)
def lay_lanes(
    roots, weight, told, table, occupied, node, mark, arrivals, slot, touched, found, sources, turned, bucket, waiting, closed, path
):
    """Lead a lane from each of `roots` to a gate of its own, as long as there are free ones.

    Lanes have no site in common: later ones push earlier ones aside, which makes them a flow. They bear the load
    `weight`.
    """
    for i in range(len(roots)):
        root = roots[i]
        if node[root, LOAD] > 0:
            continue
        sources[0] = root
        told[NUMBER] += 1
        told[AGE] += 1
        told[OWN] = -1
        told[LIGHT] = 0
        told[BEST] = MOST_COST
        node[root, STEPS] = 0
        node[root, WAY] = 0
        length = search(sources, 1, told, table, node, mark, slot, bucket, waiting, closed, path)
        if length == 0:
            continue
        touched[0] = 0
        turns, _ = _lead(path, length - 1, told, table, occupied, node, arrivals, touched, found, turned)
        if turns < 0:
            continue
        k = -1
        for j in range(table.shape[1]):
            target = root + table[OFFSET + (root & 1), j]
            if not node[root, MOVES] >> j & 1:
                continue
            if length > 1 and target == path[length - 2] >> 1:
                k = j
            if length == 1 and k < 0 and node[target, MOVES] & IS_DESTINATION:
                k = j
        node[root, PARENT] = k
        label(root, table, told[FIRST_VERTEX_MOVE], node)
        node[root, LOAD] = weight[i]
        add_load(root, weight[i], table, told[FIRST_VERTEX_MOVE], node)
