"""Documentation: every block of code runs, examples run, links lead somewhere, pictures are those of their scripts."""

import doctest
import json
import re
import runpy
import sys
import tomllib
from pathlib import Path
from types import SimpleNamespace
from urllib.parse import urlsplit

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image

import trihex as th
from trihex.cli import main
from trihex.formats import WRITERS
from trihex.planners import PLANNERS

ROOT = Path(__file__).parent.parent
DOCS = sorted((ROOT / "docs").rglob("*.md"))
PAGES = [*DOCS, *sorted(ROOT.glob("*.md"))]
# They draw none; tests/optimum/test_certificate.py and tests/formats/test_dependencies.py run them.
NO_PICTURES = ("__main__", "drawing", "concepts", "check_certificate", "executor")
SCRIPTS = sorted(path for path in (ROOT / "examples").glob("*.py") if path.stem not in NO_PICTURES)
# Commands that go on until they are stopped, or take long; their words are checked all the same.
NOT_RUN = {"view", "demo", "study"}
# Fenced blocks of these are words and pictures; everything else is run or read here: `console` in any case, indented
# commands and those in `sh` where their files are there.
FOR_SPHINX = ("{", "text")


def name_of(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


@pytest.fixture(autouse=True)
def _in_repository(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT))


def blocks_of(text: str) -> list[SimpleNamespace]:
    """Return the blocks of code of a page: fenced ones with their language, indented ones without."""
    blocks, lines, i = [], text.splitlines(), 0
    while i < len(lines):
        fence = re.match(r"( *)(```+)(.*)$", lines[i])
        if fence:
            end = next(j for j in range(i + 1, len(lines)) if lines[j].strip() == fence[2])
            body, language, first, i = lines[i + 1 : end], fence[3].strip(), i + 1, end + 1
            blocks.append(SimpleNamespace(language=language, lines=body, first=first))
        elif re.match(r" {4}\S|      *\S", lines[i]) and (i == 0 or not lines[i - 1].strip()):
            j = i
            while j < len(lines) and (not lines[j].strip() or lines[j].startswith("    ")):
                j += 1
            blocks.append(SimpleNamespace(language="", lines=lines[i:j], first=i))
            i = j
        else:
            i += 1
    for block in blocks:
        indent = min((len(line) - len(line.lstrip()) for line in block.lines if line.strip()), default=0)
        block.lines = [line[indent:] for line in block.lines]
        block.kind = kind_of(block)
    return blocks


def kind_of(block: SimpleNamespace) -> str:
    first = block.lines[0] if block.lines else ""
    if block.language.startswith(FOR_SPHINX):
        return "none"
    if any(line.startswith(">>> ") for line in block.lines):
        return "doctest"
    if block.language:
        return block.language
    if first.startswith("trihex "):
        return "console"
    if first.startswith(("th.", "import ", "from ")):
        return "python"
    return "toml" if any(re.match(r"\[[a-z.]+\]", line) for line in block.lines) else "none"


def commands_of(block: SimpleNamespace) -> list[list[str]]:
    """Return the `trihex` commands of a block as words; what they print is not compared."""
    text = "\n".join(block.lines).replace("\\\n", " ")
    lines = [line.removeprefix("$ ") for line in text.splitlines()]
    return [line.split("#")[0].split()[1:] for line in lines if line.startswith("trihex ")]


def run_command(words: list[str], folder: Path, *, must_run: bool) -> None:
    command = main.get_command(None, words[0])
    assert command is not None, f"there is no command trihex {words[0]}"
    command.make_context(f"trihex {words[0]}", list(words[1:]))  # refuses options that do not exist
    outputs = {words[i + 1] for i, word in enumerate(words[:-1]) if word in ("--out", "--picture")}
    inputs = [word for word in words if re.search(r"\.(map|txt|toml|csv|npz|yaml|png|geojson|wkt|scen|npy)$", word)]
    is_here = all((folder / word).exists() for word in inputs if word not in outputs)
    if words[0] in NOT_RUN or not (is_here or must_run):
        return
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 0, f"trihex {' '.join(words)}\n{result.output}"


