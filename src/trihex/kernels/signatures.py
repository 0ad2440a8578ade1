"""Signatures: the types that kernels declare, read-only where they read, plain where they fill; tuples with names."""

from functools import cache
from typing import Any

from numba import njit, types
from numba.core.options import DefaultOptions

from trihex.kernels import loading
from trihex.kernels.caching import keep
from trihex.kernels.compilers import compilers

if loading.is_alone:
    loading.load_numba_alone()


def _array(dtype, readonly):
    return types.Array(dtype, 1, "C", readonly=readonly)


def _table(dtype):
    return types.Array(dtype, 2, "C", readonly=True)


# A writable array is accepted where a read-only one is declared, not the other way round.
IN_BOOL = _array(types.boolean, True)
IN_U8 = _array(types.uint8, True)
IN_U16 = _array(types.uint16, True)
IN_I32 = _array(types.int32, True)
IN_I64 = _array(types.int64, True)
OUT_F64 = _array(types.float64, False)
OUT_I8 = _array(types.int8, False)
OUT_BOOL = _array(types.boolean, False)
OUT_U8 = _array(types.uint8, False)
OUT_U16 = _array(types.uint16, False)
OUT_I32 = _array(types.int32, False)
OUT_U32 = _array(types.uint32, False)
OUT_I64 = _array(types.int64, False)
TABLE_I32 = _table(types.int32)
TABLE_F64 = _table(types.float64)
MASK = types.Array(types.boolean, 2, "C", readonly=True)

# For functions that make no arrays. Whenever one calls another, numba counts references to all arrays that it hands
# over, as if they might be its own; where a search calls for each arc, that takes 3 to 7 times as long as all the rest.
# The option is not documented; numba without it is only slower.
UNCOUNTED: Any = {"_nrt": False} if hasattr(DefaultOptions, "_nrt") else {}

# A function that kernels call: it becomes part of its caller, which is as fast as if its lines stood there. It takes
# scratch arrays as arguments and makes none. Without any of these options, a helper that is called for each robot costs
# 2 to 25 times as much; numba's own `inline="always"` takes 30 s to compile where this takes 5.
_BARE: Any = {"nogil": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True, **UNCOUNTED}
_INLINED: Any = {"forceinline": True, **_BARE} if hasattr(DefaultOptions, "forceinline") else _BARE
_FOR_KERNELS, _FOR_HELPERS = compilers() if UNCOUNTED else ({}, {})  # ours count no references
HELPER: Any = njit(**_INLINED, **_FOR_HELPERS)
# The same for a function that is long and called seldom, so that its lines do not stand in the way of others.
APART: Any = njit(**_BARE, **_FOR_HELPERS)
_KERNEL: Any = {"nogil": True, "no_cfunc_wrapper": True, **UNCOUNTED, **_FOR_KERNELS}


def kernel(signature: Any, **options: Any) -> Any:
    """Declare a kernel that Python calls: kept on disk, without the interpreter's lock, no arrays made inside."""

    def declare(function: Any) -> Any:
        made = njit(**_KERNEL, **options)(function)
        if made is not function:  # it is under NUMBA_DISABLE_JIT
            keep(made)
            made.compile(signature)
            made.disable_compile()
        return made

    return declare


def declared(noun: type) -> Any:
    """Return numba's type of a NamedTuple whose annotations are numba's types.

    Names of such classes must be unique in all of trihex: numba takes two of the same name and types for one.
    """
    return types.BaseTuple.from_types(list(noun.__annotations__.values()), noun)


def given(noun: Any, *fields: Any, **named: Any) -> Any:
    """Return a NamedTuple just as it is declared, for a kernel: views that cannot be written to where it only reads.

    On its own an array that can be written to is taken where a read-only one is declared, but not in a tuple.
    """
    values = noun(*fields, **named)
    return noun._make([fit(value) for fit, value in zip(_fits_of(noun), values, strict=True)])


@cache
def _fits_of(noun):
    """Return what fits each field; found once, because to ask for the class of numba's types takes microseconds."""
    return [_fit_of(wanted) for wanted in noun.__annotations__.values()]


def _fit_of(wanted):
    if isinstance(wanted, types.Array):
        return _as_it_is if wanted.mutable else _for_reading
    return bool if wanted is types.boolean else int if isinstance(wanted, types.Integer) else _as_it_is


def _as_it_is(value):
    return value


def _for_reading(array):
    if array.flags.writeable:
        array = array.view()
        array.flags.writeable = False
    return array
