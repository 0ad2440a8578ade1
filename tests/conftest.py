"""All kernels are compiled once, side by side, before the first test; then workers find them on disk."""

from itertools import product

from trihex.areas import COSTS, NEIGHBOURHOODS, TESSELLATIONS, Tessellation
from trihex.fields import field_kernels
from trihex.kernels.needs import KERNELS_OF
from trihex.kernels.preparing import prepare


def pytest_configure(config):
    """Compile what the disk lacks, in the process that starts the workers."""
    if not hasattr(config, "workerinput"):
        shapes = product(TESSELLATIONS, NEIGHBOURHOODS, COSTS, ("allow", "no-cut"))
        prepare(*KERNELS_OF, *{field_kernels(Tessellation(*shape), corners) for *shape, corners in shapes})