def make_files(folder: Path) -> None:
    """Make what the pages take for granted: a ROS map."""
    Image.fromarray(np.full((300, 200), 254, dtype=np.uint8)).save(folder / "map.pgm")
    (folder / "map.yaml").write_text(
        "image: map.pgm\nresolution: 0.1\norigin: [-10.0, -15.0, 0.0]\n"
        "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )


@pytest.mark.parametrize("path", PAGES, ids=name_of)
def test_every_block_of_a_page_runs(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    make_files(tmp_path)
    names = {"__name__": "__main__"}
    for block in blocks_of(path.read_text(encoding="utf-8")):
        text, where = "\n".join(block.lines) + "\n", f"{name_of(path)}, line {block.first + 1}"
        if block.kind == "doctest":
            test = doctest.DocTestParser().get_doctest(text, names, where, name_of(path), block.first)
            runner, out = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE), []
            assert runner.run(test, out=out.append, clear_globs=False).failed == 0, "".join(out)
            names = test.globs
        elif block.kind == "python":
            exec(compile(text, where, "exec"), names)
        elif block.kind in ("console", "sh", "bash"):
            for words in commands_of(block):
                run_command(words, tmp_path, must_run=block.language == "console")
        elif block.kind == "json":
            json.loads(text)
        elif block.kind == "toml":
            file = tomllib.loads(text)
            if (tmp_path / file.get("area", {}).get("path", "-")).is_file():
                (tmp_path / "scenario.toml").write_text(text)
                assert th.read_scenario("scenario.toml").robot_count == file["robots"]["random"]
        else:
            assert block.kind == "none", f"{where}: nobody knows how to run {block.kind!r}"


def test_a_page_with_a_mistake_fails(tmp_path, monkeypatch):
    for text in (
        "    >>> 1 + 1\n    3\n",
        "```python\n1 / 0\n```\n",
        "```console\n$ trihex paln x\n```\n",
        "```rust\n```\n",
    ):
        path = tmp_path / "page.md"
        path.write_text(text)
        monkeypatch.setattr(sys.modules[__name__], "ROOT", tmp_path)
        with pytest.raises((AssertionError, ZeroDivisionError)):
            test_every_block_of_a_page_runs(path, tmp_path, monkeypatch)


@pytest.mark.parametrize("path", SCRIPTS, ids=name_of)
def test_every_example_runs_and_leaves_its_picture(path, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", [path.name, str(tmp_path)])
    runpy.run_module(f"examples.{path.stem}", run_name="__main__")  # as the gallery says
    assert capsys.readouterr().out.strip()
    made = {file.name for file in tmp_path.iterdir()}
    assert made & {f"{path.stem}{ending}" for ending in (".png", ".gif", ".svg")}
    assert made - {"waypoints.csv"} <= {file.name for file in (ROOT / "docs" / "figures").iterdir()}


def test_figures_in_the_pages_are_those_of_the_scripts(tmp_path):
    """Words, numbers and cells are compared, not pixels: fonts of other versions are wider by a hair."""
    from examples import concepts
    from examples.drawing import save
    from examples.paper.__main__ import MODULES

    made = [path for module in (*MODULES, concepts) for path in save(tmp_path, module.figures())]
    assert len({path.name for path in made}) == len(made) >= 20
    for path in made:
        assert _drawn(path) == _drawn(ROOT / "docs" / "figures" / path.name), f"{path.name}: make figures"


def _drawn(path: Path) -> tuple[list[str], list[str]]:
    text = path.read_text(encoding="utf-8")
    return re.findall(r">([^<>]+)</t", text), re.findall(r'<path fill="[^"]+"', text)


def test_every_figure_is_shown_and_every_figure_shown_exists():
    shown = set()
    for path in DOCS:
        for target in re.findall(r"!\[[^\]]*\]\((\S+)\)", path.read_text(encoding="utf-8")):
            figure = (path.parent / target).resolve()
            assert figure.is_file(), f"{name_of(path)}: {target}"
            shown.add(figure.name)
    assert shown == {file.name for file in (ROOT / "docs" / "figures").iterdir()}


def slugs_of(path: Path) -> set[str]:
    headings = re.findall(r"^#+ (.+)$", path.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("path", PAGES, ids=name_of)
def test_links_lead_somewhere(path):
    text = re.sub(r"`[^`\n]*`", "", path.read_text(encoding="utf-8"))
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        parts = urlsplit(target)
        if parts.scheme:
            assert parts.scheme in ("http", "https") and "." in parts.netloc, target
            continue
        there = (path.parent / parts.path).resolve() if parts.path else path
        assert there.exists(), f"{name_of(path)}: {target}"
        assert there.is_relative_to(ROOT), target
        if parts.fragment:
            assert parts.fragment in slugs_of(there), f"{name_of(path)}: {target}"


def test_every_dependency_has_its_reason():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    groups = [project["dependencies"], *project["optional-dependencies"].values()]
    wanted = {re.match(r"[\w-]+", one)[0] for group in groups for one in group}
    rows = [line for line in (ROOT / "CONTRIBUTING.md").read_text().splitlines() if line.startswith("| ")]
    told = {name for row in rows for cell in row.split("|")[1:-2] for name in re.findall(r"[\w-]+", cell)}
    assert wanted <= told, "tell in CONTRIBUTING.md what it is for"


def test_every_page_is_in_the_navigation_and_every_public_name_in_the_reference():
    entries = re.findall(r"```\{toctree\}.*?```", (ROOT / "docs" / "index.md").read_text(), re.DOTALL)
    lines = [line.strip() for entry in entries for line in entry.splitlines() if not line.startswith((":", "```"))]
    reached = {path for line in lines if line for path in (ROOT / "docs").glob(f"{line}.md")} | {
        ROOT / "docs" / "index.md"
    }
    api = ROOT / "docs" / "api"
    reached |= {api / f"{line}.md" for line in (api / "index.md").read_text().splitlines() if line}
    assert set(DOCS) <= reached
    directives = [re.findall(r"public-names:: (.*)", path.read_text()) for path in api.glob("*.md")]
    packages = [package for found in directives for names in found for package in names.split()]
    homes = set(re.findall(r"^from \.(\w+) import", (ROOT / "src/trihex/__init__.pyi").read_text(), re.MULTILINE))
    assert sorted(packages) == sorted(homes), "name the package on a page of docs/api"


def test_plain_markdown_shows_all_pages_and_no_navigation_of_sphinx():
    """Code hosts show Markdown plainly: there a toctree is a box of words, and the only way on is a link."""
    shown = {path: re.sub(r"<!--.*?-->", "", path.read_text(encoding="utf-8"), flags=re.DOTALL) for path in DOCS}
    assert [name_of(path) for path, text in shown.items() if "{toctree}" in text] == []
    index, api = ROOT / "docs" / "index.md", ROOT / "docs" / "api" / "index.md"
    linked = {
        (page.parent / target).resolve() for page in (index, api) for target in re.findall(r"\]\(([^)#]+)", shown[page])
    }
    missing = {name_of(path) for path in set(DOCS) - linked - {index}}
    assert missing == set(), "link it in docs/index.md, under All pages"


def test_the_overview_of_the_api_is_that_of_the_docstrings():
    reference = runpy.run_path(str(ROOT / "docs" / "reference.py"))
    assert reference["PAGE"].read_text(encoding="utf-8") == reference["page"](), "run `python docs/reference.py`"
    assert set(reference["names_of_package"]()) == set(reference["TITLES"])


def test_every_planner_and_every_format_that_is_written_has_its_row():
    planners = (ROOT / "docs" / "planners.md").read_text()
    assert [name for name in PLANNERS if f"| `{name}`" not in planners] == []
    formats = (ROOT / "docs" / "formats.md").read_text()
    assert [suffix for kind in WRITERS.values() for suffix in kind if suffix not in formats] == []
