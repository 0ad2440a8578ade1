"""Bombs: small files that ask for much: of memory, of time or of depth."""

from __future__ import annotations

import struct
import zipfile
import zlib
from functools import cache
from io import BytesIO

import numpy as np
from numpy.lib import format as npy

_MUCH = 2**28


@cache
def make_bombs() -> dict[str, tuple[bytes, ...]]:
    """Return bombs by the kind of file that they seem to be: zip, png, parquet, gif, bmp, pgm."""
    return {
        "zip": tuple(_zip(*bomb) for bomb in _ARRAYS),
        "png": tuple(_png(*bomb) for bomb in _PNGS),
        "parquet": (_parquet(2_000_000),),
        "gif": (b"GIF89a\xff\xff\xff\xff\x80\0\0" + bytes(6) + b",\0\0\0\0\xff\xff\xff\xff\0\x08\0",),
        "bmp": tuple(_bmp(side) for side in (9_000, 30_000, 2**31 - 1)),
        "pgm": (
            b"P5 9000 9000 255\n",
            b"P5 99999 99999 255\n",
            b"P2 9000 9000 255\n" + b"0 " * 900_000,
            b"P1 3000000 1 ",
        ),
    }


def bomb_like(data: bytes) -> tuple[bytes, ...]:
    """Return the bombs that begin as `data` does; none where there are no such."""
    for kind, mark in (("zip", b"PK"), ("png", b"\x89PNG"), ("parquet", b"PAR1"), ("gif", b"GIF"), ("bmp", b"BM")):
        if data.startswith(mark):
            return make_bombs()[kind]
    return make_bombs()["pgm"] if data.startswith((b"P5", b"P2")) else ()


# Entry of a plan, its shape as claimed, bytes that are there.
_ARRAYS = [
    ("actions", (_MUCH,), _MUCH),
    ("actions", (2**60,), 10),
    ("actions", (2**33,), 10),
    ("actions", (10,), _MUCH),
    ("barriers", (2**14, 2**14), _MUCH),
    ("barriers", (2**31, 2**31), 10),
    ("robots", (_MUCH // 8,), _MUCH),
    ("jumps", (2**62, 2), 0),
]
_TYPES = {"actions": "|u1", "barriers": "|b1", "robots": "<i8", "jumps": "<i8"}
# Width, height, bytes of pixels that are there.
_PNGS = [(10_000, 10_000, 10_001 * 10_000), (30_000, 30_000, 10), (2**31 - 1, 2**31 - 1, 10), (64, 64, _MUCH)]


def _zip(entry: str, shape: tuple[int, ...], size: int) -> bytes:
    """Return the plan of the seeds with one entry that is larger than it looks, or looks larger than it is."""
    from fuzz.seeds import make_seeds

    out = BytesIO()
    with zipfile.ZipFile(BytesIO(make_seeds()["plan.npz"])) as plan, zipfile.ZipFile(out, "w", 8) as bomb:
        for info in plan.infolist():
            if info.filename != f"{entry}.npy":
                bomb.writestr(info.filename, plan.read(info))
                continue
            with bomb.open(info.filename, "w", force_zip64=True) as file:
                npy.write_array_header_1_0(file, {"descr": _TYPES[entry], "fortran_order": False, "shape": shape})
                file.write(bytes(size))
    return out.getvalue()


def _png(width: int, height: int, size: int) -> bytes:
    """Return a grey image; a second copy of its pixels as compressed text."""
    packer = zlib.compressobj(9)
    pixels = packer.compress(bytes(size)) + packer.flush()
    chunks = [
        (b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)),
        (b"zTXt", b"Comment\0\0" + pixels),
        (b"IDAT", pixels),
        (b"IEND", b""),
    ]
    parts = [
        struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body)) for kind, body in chunks
    ]
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts)


def _bmp(side: int) -> bytes:
    """Return an image whose rows are packed by run lengths, nearly all of them left out."""
    header = struct.pack("<IiiHHIIiiII", 40, side, side, 1, 8, 1, 4, 0, 0, 2, 0)
    palette = bytes(8)
    at = 14 + len(header) + len(palette)
    return b"BM" + struct.pack("<IHHI", at + 4, 0, 0, at) + header + palette + b"\xff\x01\0\x01"


def _parquet(rows: int) -> bytes:
    """Return a plan of one robot that waits for ever."""
    import pyarrow
    from pyarrow import parquet

    nothing = pyarrow.array(np.zeros(rows, dtype=np.int64))
    table = dict.fromkeys(("robot", "step", "x", "y", "time"), nothing)
    table["action"] = pyarrow.DictionaryArray.from_arrays(np.zeros(rows, dtype=np.int32), ["wait"])
    out = BytesIO()
    parquet.write_table(pyarrow.table(table), out, compression="zstd")
    return out.getvalue()
