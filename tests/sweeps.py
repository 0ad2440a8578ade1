"""Sweep: how many of its cases a test tries.

``TRIHEX_SWEEPS=full pytest``, as in CI, tries as many as the tests say; a number in its place is a factor of that, such
as 25 for a long night. Without it they try a tenth, for an answer in minutes.
"""

import os

_WISH = os.environ.get("TRIHEX_SWEEPS", "0.1")
FACTOR = 1.0 if _WISH == "full" else float(_WISH)


def swept(full, least=1):
    """Return how many cases to try where CI tries `full`: never fewer than `least`, nor more than `full` because of it.

    It is a count of seeds or examples, or the end of a slice of things listed, the most telling one first.
    """
    return max(min(least, full), round(full * FACTOR))
