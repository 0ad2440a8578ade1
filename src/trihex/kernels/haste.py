"""Haste: what makes numba itself quicker, in a process that does nothing but compile."""

import gc
from typing import Any


def hasten() -> None:
    """Let numba remember what it finds out again and again; where it is made otherwise, leave it alone.

    It looks up the type of ``a + b`` among all that it knows to add, each time, and with each candidate compares all
    options of the function under way. What compiling makes is kept to the end, so that it is of no use to collect it
    time and again, either.
    """
    gc.freeze()
    gc.set_threshold(200_000, 50, 50)
    try:
        from numba.core import targetconfig, types

        function: Any = types.Function
        config: Any = targetconfig.TargetConfig
        plain, values = function.get_call_type, config.values
    except (ImportError, AttributeError):
        return
    known: dict[Any, Any] = {}

    def get_call_type(self: Any, context: Any, arguments: Any, named: Any) -> Any:
        if named:
            return plain(self, context, arguments, named)
        key = id(self), arguments
        if key not in known:
            known[key] = self, plain(self, context, arguments, named)  # with `self`, whose number is not given again
        return known[key][1]

    def equal(self: Any, other: Any) -> Any:
        if not isinstance(other, config):
            return NotImplemented
        return getattr(self, "_values", 0) == getattr(other, "_values", 1) or values(self) == values(other)

    function.get_call_type = get_call_type
    config.__eq__ = equal
    config.__hash__ = lambda self: len(self.options)
