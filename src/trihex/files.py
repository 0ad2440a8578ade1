"""Files: bytes in, bounded and checked, and files out that are whole or not there."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from trihex.errors import FormatError, check_choice, check_path

# A cell or a robot-step takes a byte at least: 10^9 of them are more than a text file should hold.
MAX_BYTES = 2**30
# Who waits for whom; a file of another kind must not lie under such a name, though .json be its suffix, too.
ORDER_SUFFIXES = (".dependencies.json", ".vda5050.json")


def read_bytes(path: str | os.PathLike[str], limit: int = MAX_BYTES) -> bytes:
    """Return the content of a file of at most `limit` bytes.

    Raises
    ------
    FormatError
        If it is larger, empty, or neither a file nor a pipe.
    OSError
        If it cannot be read.
    """
    check_path(path)
    with open(path, "rb") as file:
        status = os.fstat(file.fileno())
        if not (stat.S_ISREG(status.st_mode) or stat.S_ISFIFO(status.st_mode)):
            raise FormatError(f"{path}: must be a file or a pipe, not a device")
        # The size is asked first, so that a huge file costs nothing; a pipe has none.
        try:
            content = b"" if status.st_size > limit else file.read(limit + 1)
        except OSError as error:  # tell of the file
            error.filename = str(path)
            raise
    if status.st_size > limit or len(content) > limit:
        raise FormatError(f"{path}: must be at most {limit} bytes long, not {max(status.st_size, len(content))}")
    if not content:
        raise FormatError(f"{path}: the file is empty")
    return content


def suffix_of(path: str | os.PathLike[str], suffixes: Iterable[str], kind: str) -> str:
    """Return the suffix of `path` if it is one of `suffixes`, else raise FormatError naming the `kind` of file."""
    check_path(path)
    suffixes, name = list(suffixes), Path(path).name.lower()
    own = next((one for one in ORDER_SUFFIXES if name.endswith(one) and name != one), Path(path).suffix.lower())
    if own in ORDER_SUFFIXES and own not in suffixes:
        others = ", ".join(suffixes)
        raise FormatError(
            f"{path}: the suffix of {kind} must be one of {others}, not {own!r}: that is for who waits for "
            f"whom in a plan (write_dependencies, trihex plan --out)"
        )
    return check_choice(f"{path}: the suffix of {kind}", own, suffixes, FormatError)


@contextmanager
def new_file(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield a temporary path beside `path`, with its suffix, that takes its place when the block ends well.

    Until then a file that was there stays as it is; if the block raises, nothing is left behind. Links are followed,
    and what is not a plain file (a pipe, /dev/null) is written in place.
    """
    check_path(path)
    target = Path(os.path.realpath(path))
    if target.exists() and not target.is_file():
        if target.is_dir():
            raise IsADirectoryError(21, "Is a directory", str(path))
        yield target
        return
    part = target.with_name(f".trihex-{os.urandom(4).hex()}{target.suffix}")
    try:
        with open(part, "xb"):
            pass
    except OSError as error:  # tell of the name the user knows
        error.filename = str(path)
        raise
    try:
        if target.exists():
            os.chmod(part, stat.S_IMODE(target.stat().st_mode))
        yield part
        os.replace(part, target)
    finally:
        with suppress(FileNotFoundError):
            part.unlink()


def check_output(path: str | os.PathLike[str]) -> None:
    """Raise OSError if `path` cannot be written, as far as can be told before the work is done."""
    check_path(path)
    target = Path(os.path.realpath(path))
    if target.is_dir():
        raise IsADirectoryError(21, "Is a directory", str(path))
    if not target.parent.exists():
        raise FileNotFoundError(2, "No such directory", str(Path(path).parent))
    if not target.parent.is_dir():
        raise NotADirectoryError(20, "Not a directory", str(Path(path).parent))
    if not os.access(target if target.exists() else target.parent, os.W_OK):
        raise PermissionError(13, "Permission denied", str(path))
