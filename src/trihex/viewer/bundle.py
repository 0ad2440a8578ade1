"""Bundle: a JSON header with arrays in one string of bytes, the language between page and Python.

Layout: 8 bytes `MAGIC`; the length of the JSON text as little-endian uint32, 4 bytes 0; the JSON text
``{"header": {...}, "arrays": {name: [type, length]}}``; the arrays in that order. Each part starts at a multiple of 8.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trihex.errors import FormatError

MAGIC = b"trihex1\n"
# What JavaScript's typed arrays hold as well.
_TYPES: dict[str, np.dtype[Any]] = {
    "u1": np.dtype("<u1"),
    "u2": np.dtype("<u2"),
    "i4": np.dtype("<i4"),
    "f8": np.dtype("<f8"),
}
_MAX_JSON = 2**20


class Bundle(NamedTuple):
    """A header and its arrays, each flat."""

    header: dict[str, Any]
    arrays: dict[str, NDArray[Any]]


def encode(header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]] | None = None) -> bytes:
    """Return a bundle as bytes; arrays must be of one of the four types, and are flattened.

    Examples
    --------
    >>> decode(encode({"op": "plan"}, {"robots": np.arange(3, dtype=np.int32)})).arrays["robots"]
    array([0, 1, 2], dtype=int32)
    """
    flat = {name: np.ascontiguousarray(array).reshape(-1) for name, array in (arrays or {}).items()}
    kinds: dict[str, tuple[str, int]] = {
        name: (f"{array.dtype.kind}{array.dtype.itemsize}", array.size) for name, array in flat.items()
    }
    text = json.dumps({"header": dict(header), "arrays": kinds}, allow_nan=False).encode()
    parts = [MAGIC, struct.pack("<II", len(text), 0), _padded(text)]
    parts += [_padded(array.astype(_TYPES[kinds[name][0]], copy=False).tobytes()) for name, array in flat.items()]
    return b"".join(parts)


def decode(content: bytes) -> Bundle:
    """Return what `encode` put together; the arrays are read-only.

    Raises
    ------
    FormatError
        If the bytes are no bundle.
    """
    if content[:8] != MAGIC or len(content) < 16:
        raise FormatError("a bundle must begin with its mark and a length")
    length = struct.unpack_from("<I", content, 8)[0]
    if length > _MAX_JSON or 16 + length > len(content):
        raise FormatError(f"the header of a bundle must be at most {_MAX_JSON} bytes and whole, not {length}")
    try:
        frame = json.loads(content[16 : 16 + length])
        header, kinds = frame["header"], frame["arrays"]
        entries: list[tuple[str, np.dtype[Any], Any]] = [
            (str(name), _TYPES[kind], size) for name, (kind, size) in kinds.items()
        ]
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        raise FormatError("the header of a bundle must be JSON with header and arrays") from None
    if not isinstance(header, dict):
        raise FormatError("the header of a bundle must be an object")
    at, arrays = 16 + _whole(length), {}
    for name, dtype, size in entries:
        if isinstance(size, bool) or not isinstance(size, int) or not 0 <= size <= len(content):
            raise FormatError(f"array {name!r:.40} of a bundle must have a length, not {size!r:.40}")
        if at + size * dtype.itemsize > len(content):
            raise FormatError(f"array {name!r:.40} of a bundle is cut off")
        arrays[name] = np.frombuffer(content, dtype=dtype, count=size, offset=at)
        at += _whole(size * dtype.itemsize)
    return Bundle(header, arrays)


def _whole(length: int) -> int:
    return (length + 7) // 8 * 8


def _padded(part: bytes) -> bytes:
    return part + bytes(_whole(len(part)) - len(part))
