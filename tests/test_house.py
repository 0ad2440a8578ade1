"""The house rules that a machine can see: short functions, few parameters, tuples with names of their own."""

import ast
import subprocess
import sys
from collections import Counter
from pathlib import Path

from trihex.planners import PLANNERS

SRC = Path(__file__).parents[1] / "src/trihex"
MOST_LINES, MOST_PARAMETERS, MOST_LINES_OF_FILE = 60, 10, 400

# Each with its reason; the lists may only become shorter.
MORE_PARAMETERS: dict[str, str] = {}
MORE_LINES: dict[str, str] = {}


def functions():
    """Yield the name, `package/file.py:function`, source lines and node of every function of src."""
    for path in sorted(SRC.rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                yield f"{path.relative_to(SRC).as_posix()}:{node.name}", text.splitlines(), node


def parameters_of(node):
    own = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
    return len(own) - (bool(own) and own[0].arg in ("self", "cls"))


def lines_of_code(lines, node):
    """Return how many lines of a function hold code: neither blank nor comments nor its docstring."""
    first = node.body[0]
    is_documented = isinstance(first, ast.Expr) and isinstance(getattr(first.value, "value", None), str)
    skipped = range(first.lineno, first.end_lineno + 1) if is_documented else range(0)
    numbers = (n for n in range(node.lineno, node.end_lineno + 1) if n not in skipped)
    return sum(1 for n in numbers if (line := lines[n - 1].strip()) and not line.startswith("#"))


def test_no_function_takes_more_than_ten_things():
    found = {name: parameters_of(node) for name, _, node in functions()}
    assert {name for name, count in found.items() if count > MOST_PARAMETERS} == set(MORE_PARAMETERS)


def test_every_function_fits_a_screen():
    found = {name: lines_of_code(lines, node) for name, lines, node in functions()}
    assert {name for name, count in found.items() if count > MOST_LINES} == set(MORE_LINES)


def test_no_file_is_too_long_to_hold_one_idea():
    lengths = {path.name: len(path.read_text().splitlines()) for path in SRC.rglob("*.py")}
    assert {name: n for name, n in lengths.items() if n > MOST_LINES_OF_FILE} == {}


def test_tuples_of_kernels_have_names_of_their_own():
    """Numba takes two classes of the same name and types for one."""
    names = Counter(
        node.name
        for path in SRC.rglob("kernels/*.py")
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.ClassDef) and any(getattr(base, "id", "") == "NamedTuple" for base in node.bases)
    )
    assert [name for name, count in names.items() if count > 1] == []


def test_nothing_is_done_by_assertions(tmp_path):
    """Under ``python -O`` assertions are left out; all planners, the judge and files must work just the same."""
    area = tmp_path / "area.txt"
    area.write_text("..........\n.BB.......\n....B.....\n....B....D\n..........\n")
    code = (
        "import sys; from click.testing import CliRunner; from trihex.cli import main\n"
        f"for planner in {tuple(PLANNERS)}:\n"
        "    plan = ['area.txt', '--robots', '12', '--seed', '1', '--planner', planner, '--out', f'{planner}.npz']\n"
        "    for words in (['plan', *plan], ['check', f'{planner}.npz']):\n"
        "        done = CliRunner().invoke(main, words)\n"
        "        said = [line for line in done.stderr.splitlines() if 'compiling kernels' not in line]\n"
        "        print(__debug__, planner, words[0], done.exit_code, *said)\n"
    )
    done = subprocess.run([sys.executable, "-O", "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == [
        f"False {planner} {command} 0" for planner in PLANNERS for command in ("plan", "check")
    ]
