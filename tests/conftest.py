"""What holds for all tests: kernels are compiled once, before the first test; hypothesis measures no time.

A busy machine is no fault.
"""

from hypothesis import HealthCheck, settings

from trihex.fields import every_field_kernels
from trihex.kernels.needs import KERNELS_OF
from trihex.kernels.preparing import prepare

settings.register_profile("any machine", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("any machine")


def pytest_configure(config):
    """Compile what the disk lacks side by side, in the process that starts the workers; they find it on disk."""
    if not hasattr(config, "workerinput"):
        prepare(*KERNELS_OF, *every_field_kernels())
