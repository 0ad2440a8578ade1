"""What holds for all tests: kernels are compiled once, before the first test; hypothesis measures no time.

A busy machine is no fault.
"""

from itertools import product

from hypothesis import HealthCheck, settings

from trihex.areas import COSTS, NEIGHBOURHOODS, TESSELLATIONS, Tessellation
from trihex.fields import field_kernels
from trihex.kernels.needs import KERNELS_OF
from trihex.kernels.preparing import prepare

settings.register_profile("any machine", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("any machine")


def pytest_configure(config):
    """Compile what the disk lacks side by side, in the process that starts the workers; they find it on disk."""
    if not hasattr(config, "workerinput"):
        shapes = product(TESSELLATIONS, NEIGHBOURHOODS, COSTS, ("allow", "no-cut"))
        prepare(*KERNELS_OF, *{field_kernels(Tessellation(*shape), corners) for *shape, corners in shapes})
