"""Memory: how much of it a planner may still take."""

import os

GIB = 1 << 30


def available_memory() -> int:
    """Return how many bytes of memory could be used now, or all that the machine has where that cannot be told."""
    try:
        with open("/proc/meminfo", encoding="ascii") as lines:
            found = [line for line in lines if line.startswith("MemAvailable:")]
        return int(found[0].split()[1]) * 1024
    except (OSError, IndexError):
        return int(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
