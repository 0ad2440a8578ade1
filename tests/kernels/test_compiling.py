"""Kernels are compiled by fewer steps than numba takes, and by numba's own where it is not as expected."""

from pathlib import Path

import trihex
import trihex as th
from tests.kernels.test_sources import run
from trihex.optimum import make_network
from trihex.planners import uses_of

SRC = Path(trihex.__file__).parents[1]
KERNEL = """
import logging, sys
logging.disable()
sys.modules.update(dict.fromkeys({hidden}))
{before}
from numba import types
from trihex.kernels.signatures import HELPER, IN_I64, kernel
@HELPER
def later(x, more):
    return x + more if more > 0 else x
@HELPER
def far(x):
    return later(x, 2) + later(x, 2.5)
@kernel(types.float64(IN_I64))
def total(values):
    found = 0.0
    for i in range(len(values)):
        found += far(values[i])
    return found
import numpy as np
libraries = {{type(made.library).__name__ for made in far.overloads.values()}}
print(total(np.arange(10)), total.nopython_signatures, *libraries)
"""


def made(hidden=(), before=""):
    return run(KERNEL.format(hidden=hidden, before=before), SRC).stdout.split()


def test_helpers_have_no_code_of_their_own_and_kernels_compute_the_same_either_way():
    ours, numbas = made(), made(hidden=("trihex.kernels.compiling",))
    assert ours[:-1] == numbas[:-1] and ours[0] == "135.0"
    assert (ours[-1], numbas[-1]) == ("_HelperLibrary", "JITCodeLibrary")
    assert made(before="from trihex.kernels.haste import hasten; hasten()") == ours


def test_without_the_options_that_numba_does_not_document_its_own_compiler_is_taken():
    before = "from numba.core.options import DefaultOptions; del DefaultOptions._nrt"
    value, *_, library = made(before=before)
    assert (value, library) == ("135.0", "JITCodeLibrary")


def test_optimal_prepares_the_way_that_it_takes():
    for shape, cost, way in (("hexagonal", 10, "earliest"), ("hexagonal", 7, "crowd"), ("triangular", 10, "crowd")):
        scenario = th.Scenario(th.Area(shape, [[0] * 6] * 5), [(0, 0)], [(3, 3)], waiting_cost=cost)
        assert uses_of("optimal", scenario) == ["optimal", f"optimal_{way}"]
        assert make_network(th.make_n_scheme(scenario), "time").has_equal_steps == (way == "earliest")
    assert uses_of("greedy", scenario) == ["greedy"]
