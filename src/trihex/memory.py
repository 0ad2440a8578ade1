"""Memory: how much of it a planner may still take."""

import os

from trihex.errors import PlanError, check_number

GIB = 1 << 30


def available_memory() -> int:
    """Return how many bytes of memory could be used now, or all that the machine has where that cannot be told."""
    try:
        with open("/proc/meminfo", encoding="ascii") as lines:
            found = [line for line in lines if line.startswith("MemAvailable:")]
        return int(found[0].split()[1]) * 1024
    except (OSError, IndexError):
        return int(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))


def limit_or_default(memory_limit: int | None) -> int:
    """Return the limit that the user set, in bytes, or else 80 % of what is available; PlanError if it is no number."""
    if memory_limit is not None:
        check_number("memory_limit, in bytes,", memory_limit, 0, float("inf"), PlanError)
    return available_memory() * 4 // 5 if memory_limit is None else memory_limit
