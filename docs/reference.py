"""The overview of the API, ``docs/api/index.md``, from the docstrings: ``python docs/reference.py`` writes it anew."""

import ast
import inspect
from pathlib import Path

import trihex

PAGE = Path(__file__).parent / "api" / "index.md"
HEAD = """# API

The public names, as `import trihex as th` gives them, a page for each package, in the order in which they are used.
`make docs` builds pages with the full docstrings; in Python `help(th.make_plan)` shows them.

"""
TITLES = {
    "areas": "Areas and scenarios: what is planned on",
    "fields": "Automata and fields: how far, and which way",
    "plans": "Plans: what robots do, step by step",
    "bounds": "Bounds: what no plan can beat",
    "planners": "Planners: who plans, by name",
    "optimum": "Certificates: what proves that no plan is better",
    "judging": "Judge and report",
    "prices": "Prices: what each wall and each door costs",
    "running": "A world that changes while robots move",
    "studies": "Studies and comparisons",
    "pictures": "Pictures and movies",
    "viewer": "Viewer",
    "formats": "Files",
    "errors": "Errors",
}


def names_of_package():
    """Return the public names of each package, from the one list of them."""
    stub = ast.parse(Path(trihex.__file__).with_suffix(".pyi").read_text())
    found = {}
    for node in stub.body:
        if isinstance(node, ast.ImportFrom):
            found.setdefault(node.module, []).extend(alias.name for alias in node.names)
    return found


def first_sentence(thing):
    """Return the first line of a docstring; of a mapping its keys."""
    if not (inspect.isclass(thing) or callable(thing)):
        return f"By name: {', '.join(f'`{name}`' for name in thing)}."
    return inspect.getdoc(thing).split("\n\n")[0].replace("\n", " ").replace("``", "`")


def page():
    """Return the text of the page."""
    found = names_of_package()
    parts = [HEAD]
    for package, title in TITLES.items():
        parts.append(f"## [{title}]({package}.md)\n| name | what it is |\n|---|---|\n")
        names = sorted(found[package], key=lambda name: (not name[0].isupper(), name))
        parts += [f"| `{name}` | {first_sentence(getattr(trihex, name))} |\n" for name in names]
        parts.append("\n")
    parts.append("## [Command line](command-line.md)\n`trihex --help` lists all commands.\n\n")
    pages = "\n".join([*TITLES, "command-line"])
    toctree = f"```{{toctree}}\n:hidden:\n:maxdepth: 1\n\n{pages}\n```\n"
    parts.append(f"<!-- navigation, which docs/conf.py opens for sphinx\n{toctree}-->\n")
    return "".join(parts)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
