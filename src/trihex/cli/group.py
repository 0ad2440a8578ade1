"""Group: the commands together, and what becomes of an error: one line, an exit status, never a traceback."""

from __future__ import annotations

import errno
import os
import re
import signal
import sys
import threading
from collections.abc import Iterable, Iterator, Sequence
from importlib import import_module
from io import TextIOWrapper
from pathlib import Path
from typing import Any, NoReturn

import click

from trihex.cli.progress import show_compiling
from trihex.errors import TrihexError
from trihex.kernels import loading, preparing

# Exit statuses. A command returns DONE (or None) or NO; the others are given here.
DONE = 0
NO = 1  # the answer is no: the plan is unsafe, or some robots cannot arrive
WRONG_USE = 2  # bad input, or an output that cannot be written
FAULT = 3  # of trihex itself
INTERRUPTED = 128 + signal.SIGINT
BROKEN_PIPE = 128 + signal.SIGPIPE
TERMINATED = 128 + signal.SIGTERM


class _ReaderGoneError(Exception):
    """Nobody reads the standard output any more; click would make it status 1, which means no."""


class Commands(click.Group):
    """A group of commands that tells of every error in one line on stderr.

    Parameters
    ----------
    *args, **attributes
        As for `click.Group`.
    summary_of_command : dict
        Names of the commands and what the help says of them.
    package : str
        Where the module of each command is, which defines `command`; it is imported when the command is called.
    """

    def __init__(self, *args: Any, summary_of_command: dict[str, str], package: str, **attributes: Any) -> None:
        super().__init__(*args, **attributes)
        self.summary_of_command, self.package = summary_of_command, package

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of the commands."""
        return list(self.summary_of_command)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return the command of that name."""
        if cmd_name not in self.summary_of_command:
            return None
        command: click.Command = import_module(f"{self.package}.{cmd_name}").command
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the names of the commands and what they do, for the help."""
        with formatter.section("Commands"):
            formatter.write_dl(list(self.summary_of_command.items()))

    def main(self, args: Sequence[str] | None = None, prog_name: str | None = None, *_: Any, **extra: Any) -> NoReturn:
        """Run the command that `args` name, and exit with its status."""
        status: int = FAULT
        loading.is_alone = True
        preparing.watch = show_compiling
        if isinstance(sys.stdout, TextIOWrapper):  # a path is told as it is, even if it is not UTF-8
            sys.stdout.reconfigure(errors="surrogateescape")
        if threading.current_thread() is threading.main_thread():
            # As for Ctrl-C, what is half-written is removed.
            signal.signal(signal.SIGTERM, lambda *_: sys.exit(TERMINATED))
        try:
            status = super().main(args, prog_name or "trihex", standalone_mode=False, **extra) or DONE
            sys.stdout.flush()
        except (click.Abort, KeyboardInterrupt):
            status = INTERRUPTED
            _tell(["interrupted; nothing is left half-written"])
        except (_ReaderGoneError, BrokenPipeError):
            status = BROKEN_PIPE
            _drop_stdout()
        except click.UsageError as error:
            status = WRONG_USE
            path = error.ctx.command_path if error.ctx else "trihex"
            _tell([f"{_line_of_usage_error(error, self.summary_of_command)} (see {path} --help)"])
        except (click.ClickException, TrihexError, OSError, MemoryError) as error:
            status = WRONG_USE
            _tell(_lines_of(error))
        except Exception as error:
            if "TRIHEX_TRACEBACK" in os.environ:
                raise
            kind = type(error).__name__
            _tell([f"this is a fault of trihex: {kind}: {str(error)!r:.200} (TRIHEX_TRACEBACK=1 shows where)"])
        sys.exit(status)

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command that was parsed."""
        try:
            return super().invoke(ctx)
        except BrokenPipeError:
            raise _ReaderGoneError from None
        except click.UsageError as error:
            name = ctx.invoked_subcommand
            if error.ctx is None and name:  # click's parser does not say of which command an option lacks its value
                error.ctx = click.Context(self.get_command(ctx, name) or self, parent=ctx, info_name=name)
            raise


def _tell(lines: list[str]) -> None:
    for line in lines:
        click.echo(f"trihex: error: {line}", err=True)


def _lines_of(error: Exception) -> list[str]:
    """Return what to tell of an error; several lines only where there are several mistakes."""
    if isinstance(error, click.ClickException):
        return [" ".join(error.format_message().split())]
    if isinstance(error, OSError) and not isinstance(error, TrihexError):
        return [_line_of_os_error(error)]
    if isinstance(error, MemoryError) and not isinstance(error, TrihexError):
        return [f"out of memory{f': {error}' if str(error) else ''}"]
    return str(error).splitlines() or [type(error).__name__]


def _line_of_usage_error(error: click.UsageError, commands: Iterable[str]) -> str:
    """Return click's message in one line, with the nearest name instead of all that come to its mind."""
    name, choices = "", commands
    if isinstance(error, click.NoSuchOption):
        name, choices = error.option_name, error.possibilities or ()
    elif found := re.match("No such command '(.*?)'", error.format_message()):
        name = found[1]
    if name:
        from difflib import get_close_matches

        near = get_close_matches(name, list(choices), n=1)
        what = "option" if isinstance(error, click.NoSuchOption) else "command"
        return f"there is no {what} {name!r}{f'; did you mean {near[0]!r}?' if near else ''}"
    return " ".join(error.format_message().split()).rstrip(".")


def _line_of_os_error(error: OSError) -> str:
    reason = error.strerror or str(error)
    if error.filename is None:
        return reason
    path = Path(os.fsdecode(error.filename))
    near: list[str] = []
    if error.errno == errno.ENOENT and path.parent.is_dir():
        from difflib import get_close_matches

        near = get_close_matches(path.name, _names_in(path.parent), n=1)
    return f"{path}: {reason}{f'; did you mean {str(path.with_name(near[0]))!r}?' if near else ''}"


def _names_in(folder: Path) -> Iterator[str]:
    try:
        yield from (entry.name for entry in folder.iterdir())
    except OSError:
        return


def _drop_stdout() -> None:
    """Let nothing be written to a pipe that nobody reads, or Python complains when it ends."""
    try:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except (OSError, ValueError):
        return
