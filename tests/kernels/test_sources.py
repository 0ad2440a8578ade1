"""What kernels share: sources from which they are compiled, where they are kept, how they are prepared."""

import ast
import os
import shutil
import subprocess
import sys
from pathlib import Path

import trihex
from trihex.kernels.sources import sources_of, stamp_of

SRC = Path(trihex.__file__).parent


def copy_of_package(folder):
    """Copy the package, without what has been compiled, so that its files can be changed."""
    shutil.copytree(SRC, folder / "trihex", ignore=shutil.ignore_patterns("__pycache__"))
    return folder / "trihex"


def run(code, folder, **environment):
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=300,
        env={**os.environ, "PYTHONPATH": str(folder), **environment},
    )  # fmt: skip


def test_a_stamp_changes_with_helpers_of_other_files(tmp_path):
    package = copy_of_package(tmp_path)
    code = (
        "from trihex.kernels.sources import stamp_of; import trihex.kernels as k; from pathlib import Path;"
        "print(stamp_of(str(Path(k.__file__).parent.parent / 'plans/kernels/replay.py')).hex())"
    )
    before = run(code, tmp_path).stdout
    assert run(code, tmp_path).stdout == before
    actions = package / "kernels" / "actions.py"
    actions.write_text(actions.read_text().replace("    if action == WAIT:", "    if action == WAIT:  # it stays", 1))
    assert run(code, tmp_path).stdout != before


def test_every_kernel_has_a_stamp():
    files = [path for path in SRC.rglob("*/kernels/*.py") if path.name != "__init__.py" and path.parent.parent != SRC]
    assert len({stamp_of(str(path)) for path in files}) == len(files) > 20


def imported_by(path, found):
    """Gather what a file imports of kernels, and what that imports, as the parser of Python sees it."""
    found.add(path)
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and "kernels" in (node.module or ""):
            base = SRC.joinpath(*node.module.split(".")[1:])
            for file in (base.with_suffix(".py"), *(base / f"{alias.name}.py" for alias in node.names)):
                if file.is_file() and file not in found:
                    imported_by(file, found)
    return found


def test_sources_are_all_that_is_imported():
    files = [path for path in SRC.rglob("*/kernels/*.py") if path.name != "__init__.py"]
    for path in files:
        assert set(sources_of(path)) == imported_by(path, set()), path
    assert max(len(sources_of(path)) for path in files) > 8
    greedy = next(path for path in files if path.name == "greedy.py")
    assert "compiling.py" in {path.name for path in sources_of(greedy)}  # imported inside a function
