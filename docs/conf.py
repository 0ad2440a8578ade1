"""Configuration of the documentation: sphinx with MyST (Markdown), furo, and the API from the docstrings."""

import re
import sys
from importlib import import_module
from pathlib import Path

import click
from docutils import nodes
from docutils.statemachine import StringList
from sphinx.util.docutils import SphinxDirective

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))

import trihex  # noqa: E402
from trihex.cli import main as command_line  # noqa: E402
from trihex.planners import PLANNERS  # noqa: E402

PUBLIC = set(trihex.__all__)
project = "trihex"
author = "The trihex developers"
copyright = "The trihex developers"
version = release = trihex.__version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["_build"]
# Nothing is fetched: neither at build time nor, with this theme, by the reader's browser.
html_theme = "furo"
html_title = "trihex"
html_show_sphinx = False
html_copy_source = False
html_theme_options = {"navigation_with_keys": True}
# `name` in docstrings is a name of the library; where there is none it is shown as code.
default_role = "code"
highlight_language = "default"
myst_heading_anchors = 3
myst_links_external_new_tab = False
autodoc_typehints = "none"
autodoc_member_order = "bysource"
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True
nitpicky = False


class PublicNames(SphinxDirective):
    """The public names of the packages named, classes first, each from its docstring."""

    required_arguments = 1
    final_argument_whitespace = True

    def run(self):
        """Return the nodes of the names."""
        lines = []
        for module in self.arguments[0].split():
            names = [name for name in dir(import_module(f"trihex.{module}")) if name in PUBLIC]
            if not names:
                raise self.error(f"package {module!r} has no public names")
            for name in sorted(names, key=lambda name: (not name[0].isupper(), name)):
                lines += [*_directive_of(f"trihex.{module}.{name}", getattr(trihex, name)), ""]
        return self.parse_text_to_nodes(StringList(lines, source=self.env.docname))


class Planners(SphinxDirective):
    """The function of every planner in the registry."""

    def run(self):
        """Return the nodes of the planners."""
        lines = []
        for name, module in PLANNERS.items():
            path = f"trihex.planners.{module}.plan_{name}"
            lines += [f"**{name}**", "", f".. autofunction:: {path}", ""]
        return self.parse_text_to_nodes(StringList(lines, source=self.env.docname))


class CommandHelp(SphinxDirective):
    """What `trihex COMMAND --help` prints, for every command."""

    def run(self):
        """Return a title and a block for each command."""
        top = click.Context(command_line, info_name="trihex", max_content_width=84, terminal_width=84)
        found = []
        for name in command_line.list_commands(top):
            command = command_line.get_command(top, name)
            with click.Context(command, parent=top, info_name=name) as context:
                text = command.get_help(context)
            title = f"trihex {name}"
            found += [nodes.rubric(text=title), nodes.literal_block(text, text, language="none")]
        return found


def _directive_of(path, value):
    if isinstance(value, type) and issubclass(value, Exception):
        return [f".. autoexception:: {path}", "   :show-inheritance:"]
    if isinstance(value, type):
        return [f".. autoclass:: {path}", "   :members:"]
    if callable(value):
        return [f".. autofunction:: {path}"]
    return [f".. data:: {path}", "", f"   A mapping from names to the functions above: {', '.join(value)}."]


def keep_colons(app, what, name, value, options, lines):
    """Let a colon in the first line of a property be a colon: napoleon takes what stands before it for a type."""
    if what in ("property", "attribute"):
        lines[:0] = [".. (a comment)", ""]


def open_navigation(app, docname, source):
    """Uncover what is for sphinx alone and stands in comments, so that plain Markdown does not show it."""
    source[0] = re.sub(r"<!-- navigation.*\n([\s\S]*?)^-->$", r"\1", source[0], flags=re.MULTILINE)


def colour_examples(app, doctree):
    """Colour examples (>>>) in indented blocks, whose language Markdown does not tell."""
    for block in doctree.findall(nodes.literal_block):
        if block.astext().startswith(">>> "):
            block["language"] = "pycon"


def setup(app):
    """Make the directives known to sphinx."""
    app.connect("autodoc-process-docstring", keep_colons, priority=400)
    app.connect("source-read", open_navigation)
    app.connect("doctree-read", colour_examples)
    app.add_directive("public-names", PublicNames)
    app.add_directive("planners", Planners)
    app.add_directive("command-help", CommandHelp)
