"""Marks: which kernels are known to be on disk, told without importing numba, which takes half a second."""

import os
import sys
from collections.abc import Iterator
from functools import cache
from hashlib import sha256
from importlib.util import find_spec
from pathlib import Path

from trihex.kernels.needs import Kernels
from trihex.kernels.sources import file_of, stamp_of


def is_marked(kernels: Kernels) -> bool:
    """Tell whether kernels have been compiled here, from the sources as they are, and are still there."""
    for folder in _folders():
        try:
            kept = (folder / _name_of(kernels)).read_text().splitlines()
        except OSError:
            continue
        return all(os.path.exists(path) for path in kept)
    return False


def mark(kernels: Kernels, kept: list[str]) -> None:
    """Note that kernels are in the files `kept`; where nothing can be written nothing is noted."""
    for folder in _folders():
        try:
            folder.mkdir(parents=True, exist_ok=True)
            part = folder / f"{_name_of(kernels)}.{os.getpid()}"
            part.write_text("\n".join(kept))
            part.replace(folder / _name_of(kernels))
        except OSError:
            continue
        return


def can_keep() -> bool:
    """Tell whether there is a folder in which compiled kernels can be kept."""
    for folder in _folders():
        there = folder
        while not there.exists() and there != there.parent:
            there = there.parent
        if os.access(there, os.W_OK | os.X_OK):
            return True
    return False


def _folders() -> Iterator[Path]:
    """Yield where marks may be, in the order in which numba looks for a place of its own."""
    if chosen := os.environ.get("NUMBA_CACHE_DIR"):
        yield Path(chosen) / "trihex"
        return
    yield Path(__file__).parent / "__pycache__"
    yield Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "trihex"


def _name_of(kernels: Kernels) -> str:
    made_by = [repr(kernels), stamp_of(str(file_of(kernels.module))).hex(), _numba(), sys.version, _processor()]
    return f"{kernels.module}.{sha256(repr(made_by).encode()).hexdigest()[:16]}.compiled"


@cache
def _numba() -> str:
    """Return what tells one numba from another."""
    spec = find_spec("numba")
    file = Path(spec.origin).with_name("_version.py") if spec and spec.origin else Path()
    return file.read_text() if file.is_file() else ""


@cache
def _processor() -> str:
    """Return the name of the processor: code that is compiled for one may not run on another."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        return "".join(sorted({line for line in lines if line.startswith(("model name", "flags", "Features"))}))
    except OSError:
        import platform

        return platform.machine() + platform.processor()
