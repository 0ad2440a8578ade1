"""Branches: robots that share their gates evenly, the way `fcost` estimates congestion at its best."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from trihex.plan import Plan
from trihex.planners.recording import Recording
from trihex.schemes import NOT_REACHED, NScheme, make_d_scheme


def run_branches(n_scheme, progress=None, period=32, effort=0.5, visits=1000, first=2.0, lanes=0.5, more=3, info=None):
    from trihex.kernels import branches as forest
    from trihex.kernels import branches_balance as balancing
    from trihex.kernels import branches_search as searching
    from trihex.kernels import branches_steps as stepping

    scenario = n_scheme.scenario
    area = scenario.area
    layout, tessellation = area.layout, area.tessellation
    destinations = layout.cell_to_site(scenario.destinations)
    sites = layout.cell_to_site(scenario.robots)
    distance = n_scheme.distance_of_site[sites]
    going = np.flatnonzero((distance != NOT_REACHED) & (distance != 0)).astype(np.int32)
    going = going[np.argsort(-distance[going].astype(np.int64), kind="stable")]
    starts = sites[going]
    best = make_d_scheme(n_scheme).directions_of_site
    forbids = scenario.crossing == "forbid"
    fv = tessellation.edge_count if forbids else tessellation.direction_count
    K = tessellation.direction_count
    offset = layout.offset_of_direction
    reverse = np.empty((2, K), dtype=np.int32)
    for p in range(2):
        for k in range(K):
            reverse[p, k] = np.flatnonzero(offset[(p + offset[p, k]) & 1] == -offset[p, k])[0]
    table = np.concatenate([offset, layout.vertex_of_direction, reverse, tessellation.cost_of_direction[None]]).astype(
        np.int32
    )
    node = np.empty((layout.size, forest.COLUMNS), dtype=np.int32)
    forest.fill_nodes(scenario.moves, n_scheme.distance_of_site, destinations, node)
    gate_sites = np.empty(3 * K * destinations.size, dtype=np.int32)
    destination_of_gate = np.empty(K * destinations.size, dtype=np.int64)
    gates = forest.number_gates(destinations, table, fv, node, gate_sites, destination_of_gate)
    gate_sites = gate_sites[: 3 * gates]
    destination_of_gate = destination_of_gate[:gates]
    grown = np.empty(area.free_count, dtype=np.int32)
    count = forest.grow(starts, best, table, node, grown, 0)
    order = np.empty(area.free_count, dtype=np.int32)
    forest.settle(starts, grown[:count], table, fv, node, order)

    w_t = scenario.waiting_cost
    told = np.zeros(searching.TOLD, dtype=np.int64)
    told[searching.WAITING_COST] = min(w_t, 64 * int(tessellation.cost_of_direction.max()))
    told[searching.MOST_VISITS] = visits
    told[searching.FIRST_VERTEX_MOVE] = fv
    mark = np.zeros((layout.size, searching.MARK_COLUMNS), dtype=np.int32)
    bucket = np.full(searching.BUCKETS, -1, dtype=np.int64)
    waiting = np.empty((8 * visits, 3), dtype=np.int64)
    told[searching.WIDTH] = tessellation.edge_cost
    closed = np.empty(visits + 1, dtype=np.int64)
    path = np.empty(visits + 100, dtype=np.int64)
    found = order
    turned = np.empty((visits + 100, 7), dtype=np.int32)
    sources = np.empty(100, dtype=np.int32)
    touched = np.zeros(visits + 100, dtype=np.int64)
    occupied = np.zeros(layout.size, dtype=bool)
    T = 2 * int(node[starts, forest.STEPS].max(initial=0)) + 64
    arrivals = np.zeros((gates, T), dtype=np.int32)
    slot = np.tile(np.arange(T, dtype=np.int32), (gates, 1))
    queue = np.zeros((gates, balancing.QUEUE_COLUMNS), dtype=np.int64)

    if lanes:
        g = grown[:count]
        k = node[g, forest.PARENT]
        parent = g + offset[g & 1, k]
        dest = destination_of_gate[node[g, forest.BRANCH]]
        load = node[g, forest.LOAD]
        is_d = (node[parent, forest.MOVES] & forest.IS_DESTINATION) > 0
        robots_of = np.bincount(destination_of_gate[node[starts, forest.BRANCH]], minlength=destinations.size)
        gates_of = np.bincount(destination_of_gate, minlength=destinations.size)
        most = np.maximum(1, lanes * robots_of / np.maximum(gates_of, 1))
        is_root = (
            (load <= most[dest]) & (is_d | (node[parent, forest.LOAD] > most[dest])) & (robots_of > gates_of)[dest]
        )
        roots = g[is_root]
        rd = dest[is_root]
        rl = load[is_root]
        o = np.lexsort((roots, -rl, rd))
        roots, rd, rl = roots[o], rd[o], rl[o]
        rank = np.arange(rd.size) - np.searchsorted(rd, rd)
        keep = rank < more * gates_of[rd]
        roots, rl = roots[keep], rl[keep]
        node[:, forest.LOAD] = 0
        node[:, forest.PARENT] = -1
        node[:, forest.PASSING] = 0
        told[searching.ONLY_FREE_GATES] = 1
        balancing.lay_lanes(
            roots.astype(np.int32),
            rl.astype(np.int32),
            told,
            table,
            occupied,
            node,
            mark,
            arrivals,
            slot,
            touched,
            found,
            sources,
            turned,
            bucket,
            waiting,
            closed,
            path,
        )
        told[searching.ONLY_FREE_GATES] = 0
        lane = np.flatnonzero(node[:, forest.LOAD] > 0).astype(np.int32)
        node[node[:, forest.LOAD] == 0, forest.PARENT] = -1
        grown[: lane.size] = lane
        count = forest.grow(starts, best, table, node, grown, lane.size)
        forest.settle(starts, grown[:count], table, fv, node, order)
        if info is not None:
            info["lanes"] = (roots.size, int((node[lane, forest.STEPS] == 1).sum()), int(told[searching.VISITS]))
    occupied[starts] = True
    recording = Recording(scenario, going.size)
    listed = np.stack([starts, going]).astype(np.int32)
    spare = np.empty_like(listed)
    passed = np.zeros(layout.size if forbids else 0, dtype=np.int32)
    capacity = scenario.destination_capacity or 0
    entered = np.zeros(layout.size if capacity else 0, dtype=np.int64)
    step, active = 0, going.size
    budget = first * node[starts, forest.STEPS].sum() * effort
    told[searching.VISITS] = 0
    while active:
        if w_t > 0:
            stepping.count_arrivals(listed, active, node, arrivals)
            queue[:] = 0
            queue[:, balancing.TRIED] = searching.MOST_COST
            for b in range(gates):
                balancing.fill_slots(arrivals, b, slot, queue)
            before = told[searching.VISITS]
            told[searching.VISITS] = 0
            balancing.balance(
                int(budget),
                gate_sites,
                told,
                table,
                w_t,
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
            )
            if info is not None:
                info.setdefault("visits", []).append(int(told[searching.VISITS]))
                info.setdefault("predicted", []).append(int(queue[:, 0].sum()))
        stepping.order_robots(listed, active, node, spare)
        budget = effort * period * active
        step, active, steps = stepping.follow(
            table,
            fv,
            capacity,
            step,
            active,
            step + period,
            occupied,
            passed,
            entered,
            node,
            listed,
            spare,
            *recording.new_log(),
            recording.arrival,
        )
        recording.keep(steps)
        if progress:
            progress(going.size - active, going.size)
    return recording.make_plan("fcost")
