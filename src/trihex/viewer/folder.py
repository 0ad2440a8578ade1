"""Folder: the files below the folder in which the viewer was started, and no others."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from zipfile import BadZipFile, ZipFile

from trihex.errors import FormatError, check_path
from trihex.files import MAX_BYTES, read_bytes
from trihex.formats import FORMATS, WRITERS, check_text, format_of
from trihex.formats.areas.ros import parse_yaml

# All that is read: what the registry of formats knows by name, what we write, and images that we do not write.
SUFFIXES = tuple(
    dict.fromkeys(
        (
            *(suffix for form in FORMATS.values() for suffix in form.suffixes),
            *(suffix for what in ("an area", "a scenario", "a plan") for suffix in WRITERS[what]),
            *(".gif", ".jpg", ".jpeg", ".pfm"),
        )
    )
)
_MOST_FILES = 500
_MOST_DEPTH = 3


class Folder:
    """A folder out of which no name leads: neither ``..`` nor an absolute path nor a link.

    Parameters
    ----------
    root : path

    Raises
    ------
    OSError
        If it does not exist.
    """

    def __init__(self, root: str | os.PathLike[str]) -> None:
        check_path(root, "folder")
        self.root = Path(os.path.realpath(root, strict=True))

    def resolve(self, name: str, base: Path | None = None) -> Path:
        """Return the path of the file called `name`, relative to `base` or the folder itself; it need not exist.

        Raises
        ------
        FormatError
            If it would lie outside.
        """
        if not name or "\0" in name or Path(name).is_absolute():
            raise FormatError(f"a file must be named relative to the folder of the viewer, not {name!r:.120}")
        path = Path(os.path.realpath((base or self.root) / name))  # Path.resolve raises RuntimeError at a loop
        if not path.is_relative_to(self.root):
            raise FormatError(f"a file must lie in the folder of the viewer, not at {name!r:.120}")
        return path

    def find(self, name: str) -> Path:
        """Return the path of a file to read: it lies in the folder, and so do the files that it names in turn.

        Raises
        ------
        FormatError
            If one of them lies outside.
        OSError
            If the file cannot be read.
        """
        path = self.resolve(name)
        found, waiting = {path}, [path]
        while waiting:
            one = waiting.pop()
            others = {self.resolve(other, one.parent) for other in references_of(one)} - found
            found |= others
            waiting += others
        return path

    def names(self) -> list[str]:
        """Return the names of the files that may be opened, sorted; those of hidden folders are left out."""
        found = sorted(name for _, name in zip(range(_MOST_FILES), self._walk(self.root, 0), strict=False))
        return sorted(found, key=lambda name: (name.count("/"), name))

    def _walk(self, folder: Path, depth: int) -> Iterator[str]:
        try:
            entries = sorted(os.scandir(folder), key=lambda entry: entry.name)
        except OSError:
            return
        for entry in entries:
            if entry.is_file(follow_symlinks=False) and entry.name.lower().endswith(SUFFIXES):
                yield Path(entry.path).relative_to(self.root).as_posix()
        for entry in entries:
            if entry.is_dir(follow_symlinks=False) and depth < _MOST_DEPTH and not entry.name.startswith((".", "_")):
                yield from self._walk(Path(entry.path), depth + 1)


def holds_run(path: Path) -> bool:
    """Tell whether an archive holds a run, not a plan; what is no archive, its reader will tell."""
    try:
        with ZipFile(path) as archive:
            return "run_actions.npy" in archive.namelist()
    except (BadZipFile, OSError, ValueError):
        return False


def references_of(path: Path) -> list[str]:
    """Return the names of the files that a file wants to be read with it: a scenario's area, a ROS map's image."""
    content = read_bytes(path, MAX_BYTES)
    form = format_of(content, path)
    names: list[Any] = []
    if form == "ros":
        names = [parse_yaml(check_text(content, path).decode(), path).get("image")]
    elif form == "scenario":
        try:
            table = tomllib.loads(check_text(content, path).decode())
        except (ValueError, RecursionError):
            return []  # its reader will tell what is wrong
        parts = [(table.get("area"), "path"), (table.get("robots"), "file")]
        names = [part.get(key) for part, key in parts if isinstance(part, dict)]
    return [name for name in names if isinstance(name, str)]
