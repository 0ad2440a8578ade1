"""The package as a whole: its public names, its layers, its start-up."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

import trihex as th

ROOT = Path(__file__).parents[1]


@pytest.mark.parametrize("name", th.__all__)
def test_every_public_name_exists_and_is_described(name):
    thing = getattr(th, name)
    if callable(thing):
        assert thing.__doc__ and not thing.__doc__.startswith(f"{name}("), f"{name} has no docstring of its own"


def test_the_type_checker_sees_the_same_names():
    """The list is written once: what is imported by name is what the stub says, each name from a package."""
    source = (ROOT / "src/trihex/__init__.pyi").read_text()
    assert set(re.findall(r"^    (\w+) as \1,$", source, re.MULTILINE)) == set(th.__all__)
    with pytest.raises(AttributeError, match="nothing"):
        th.nothing  # noqa: B018


def test_layers_are_kept():
    done = subprocess.run(
        [sys.executable, "-c", "import sys; from importlinter.cli import lint_imports; sys.exit(lint_imports())"],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout


def test_importing_trihex_imports_no_heavy_library():
    heavy = "{'numpy', 'numba', 'matplotlib', 'PIL', 'pydantic'}"
    code = f"import sys, trihex, trihex.cli; print(sorted({heavy} & set(sys.modules)))"
    assert subprocess.check_output([sys.executable, "-c", code], text=True) == "[]\n"


def test_making_records_imports_no_numba():
    code = (
        "import sys, trihex as th; area = th.Area('hexagonal', [[0, 0, 1]]);"
        "th.Scenario(area, [(0, 0)], th.random_robots(area, 2)); print('numba' in sys.modules)"
    )
    assert subprocess.check_output([sys.executable, "-c", code], text=True) == "False\n"
