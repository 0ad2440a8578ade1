"""Sources: which files a kernel is made of, its own and those whose helpers become part of it."""

import re
from functools import cache
from hashlib import sha256
from pathlib import Path

_PACKAGE = Path(__file__).parents[1]
_IMPORT = re.compile(r"^from trihex\.([\w.]*kernels[\w.]*) import ([^#(]*|\([^)]*\))", re.MULTILINE)


def file_of(module: str) -> Path:
    """Return the file of a module of trihex, which need not have been imported."""
    return _PACKAGE.joinpath(*module.split(".")[1:]).with_suffix(".py")


@cache
def stamp_of(path: str) -> bytes:
    """Return a hash of all that a file of kernels is compiled from.

    Numba looks at the file of a kernel alone. Helpers of other files are compiled into it: when one of them changes,
    with a new version of trihex or while it is worked on, the kernel on disk is out of date all the same.
    """
    found: dict[Path, bytes] = {}
    _gather(Path(path), found)
    names = sorted(found, key=lambda one: one.as_posix())
    return sha256(b"".join(sha256(found[name]).digest() for name in names)).digest()


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
