"""Mutations: what goes wrong with files, by accident and on purpose."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Callable, Sequence
from contextlib import suppress
from io import BytesIO
from random import Random
from zlib import crc32

from fuzz.bombs import bomb_like

_NUMBERS = [
    *(b"0", b"-1", b"1", b"2147483648", b"-9223372036854775809", b"18446744073709551616", b"9" * 400, b"1e308"),
    *(b"1e-320", b"nan", b"inf", b"-inf", b"0.1", b"0x10", b"1_000", b"1e5", b"99", b"\xd9\xa3", b"", b"true", b"null"),
]
_TOKENS = [
    *(b"[", b"]", b"{", b"}", b"(", b")", b'"', b"'", b",", b":", b"=", b"\n", b"\r\n", b"\t", b"\0", b"#", b"- "),
    *(b"\xef\xbb\xbf", b"\xff\xfe", b"\xed\xa0\x80", b"\xc3\xa9", b"type ", b"EMPTY", b"../", b"/dev/zero", b"\\"),
]


def flip_bits(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """Flip up to eight bits."""
    out = bytearray(data)
    for _ in range(random.randint(1, 8)):
        out[random.randrange(len(out))] ^= 1 << random.randrange(8)
    return bytes(out)


def set_bytes(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """Set up to eight bytes."""
    out = bytearray(data)
    for _ in range(random.randint(1, 8)):
        out[random.randrange(len(out))] = random.choice((0, 255, 127, 128, 10, 32, random.randrange(256)))
    return bytes(out)


def truncate(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """Cut off the end, or the beginning."""
    at = random.randrange(len(data))
    return data[:at] if random.random() < 0.8 else data[at:]


def repeat(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """Repeat a part, sometimes very often."""
    first, last = sorted((random.randrange(len(data) + 1), random.randrange(len(data) + 1)))
    part = data[first : min(last, first + 64)]
    return data[:first] + part * random.choice((2, 3, 10, 100, 5000)) + data[last:]


def delete(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """Take a part out."""
    first = random.randrange(len(data))
    return data[:first] + data[first + random.randint(1, 40) :]


def number(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """Replace a number by another, perhaps a huge one or none at all."""
    found = list(re.finditer(rb"-?\d+(\.\d+)?", data[:20_000]))
    if not found:
        return set_bytes(data, random, _)
    one = random.choice(found)
    return data[: one.start()] + random.choice(_NUMBERS) + data[one.end() :]


def integer(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """Overwrite 1, 2, 4 or 8 bytes by an integer at the border of a range, in either order of bytes."""
    size = random.choice((1, 2, 4, 8))
    value = random.choice((0, 1, 2 ** (8 * size) - 1, 2 ** (8 * size - 1), 2 ** (8 * size - 1) - 1))
    at = random.randrange(max(1, len(data) - size))
    return data[:at] + value.to_bytes(size, random.choice(("little", "big"))) + data[at + size :]


def token(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """Insert signs that mean something to some reader."""
    at = random.randrange(len(data) + 1)
    return data[:at] + random.choice(_TOKENS) * random.choice((1, 1, 2, 30)) + data[at:]


def nest(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """Insert brackets as deep as a stack."""
    opening, closing = random.choice(
        ((b"[", b"]"), (b'{"a":', b"}"), (b"(", b")"), (b"GEOMETRYCOLLECTION (", b")"), (b"a.", b""))
    )
    depth = random.choice((40, 900, 3000, 100_000))
    at = random.randrange(len(data) + 1)
    return data[:at] + opening * depth + closing * random.choice((0, depth)) + data[at:]


def recode(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """Write text in another encoding."""
    return data.decode("latin-1").encode(random.choice(("utf-16", "utf-32", "utf-7", "cp037", "utf-8-sig")), "replace")


def splice(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    """Join the head of one file and the tail of another."""
    other = random.choice(others)
    return data[: random.randrange(len(data) + 1)] + other[random.randrange(len(other) + 1) :]


def shuffle_lines(data: bytes, random: Random, _: Sequence[bytes]) -> bytes:
    """Put the lines in another order, or one of them twice."""
    lines = data.split(b"\n")
    if random.random() < 0.5:
        lines.insert(random.randrange(len(lines)), random.choice(lines))
    else:
        random.shuffle(lines)
    return b"\n".join(lines)


def inside(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    """Change what lies within an archive or a PNG, and leave its checksums right; else set bytes."""
    change = random.choice((flip_bits, set_bytes, integer, truncate))
    if data.startswith(b"PK"):
        with suppress(Exception):  # damaged before
            return _repacked(data, random, lambda part: change(part, random, others))
    if data.startswith(b"\x89PNG") and (chunks := _chunks_of(data)):
        at = random.randrange(len(chunks))
        chunks[at] = (chunks[at][0], change(chunks[at][1] or b"\0", random, others))
        return data[:8] + b"".join(
            len(body).to_bytes(4) + kind + body + crc32(kind + body).to_bytes(4) for kind, body in chunks
        )
    return set_bytes(data, random, others)


def _repacked(data: bytes, random: Random, change: Callable[[bytes], bytes]) -> bytes:
    """Return an archive with one of its entries changed."""
    out = BytesIO()
    with zipfile.ZipFile(BytesIO(data)) as old, zipfile.ZipFile(out, "w") as new:
        names = old.namelist()
        chosen = random.choice(names)
        for name in names:
            content = old.read(name)
            new.writestr(zipfile.ZipInfo(name), change(content) if name == chosen else content)
    return out.getvalue()


def _chunks_of(png: bytes) -> list[tuple[bytes, bytes]]:
    """Return kind and content of the chunks of a PNG, as far as they are whole."""
    chunks, at = [], 8
    while at + 12 <= len(png):
        size = int.from_bytes(png[at : at + 4])
        chunks.append((png[at + 4 : at + 8], png[at + 8 : at + 8 + size]))
        at += 12 + size
    return chunks


MUTATIONS: tuple[Callable[[bytes, Random, Sequence[bytes]], bytes], ...] = (
    *(flip_bits, set_bytes, truncate, repeat, delete, number, number, number, integer, token, nest, recode, splice),
    *(shuffle_lines, inside, inside),
)


def mutate(data: bytes, random: Random, others: Sequence[bytes], bombs: float = 0.0) -> bytes:
    """Return `data` after one to three mutations, at most 2 MB of it; by the share of `bombs` a bomb of its kind."""
    if random.random() < bombs and (choices := bomb_like(data)):
        return random.choice(choices)
    for _ in range(random.choice((1, 1, 1, 2, 3))):
        if data:
            data = random.choice(MUTATIONS)(data, random, others)[:2_000_000]
    return data
