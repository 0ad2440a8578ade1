"""Journal: the rows of a study as they come, in a file beside its table that survives the death of all processes."""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np

from trihex.errors import StudyError
from trihex.studies.row import Row, versions
from trihex.studies.study import Study

_KIND = "journal of a trihex study, which goes on with the same command"


def journal_of(path: str | os.PathLike[str]) -> Path:
    """Return where the journal of the table at `path` is."""
    return Path(f"{os.path.realpath(path)}.journal")


class Journal:
    """A header line and a line of JSON for each run done, in the order in which they were done.

    Lines are only appended, and on the disk when `append` returns. Whatever stands behind the last whole line was being
    written when the process died, and is cut off.

    Parameters
    ----------
    path : path
        Of the table.
    study : Study

    Raises
    ------
    StudyError
        If there is a journal of another study, or another process writes to it.
    OSError
        If it cannot be written.
    """

    def __init__(self, path: str | os.PathLike[str], study: Study) -> None:
        self.path = journal_of(path)
        self.is_done = np.zeros(len(study), dtype=bool)
        self._offset = np.zeros(len(study), dtype=np.int64)
        self._file = os.open(self.path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
        try:
            self._lock()
            self._end = self._read(study, path)
        except BaseException:
            os.close(self._file)
            raise

    @property
    def done_count(self) -> int:
        """How many runs are done."""
        return int(np.count_nonzero(self.is_done))

    def append(self, rows: Iterable[Row]) -> None:
        """Write rows, whose `run` is not done yet, to the disk."""
        lines, offset = [], self._end
        found: list[tuple[int, int]] = []
        for row in rows:
            line = json.dumps(row, allow_nan=False).encode() + b"\n"
            found.append((row["run"], offset))
            lines.append(line)
            offset += len(line)
        self._write(b"".join(lines))
        for run, start in found:
            self._offset[run], self.is_done[run] = start, True

    def rows(self) -> Iterator[Row]:
        """Yield the rows of all runs done, by the number of the run."""
        with open(self._file, "rb", closefd=False) as file:
            for run in np.flatnonzero(self.is_done):
                file.seek(int(self._offset[run]))
                yield json.loads(file.readline())

    def remove(self) -> None:
        """Remove the file: the table holds all of it."""
        self.path.unlink(missing_ok=True)

    def __enter__(self) -> Journal:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        os.close(self._file)

    def _lock(self) -> None:
        """Keep others from writing; the lock ends with the process, however that ends."""
        try:
            import fcntl
        except ImportError:  # no locks of this kind where there is no POSIX
            return
        try:
            # Not flock: children that an executor forks would go on to hold it.
            fcntl.lockf(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise StudyError(f"{self.path}: another process is at this study") from None

    def _read(self, study: Study, path: object) -> int:
        """Note which runs are done, cut off what is torn, and return the end of the file."""
        header = {"trihex": versions()["trihex"], "kind": _KIND, "study": study.key, "runs": len(study)}
        end = 0
        with open(self._file, "rb", closefd=False) as file:
            for line in file:
                entry = _entry(line)
                if entry is None:
                    break
                if end == 0:
                    self._check_header(entry, header, path)
                elif isinstance(run := entry.get("run"), int) and 0 <= run < len(study) and not self.is_done[run]:
                    self._offset[run], self.is_done[run] = end, True
                end += len(line)
            size = os.fstat(self._file).st_size
        if end == 0 and size > 4096:  # a torn header is shorter
            raise StudyError(
                f"{self.path}: is no journal of a study; move it away or choose another name for the table"
            )
        os.ftruncate(self._file, end)
        self._end = end
        if end == 0:
            self._write(json.dumps(header).encode() + b"\n")
        return self._end

    def _check_header(self, entry: dict[str, Any], header: dict[str, Any], path: object) -> None:
        if entry.get("kind") != _KIND:
            raise StudyError(
                f"{self.path}: is no journal of a study; move it away or choose another name for the table"
            )
        if entry.get("trihex") != header["trihex"]:
            raise StudyError(
                f"{self.path}: was begun by trihex {entry.get('trihex')}, this is {header['trihex']}; go on with that "
                f"one, or remove the journal to begin anew"
            )
        if entry != header:
            raise StudyError(
                f"{self.path}: belongs to another study, or the study was changed since it was begun; change it back "
                f"to go on, or remove the journal to begin anew"
            )

    def _write(self, content: bytes) -> None:
        """Append to the file, or leave it as it was."""
        try:
            os.lseek(self._file, self._end, os.SEEK_SET)
            left = memoryview(content)
            while left:
                left = left[os.write(self._file, left) :]
            os.fsync(self._file)
        except BaseException as error:
            with contextlib.suppress(OSError):
                os.ftruncate(self._file, self._end)
            if isinstance(error, OSError):
                error.filename = str(self.path)
            raise
        self._end += len(content)


def _entry(line: bytes) -> dict[str, Any] | None:
    """Return the content of a line, None if it was not written to its end."""
    if not line.endswith(b"\n"):
        return None
    try:
        entry = json.loads(line)
    except ValueError:
        return None
    return entry if isinstance(entry, dict) else None
