"""Fields: N-scheme and D-scheme beside scipy, tcod and dijkstra3d.

What counts as whose work: ours is all of `make_n_scheme`, from the barriers to the record; of the others the solve
alone, without building the graph (scipy, 3 times its solve) or converting the barriers.
"""

import argparse
from collections.abc import Callable
from typing import Any

import numpy as np

import trihex as th
from benchmarks.measure import cpu_seconds, exponent, machine
from trihex.kernels.codes import NOT_REACHED

AREAS = {"random": th.make_random_area, "rooms": th.make_rooms_area, "maze": th.make_maze_area}
TESSELLATIONS = ("square", "hexagonal", "triangular")


def scipy_solver(scenario: th.Scenario) -> Callable[[], Any]:
    """Return scipy's Dijkstra on the graph of `scenario`, built here row by row of the matrix."""
    from scipy.sparse import csr_matrix
    from scipy.sparse.csgraph import dijkstra

    area, layout, tessellation = scenario.area, scenario.area.layout, scenario.area.tessellation
    sites = layout.cell_to_site(np.flatnonzero(~area.barriers))
    number = np.full(layout.size, -1, dtype=np.int32)
    number[sites] = np.arange(sites.size)
    moves = scenario.moves[sites]
    degree = sum(moves >> k & 1 for k in range(tessellation.direction_count))
    first = np.concatenate([[0], np.cumsum(degree, dtype=np.int64)])
    heads, costs = np.empty(first[-1], dtype=np.int32), np.empty(first[-1])
    at = first[:-1].copy()
    for k in range(tessellation.direction_count):
        is_open = (moves >> k & 1).astype(bool)
        heads[at[is_open]] = number[sites[is_open] + layout.offset_of_direction[sites[is_open] & 1, k]]
        costs[at[is_open]] = tessellation.cost_of_direction[k]
        at[is_open] += 1
    graph = csr_matrix((costs, heads, first.astype(np.int32)), shape=(sites.size, sites.size))
    sources = number[layout.cell_to_site(scenario.destinations)]
    return lambda: dijkstra(graph, indices=sources, min_only=True)


