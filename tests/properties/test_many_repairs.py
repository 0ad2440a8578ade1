"""Many random sequences of 20 changes: fields, directions and moves are at any time those of a fresh scenario.

``TRIHEX_SWEEPS=25 pytest tests/properties/test_many_repairs.py`` tries 10 000 of them.
"""

from dataclasses import replace

import numpy as np
import pytest

import trihex as th
from tests.strategies import random_scenario
from tests.sweeps import swept
from trihex.fields import LivingField

COUNT = swept(400)
SHARES, CHANGES = 4, 20


def draw_change(rng, barriers, destinations):
    """Change up to three cells of `barriers` and `destinations`, and return what was done as `change` takes it."""
    done = dict(blocked=[], freed=[], opened=[], closed=[])
    for cell in rng.choice(barriers.size, size=min(barriers.size, rng.integers(1, 4)), replace=False).tolist():
        if cell in destinations:
            if len(destinations) > 1:
                destinations.remove(cell)
                done["closed"].append(cell)
                if rng.random() < 0.3:
                    barriers.flat[cell] = True
                    done["blocked"].append(cell)
            continue
        done["freed" if barriers.flat[cell] else "blocked"].append(cell)
        barriers.flat[cell] ^= True
        if not barriers.flat[cell] and rng.random() < 0.3:
            destinations.append(cell)
            done["opened"].append(cell)
    return {name: np.array(cells, dtype=np.int64) for name, cells in done.items()}


@pytest.mark.parametrize("share", range(SHARES))
def test_repaired_equals_fresh_after_every_change(share):
    for seed in range(share, COUNT, SHARES):
        rng = np.random.default_rng(seed)
        scenario = random_scenario(seed, sides=(2, 16), most_robots=0)
        n_scheme = th.make_n_scheme(scenario)
        field = LivingField(scenario, n_scheme.distance_of_site, th.make_d_scheme(n_scheme).directions_of_site)
        barriers, destinations = scenario.area.barriers.copy(), scenario.destinations.tolist()
        for change in range(CHANGES):
            field.change(**draw_change(rng, barriers, destinations))
            area = replace(scenario.area, barriers=barriers)
            fresh = th.make_n_scheme(replace(scenario, area=area, destinations=np.array(destinations)))
            assert np.array_equal(field.distance_of_site, fresh.distance_of_site), (seed, change)
            directions = th.make_d_scheme(fresh).directions_of_site
            assert np.array_equal(field.directions_of_site, directions), (seed, change)
            assert np.array_equal(field.moves, fresh.scenario.moves), (seed, change)
