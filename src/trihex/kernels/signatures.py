"""The array types that kernels declare: read-only where they read, plain where they fill."""

from typing import Any

from numba import types
from numba.core.options import DefaultOptions

from trihex.kernels import loading

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
OUT_BOOL = _array(types.boolean, False)
OUT_U8 = _array(types.uint8, False)
OUT_U16 = _array(types.uint16, False)
OUT_I32 = _array(types.int32, False)
OUT_I64 = _array(types.int64, False)
TABLE_I32 = _table(types.int32)
MASK = types.Array(types.boolean, 2, "C", readonly=True)

# For functions that make no arrays. Whenever one calls another, numba counts references to all arrays that it hands
# over, as if they might be its own; where a search calls for each arc, that takes 3 to 7 times as long as all the rest.
# The option is not documented; numba without it is only slower.
UNCOUNTED: Any = {"_nrt": False} if hasattr(DefaultOptions, "_nrt") else {}