def tcod_solver(scenario: th.Scenario) -> Callable[[], Any]:
    """Return tcod's Dijkstra: on squares its 2-D one, on hexagons the same on a sheared array, else its pathfinder."""
    import tcod.path

    barriers = scenario.area.barriers
    x, y = (int(axis[0]) for axis in scenario.area.cell_to_xy(scenario.destinations))
    if scenario.area.tessellation.name == "triangular":
        free = (~barriers).astype(np.int8)
        rows, columns = np.indices(barriers.shape)
        orientation = (rows + columns) & 1
        graph = tcod.path.CustomGraph(barriers.shape)
        tessellation = scenario.area.tessellation
        for o in (0, 1):
            mask = (orientation == o).astype(np.int8)
            for (dx, dy), cost in zip(
                tessellation.step_of_direction[o].tolist(), tessellation.cost_of_direction.tolist(), strict=True
            ):
                graph.add_edge((dy, dx), cost, cost=free, condition=mask)

        def pathfinder() -> Any:
            finder = tcod.path.Pathfinder(graph)
            finder.add_root((y, x))
            finder.resolve()
            return finder.distance

        return pathfinder
    if scenario.area.tessellation.name == "hexagonal":
        height, width = barriers.shape
        shift = (width - 1) // 2 - (np.arange(width) - (np.arange(width) & 1)) // 2
        free = np.zeros((height + (width - 1) // 2, width), dtype=np.int8)
        rows, columns = np.indices(barriers.shape)
        free[rows + shift, columns] = ~barriers
        y += int(shift[x])
        edges = [[0, 10, 10], [10, 0, 10], [10, 10, 0]]
    else:
        free = (~barriers).astype(np.int8)
        edges = [[14, 10, 14], [10, 0, 10], [14, 10, 14]]

    def dijkstra2d() -> Any:
        distance = np.full(free.shape, NOT_REACHED, dtype=np.int32)
        distance[y, x] = 0
        return tcod.path.dijkstra2d(distance, free, edge_map=edges, out=distance)

    return dijkstra2d


def dijkstra3d_solver(scenario: th.Scenario) -> Callable[[], Any]:
    """Return dijkstra3d's field, squares only, with diagonals of 1.414 in float32."""
    import dijkstra3d

    free = np.asfortranarray(~scenario.area.barriers)[:, :, np.newaxis]
    x, y = (int(axis[0]) for axis in scenario.area.cell_to_xy(scenario.destinations))
    return lambda: dijkstra3d.euclidean_distance_field(free, (y, x, 0))


def make_scenario(kind: str, tessellation: str, size: int) -> th.Scenario:
    """Return an area of size x size with one destination, the free cell nearest to its middle."""
    area = AREAS[kind](tessellation, size, size, seed=1)
    free = np.flatnonzero(~area.barriers)
    return th.Scenario(area, free[[np.argmin(np.abs(free - (size * size + size) // 2))]])


def compare(kind: str, tessellation: str, size: int, repeats: int) -> None:
    """Print a line: million cells reached a second, and how many times as long the others take for the N-scheme."""
    scenario = make_scenario(kind, tessellation, size)
    n_scheme = th.make_n_scheme(scenario)
    reached = n_scheme.distance[n_scheme.distance < NOT_REACHED]
    solvers = {"scipy": scipy_solver(scenario), "tcod": tcod_solver(scenario)}
    if tessellation == "square":
        solvers["dijkstra3d"] = dijkstra3d_solver(scenario)
    theirs = solvers["scipy"]()
    if theirs[np.isfinite(theirs)].sum() != reached.sum():
        raise AssertionError("scipy and trihex disagree")
    ours = {"N": lambda: th.make_n_scheme(scenario), "D": lambda: th.make_d_scheme(n_scheme)}
    seconds = cpu_seconds(solvers | ours, repeats)
    rate = {name: reached.size / value / 1e6 for name, value in seconds.items()}
    line = f"{kind:7} {tessellation:11} {size:5} {rate['N']:7.1f} {rate['D']:7.0f}"
    for name in solvers:
        line += f" {rate[name]:7.2f} {rate['N'] / rate[name]:6.1f}x"
    print(line, flush=True)


def growth(tessellation: str, sizes: list[int], repeats: int) -> None:
    """Print the exponents with which the times of the N-scheme and the D-scheme grow in the number of cells b."""
    times: dict[str, list[float]] = {"N": [], "D": []}
    for size in sizes:
        scenario = make_scenario("random", tessellation, size)
        n_scheme = th.make_n_scheme(scenario)
        ours = {"N": lambda s=scenario: th.make_n_scheme(s), "D": lambda n=n_scheme: th.make_d_scheme(n)}
        for name, value in cpu_seconds(ours, repeats).items():
            times[name].append(value)
    cells = [size * size for size in sizes]
    both = ", ".join(f"{name}-scheme b^{exponent(cells, values):.2f}" for name, values in times.items())
    print(f"growth  {tessellation:11} {sizes[0]}..{sizes[-1]}: {both}", flush=True)


def roof(size: int) -> None:
    """Print how many cells a second memory lets pass: 1 byte read and 4 written (N), 4 read and 2 written (D)."""
    here = np.ones((size, size), dtype=np.int64)
    there = here.copy()
    seconds = cpu_seconds({"copy": lambda: np.copyto(there, here)}, 9)["copy"]
    bandwidth = 2 * here.nbytes / seconds
    print(
        f"roof    memory copies at {bandwidth / 1e9:.1f} GB/s: "
        f"at most {bandwidth / 5e6:.0f} Mcells/s (N), {bandwidth / 6e6:.0f} Mcells/s (D)"
    )


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks fields")
    parser.add_argument("--kinds", nargs="*", default=list(AREAS), choices=list(AREAS))
    parser.add_argument("--tessellations", nargs="*", default=list(TESSELLATIONS), choices=TESSELLATIONS)
    parser.add_argument("--sizes", nargs="*", type=int, default=[512, 2048, 4096])
    parser.add_argument("--repeats", type=int, default=5)
    options = parser.parse_args(arguments)
    print(machine("scipy", "tcod", "dijkstra3d"))
    print("Million cells reached per CPU second; behind each library, how many times as long it takes as the N-scheme.")
    print("area    tessellation size       N       D   scipy  ratio    tcod  ratio  dijkstra3d ratio", flush=True)
    for kind in options.kinds:
        for size in options.sizes:
            for tessellation in options.tessellations:
                compare(kind, tessellation, size, options.repeats)
    roof(max(options.sizes))
    for tessellation in options.tessellations:
        growth(tessellation, [256, 512, 1024, 2048, 4096], options.repeats)
