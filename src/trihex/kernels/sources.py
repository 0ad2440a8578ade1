"""Sources: which files a kernel is made of, its own and those whose helpers become part of it."""

import re
from functools import cache
from hashlib import sha256
from pathlib import Path

_PACKAGE = Path(__file__).parents[1]
_IMPORT = re.compile(r"^ *from trihex\.([\w.]*kernels[\w.]*) import ([^#(\n]*|\([^)]*\))", re.MULTILINE)


def file_of(module: str) -> Path:
    """Return the file of a module of trihex, which need not have been imported."""
    return _PACKAGE.joinpath(*module.split(".")[1:]).with_suffix(".py")


@cache
def stamp_of(path: str) -> bytes:
    """Return a hash of all that a file of kernels is compiled from.

    Numba looks at the file of a kernel alone. Helpers of other files are compiled into it: when one of them changes,
    with a new version of trihex or while it is worked on, the kernel on disk is out of date all the same.
    """
    sources = sources_of(Path(path))
    names = sorted(sources, key=lambda one: one.as_posix())
    return sha256(b"".join(sha256(sources[name]).digest() for name in names)).digest()


def sources_of(path: Path) -> dict[Path, bytes]:
    """Return the files that a file of kernels is compiled from, itself among them, and what they hold."""
    found: dict[Path, bytes] = {}
    _gather(path, found)
    return found


def _gather(path: Path, found: dict[Path, bytes]) -> None:
    if path in found:
        return
    found[path] = path.read_bytes()
    for module, names in _IMPORT.findall(found[path].decode()):
        base = _PACKAGE.joinpath(*module.split("."))
        for name in ("", *re.findall(r"\w+", names)):  # a module named, or a module whose names are
            file = (base / name if name else base).with_suffix(".py")
            if file.is_file():
                _gather(file, found)
