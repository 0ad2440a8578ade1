"""Script: the one ES module of all pages, joined from the files in ``web/``, one noun in each.

Each file is an ES module of its own that imports from its neighbours, by lines such as
``import { name } from "./file.js";``. Joining them is no build: the files stand one after another, each after those
that it imports from, without those lines. So they share one scope, and a name is given once in all of them.
"""

from __future__ import annotations

import re
from functools import cache
from importlib.resources import files

_IMPORT = re.compile(r'^import \{[^}]*\} from "\./([\w-]+\.js)";\n', re.MULTILINE)
_HEAD = (
    "// trihex: areas, fields, plans and live runs on a canvas. No framework, no request but to the host of the page.\n"
)


@cache
def source_of(name: str) -> str:
    """Return the text of a file in ``web/``."""
    return (files("trihex.viewer") / "web" / name).read_text(encoding="utf-8")


@cache
def module() -> str:
    """Return the module: ``start.js`` and all that it needs."""
    return _HEAD + "\n".join(_IMPORT.sub("", source_of(name)) for name in parts())


def parts(last: str = "start.js") -> list[str]:
    """Return the names of the files that `last` needs, each after those that it imports from, and itself."""
    found: dict[str, None] = {}

    def add(name: str) -> None:
        for other in _IMPORT.findall(source_of(name)):
            if other not in found:
                add(other)
        found[name] = None

    add(last)
    return list(found)
