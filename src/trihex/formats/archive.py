"""Archive: arrays, numbers and text as the entries of an .npz file, looked at before they are unpacked."""

from __future__ import annotations

import os
import zipfile
from collections.abc import Callable
from io import BytesIO
from math import prod
from typing import Any

import numpy as np
from numpy.lib import format as npy

from trihex.errors import FormatError
from trihex.files import new_file

# What a file may unpack to: an area of 10^9 cells and as many robot-steps.
MAX_UNPACKED = 2**32
_PIECE = 2**22
# Packs actions three times as fast as level 6 does, 16 % larger.
_LEVEL = 4
# Kind of number and number of axes of each entry.
Entries = dict[str, tuple[str, int]]
_LARGEST_ITEM = {"i": 8, "b": 1, "u": 1, "f": 8, "U": 4096}


def pack(
    arrays: dict[str, Any], path: str | os.PathLike[str], progress: Callable[[int, int], None] | None = None
) -> None:
    """Write arrays, numbers and text as the entries of an .npz file; the same ones give the same bytes."""
    made = {name: np.ascontiguousarray(value).reshape(np.shape(value)) for name, value in arrays.items()}
    done, total = 0, sum(array.nbytes for array in made.values())
    # As `numpy.savez_compressed` does it, but piece by piece, so that a long one can be watched and interrupted.
    with new_file(path) as part, zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED, compresslevel=_LEVEL) as archive:
        for name, array in made.items():
            with archive.open(f"{name}.npy", "w", force_zip64=True) as file:
                npy.write_array_header_1_0(file, npy.header_data_from_array_1_0(array))
                raw = array.reshape(-1).view(np.uint8) if array.size else np.empty(0, dtype=np.uint8)
                for begin in range(0, raw.size, _PIECE):
                    done += file.write(raw[begin : begin + _PIECE].data)
                    if progress is not None:
                        progress(done, total)


def unpack(
    content: bytes, path: object, entries: Entries, version: int, what: str, later: dict[str, Any]
) -> dict[str, Any]:
    """Return the entries of an .npz file by name, or raise FormatError if they are not those of `what`.

    Entries in `later` may be absent, and are then what it says.
    """
    try:
        with zipfile.ZipFile(BytesIO(content)) as archive:
            arrays = later | _unpacked(archive, path, entries, what, later)
    except (FormatError, MemoryError):
        raise
    except Exception as error:  # zipfile, zlib and numpy raise whatever they stumble on: even tokenize.TokenError
        raise FormatError(f"{path}: is no whole .npz file: {error!s:.120}") from None
    if (found := int(arrays["version"])) != version:
        raise FormatError(f"{path}: version must be {version}, not {found}")
    return arrays


def _unpacked(
    archive: zipfile.ZipFile, path: object, entries: Entries, what: str, later: dict[str, Any]
) -> dict[str, Any]:
    """Return the entries, each looked at before it is unpacked."""
    infos = {info.filename.removesuffix(".npy"): info for info in archive.infolist()}
    for wrong, rule in (
        (entries.keys() - infos - later.keys(), "must have"),
        (infos.keys() - entries, "must not have"),
    ):
        if wrong:
            raise FormatError(f"{path}: {what} {rule} the entry {min(wrong)!r}")
    unpacked = sum(info.file_size for info in infos.values())
    if unpacked > MAX_UNPACKED:
        raise FormatError(f"{path}: must unpack to at most {MAX_UNPACKED} bytes, not {unpacked}")
    arrays: dict[str, Any] = {}
    for name, (kind, axes) in entries.items():
        if name not in infos:
            continue
        with archive.open(infos[name]) as file:
            if npy.read_magic(file) != (1, 0):
                raise FormatError(f"{path}: entry {name!r} has an unknown npy version")
            shape, is_fortran, dtype = npy.read_array_header_1_0(file)
            size = prod(shape) * dtype.itemsize
            if dtype.kind != kind or dtype.itemsize > _LARGEST_ITEM[kind] or len(shape) != axes or is_fortran:
                raise FormatError(
                    f"{path}: entry {name!r} must be of kind {kind} with {axes} axes, not {dtype} {shape}"
                )
            raw = file.read(size + 1)
        if len(raw) != size:
            raise FormatError(f"{path}: entry {name!r} must be {size} bytes long, not {len(raw)}")
        # A byte other than 0 and 1 makes a bool that kernels misread.
        if kind == "U":  # decoded here: numpy would take numbers for letters that are none
            arrays[name] = raw.decode("utf-32-be" if dtype.str[0] == ">" else "utf-32-le").rstrip("\0")
            continue
        items = np.frombuffer(raw, dtype=dtype)
        if kind == "b" and items.size and items.view(np.uint8).max() > 1:
            items = items.view(np.uint8) != 0
        arrays[name] = items.reshape(shape)
    return arrays
