"""How near the bounds come to the optimum where moves last: ``python -m tests.oracles.gaps``.

Small crowded scenarios of all tessellations are solved as integer programs under both clocks and both rules of
following. It prints the rows of the table in docs/bounds.md: how often the relaxed program and our best bound are equal
to the optimum, and how large they are beside it on the whole.
"""

import argparse
from collections import defaultdict
from itertools import product

import trihex as th
from tests.oracles.timed import solve_timed, with_time
from tests.strategies import random_scenario

TIMES = list(product(("steps", "costs"), ("allow", "forbid")))


def crowded_scenario(seed, *, sides=(3, 6), most_robots=10):
    """Return a scenario in which waiting costs as is usual, for `with_time`."""
    return random_scenario(seed, sides=sides, most_robots=most_robots, waiting_costs=(None,))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--count", type=int, default=60, help="how many scenarios")
    parser.add_argument("--first", type=int, default=0, help="the seed of the first of them")
    parser.add_argument("--sides", type=int, default=6, help="the greatest height and width")
    parser.add_argument("--robots", type=int, default=10, help="the most robots")
    given = parser.parse_args()
    rows = defaultdict(list)
    for seed in range(given.first, given.first + given.count):
        drawn = crowded_scenario(seed, sides=(3, given.sides), most_robots=given.robots)
        for time in TIMES:
            scenario = with_time(drawn, *time)
            _, relaxed, least, _ = solve_timed(scenario)
            n_scheme = th.make_n_scheme(scenario)
            distance, bound = th.distance_bound(n_scheme).value, th.make_lower_bound(n_scheme).value
            assert bound <= least and relaxed <= least + 1e-6, seed
            if least > distance:  # else there is nothing to find out
                tessellation = scenario.area.tessellation
                kind = f"{tessellation.name} {tessellation.direction_count}"
                rows[kind, *time].append((distance / least, bound / least, relaxed / least))
    print("| cells | clock | following | crowded | distance | bound | LP | bound = optimum | LP = optimum |")
    print("|---|---|---|---|---|---|---|---|---|")
    for key in sorted(rows):
        shares = [sum(column) / len(rows[key]) for column in zip(*rows[key], strict=True)]
        equal = [sum(row[i] > 1 - 1e-9 for row in rows[key]) for i in (1, 2)]
        print("|", " | ".join(map(str, [*key, len(rows[key]), *(f"{share:.3f}" for share in shares), *equal])), "|")


if __name__ == "__main__":
    main()
