"""Branches: the trees along which robots flow to the gates of their destinations.

A *gate* is where one robot a step can enter a destination: a site across an edge of it, or one of its lattice vertices.
A *branch* is the tree of sites that lead to one gate. Robots that step to the parent of their site whenever it is free
serve their gate without a gap, so that the arrivals of a branch depend on nothing but how many steps away its robots
are (docs/planners.md). ``node[site]`` is a row of numbers, see the constants; a site is in a branch if and only if its
LOAD, the number of robots that will come through it, is positive.
"""

from numba import njit, types

from trihex.kernels.signatures import IN_BOOL, IN_I32, IN_U16, OUT_I32, OUT_I64

# MOVES: open directions, and IS_DESTINATION. DISTANCE: least cost to a destination. PARENT: the direction robots take,
# -1 for none. BRANCH: number of the gate. STEPS, WAY: number and cost of the moves from here to the destination.
# SITE_GATE: number of the gate if the site is one, else -1. Two rows belong to the lattice vertex of the same number:
# PASSING, the number of robots that will pass it, and VERTEX_GATE.
MOVES, DISTANCE, LOAD, PARENT, BRANCH, STEPS, WAY, SITE_GATE, PASSING, VERTEX_GATE = range(10)
COLUMNS = 10
IS_DESTINATION = 1 << 14
# Rows of `table`, each for all directions; the first six for the two parities.
OFFSET, VERTEX, REVERSE, COST = 0, 2, 4, 6

GRID = types.Array(types.int32, 2, "C")
TABLE = types.Array(types.int32, 2, "C", readonly=True)


@njit(types.void(IN_U16, IN_I32, IN_I32, GRID), cache=True, nogil=True, _nrt=False)
def fill_nodes(moves, distance, destinations, node):
    """Start an empty forest."""
    for site in range(len(moves)):
        node[site, MOVES] = moves[site]
        node[site, DISTANCE] = distance[site]
        node[site, LOAD] = 0
        node[site, PARENT] = -1
        node[site, SITE_GATE] = -1
        node[site, PASSING] = 0
        node[site, VERTEX_GATE] = -1
    for site in destinations:
        node[site, MOVES] |= IS_DESTINATION


@njit(types.int64(IN_I32, TABLE, types.int64, GRID, OUT_I32, OUT_I64), cache=True, nogil=True, _nrt=False)
def number_gates(destinations, table, first_vertex_move, node, gate_sites, destination_of_gate):
    """Number the gates and list up to three sites of each, -1 for none; return how many there are."""
    gates = 0
    for d in range(len(destinations)):
        destination = destinations[d]
        parity = destination & 1
        for k in range(table.shape[1]):
            if not node[destination, MOVES] >> k & 1:
                continue
            site = destination + table[OFFSET + parity, k]
            if node[site, MOVES] & IS_DESTINATION:
                continue
            if k < first_vertex_move:
                gate = node[site, SITE_GATE]
            else:
                gate = node[destination + table[VERTEX + parity, k], VERTEX_GATE]
            if gate < 0:
                gate = gates
                gates += 1
                destination_of_gate[gate] = d
                gate_sites[3 * gate : 3 * gate + 3] = -1
            if k < first_vertex_move:
                node[site, SITE_GATE] = gate
            else:
                node[destination + table[VERTEX + parity, k], VERTEX_GATE] = gate
            for i in range(3 * gate, 3 * gate + 3):
                if gate_sites[i] == site:
                    break
                if gate_sites[i] < 0:
                    gate_sites[i] = site
                    break
    return gates


@njit(types.int64(types.int64, types.int64, TABLE, types.int64, GRID), cache=True, nogil=True, _nrt=False)
def gate_of_move(site, k, table, first_vertex_move, node):
    """Return the number of the gate through which direction k enters a destination."""
    if k < first_vertex_move:
        return node[site, SITE_GATE]
    return node[site + table[VERTEX + (site & 1), k], VERTEX_GATE]


@njit(types.int64(IN_I32, IN_U16, TABLE, GRID, OUT_I32, types.int64), cache=True, nogil=True, _nrt=False)
def grow(starts, best, table, node, grown, count):
    """Give parents to the sites from `starts` down to the branches that stand, by best directions; return the count.

    Of tied directions, one that leads into a destination is taken first, then one to a site that no branch has yet:
    what merges late can be served by many gates. The sites that were given parents are appended to `grown`.
    """
    for i in range(len(starts)):
        site = starts[i]
        while node[site, PARENT] < 0 and not node[site, MOVES] & IS_DESTINATION:
            parity = site & 1
            chosen = -1
            rank = 4
            for k in range(table.shape[1]):
                if best[site] >> k & 1:
                    target = site + table[OFFSET + parity, k]
                    worth = 2 if node[target, PARENT] >= 0 else 1
                    if node[target, MOVES] & IS_DESTINATION:
                        worth = 0
                    if worth < rank:
                        rank = worth
                        chosen = k
            node[site, PARENT] = chosen
            grown[count] = site
            count += 1
            site += table[OFFSET + parity, chosen]
    return count


