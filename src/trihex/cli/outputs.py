"""Outputs: whether they can be written is asked before the work, not after it."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import click

from trihex.cli.options import wrong_use


def check_outputs(*outputs: tuple[Path | None, Iterable[str], str]) -> None:
    """Raise unless each (path, suffixes, kind of file) that is given can be written; no suffixes: any will do."""
    from trihex.files import check_output, suffix_of

    seen: set[Path] = set()
    for path, suffixes, kind in outputs:
        if path is None or str(path) == "-":
            continue
        if allowed := tuple(suffixes):
            suffix = suffix_of(path, allowed, kind)
            if suffix == ".pdf" or kind == "a chart":
                from trihex.pictures import check_matplotlib

                check_matplotlib(kind if suffix != ".pdf" else f"{kind} in PDF")
        check_output(path)
        if path in seen:
            raise wrong_use(f"two outputs must not have one name, {path}")
        seen.add(path)


def tell_written(*paths: Path | None) -> None:
    """Name the files that were written; the standard output (-) is none."""
    names = [str(path) for path in paths if path is not None and str(path) != "-"]
    if names:
        click.echo(f"written: {', '.join(names)}")


def write_text(text: str, path: Path) -> None:
    """Write text to a file, or to the standard output (-)."""
    from trihex.files import new_file

    if str(path) == "-":
        click.echo(text, nl=False)
        return
    with new_file(path) as part:
        part.write_text(text, encoding="utf-8")