@njit(types.void(types.int64, TABLE, types.int64, GRID), cache=True, nogil=True, _nrt=False)
def label(site, table, first_vertex_move, node):
    """Set branch, steps and way of a site from those of its parent."""
    k = node[site, PARENT]
    parent = site + table[OFFSET + (site & 1), k]
    if node[parent, MOVES] & IS_DESTINATION:
        node[site, BRANCH] = gate_of_move(site, k, table, first_vertex_move, node)
        node[site, STEPS] = 1
        node[site, WAY] = table[COST, k]
    else:
        node[site, BRANCH] = node[parent, BRANCH]
        node[site, STEPS] = node[parent, STEPS] + 1
        node[site, WAY] = node[parent, WAY] + table[COST, k]


@njit(types.void(IN_I32, IN_I32, TABLE, types.int64, GRID, OUT_I32), cache=True, nogil=True, _nrt=False)
def settle(starts, grown, table, first_vertex_move, node, order):
    """Compute load, branch, steps and way of all sites `grown` and the vertices they pass; `order` is for work.

    Loads are summed leaves first; meanwhile BRANCH counts the children that are still to come.
    """
    for site in grown:
        node[site, LOAD] = 0
        node[site, BRANCH] = 0
    for site in starts:
        node[site, LOAD] = 1
    for site in grown:
        k = node[site, PARENT]
        node[site + table[OFFSET + (site & 1), k], BRANCH] += 1
        if k >= first_vertex_move:
            node[site + table[VERTEX + (site & 1), k], PASSING] = 0
    last = 0
    for site in grown:
        if node[site, BRANCH] == 0:
            order[last] = site
            last += 1
    for i in range(len(grown)):
        site = order[i]
        k = node[site, PARENT]
        if k >= first_vertex_move:
            node[site + table[VERTEX + (site & 1), k], PASSING] += node[site, LOAD]
        parent = site + table[OFFSET + (site & 1), k]
        if not node[parent, MOVES] & IS_DESTINATION:
            node[parent, LOAD] += node[site, LOAD]
            node[parent, BRANCH] -= 1
            if node[parent, BRANCH] == 0:
                order[last] = parent
                last += 1
    for i in range(len(grown) - 1, -1, -1):
        label(order[i], table, first_vertex_move, node)


@njit(types.int64(types.int64, TABLE, GRID, OUT_I32), cache=True, nogil=True, _nrt=False)
def gather(site, table, node, found):
    """List the sites of the branch from which robots come through `site`, itself first; return how many."""
    found[0] = site
    count = 1
    i = 0
    while i < count:
        here = found[i]
        i += 1
        parity = here & 1
        for k in range(table.shape[1]):
            if node[here, MOVES] >> k & 1:
                child = here + table[OFFSET + parity, k]
                if node[child, LOAD] > 0 and node[child, PARENT] == table[REVERSE + parity, k]:
                    found[count] = child
                    count += 1
    return count


@njit(types.void(types.int64, types.int64, TABLE, types.int64, GRID), cache=True, nogil=True, _nrt=False)
def add_load(site, load, table, first_vertex_move, node):
    """Add `load` to all sites below `site` and the vertices passed on the way down from it."""
    while True:
        k = node[site, PARENT]
        if k >= first_vertex_move:
            node[site + table[VERTEX + (site & 1), k], PASSING] += load
        site += table[OFFSET + (site & 1), k]
        if node[site, MOVES] & IS_DESTINATION:
            return
        node[site, LOAD] += load


@njit(types.boolean(types.int64, types.int64, TABLE, GRID), cache=True, nogil=True, _nrt=False)
def is_below(site, start, table, node):
    """Tell whether the way down from `start` comes through `site`."""
    while not node[start, MOVES] & IS_DESTINATION:
        if start == site:
            return True
        start += table[OFFSET + (start & 1), node[start, PARENT]]
    return False


@njit(
    types.boolean(types.int64, types.int64, TABLE, types.int64, IN_BOOL, GRID, GRID, OUT_I64, OUT_I32),
    cache=True,
    nogil=True,
    _nrt=False,
)
def turn(site, k, table, first_vertex_move, occupied, node, arrivals, touched, found):
    """Let `site` and all that comes through it take direction k; False, and nothing done, if that makes a circle.

    ``arrivals[branch, steps]`` follows; the branches concerned are added to the list `touched`, after its length.
    """
    load = node[site, LOAD]
    if load == 0:
        node[site, PARENT] = k
        label(site, table, first_vertex_move, node)
        return True
    if is_below(site, site + table[OFFSET + (site & 1), k], table, node):
        return False
    old, steps, way = node[site, BRANCH], node[site, STEPS], node[site, WAY]
    add_load(site, -load, table, first_vertex_move, node)
    node[site, PARENT] = k
    add_load(site, load, table, first_vertex_move, node)
    label(site, table, first_vertex_move, node)
    new, more_steps, more_way = node[site, BRANCH], node[site, STEPS] - steps, node[site, WAY] - way
    node[site, STEPS] = steps
    node[site, WAY] = way
    last = arrivals.shape[1] - 1
    for i in range(gather(site, table, node, found)):
        here = found[i]
        if occupied[here]:
            arrivals[old, min(node[here, STEPS], last)] -= 1
            arrivals[new, min(node[here, STEPS] + more_steps, last)] += 1
        node[here, BRANCH] = new
        node[here, STEPS] += more_steps
        node[here, WAY] += more_way
    for branch in (old, new):
        is_new = True
        for i in range(touched[0]):
            is_new &= touched[1 + i] != branch
        if is_new:
            touched[0] += 1
            touched[touched[0]] = branch
    return True
