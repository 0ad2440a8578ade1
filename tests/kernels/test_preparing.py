"""Kernels are compiled before the work begins, side by side, once; and what is prepared is what the work takes."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.kernels.test_sources import copy_of_package
from tests.sweeps import swept
from trihex.fields import every_field_kernels
from trihex.kernels import preparing
from trihex.kernels.marks import is_marked
from trihex.kernels.needs import KERNELS_OF, Kernels, kernels_of
from trihex.planners import PLANNERS

PREPARE = """
import logging, sys
logging.basicConfig(level=logging.INFO, stream=sys.stdout, format="%(message)s")
from trihex.kernels import preparing
preparing.watch = lambda done, total: print(done, "of", total)
preparing.prepare("table", "archive")
"""


def run(code, folder, **environment):
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False, timeout=300,
        env={**os.environ, "PYTHONPATH": str(folder), **environment},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def test_what_is_missing_is_compiled_once_and_again_when_its_source_has_changed(tmp_path):
    package, place = copy_of_package(tmp_path), {"NUMBA_CACHE_DIR": str(tmp_path / "kept")}
    first = run(PREPARE, tmp_path, **place)
    assert first[:2] == ["compiling kernels, once: 2 parts", "0 of 2"] and first[-2] == "2 of 2"
    assert run(PREPARE, tmp_path, **place) == []
    for path in (tmp_path / "kept").rglob("*.nbi"):  # a mark alone does not count
        path.unlink()
    assert run(PREPARE, tmp_path, **place)[-2] == "2 of 2"
    actions = package / "kernels" / "actions.py"
    actions.write_text(actions.read_text() + "\n")
    assert run(PREPARE, tmp_path, **place)[-2] == "2 of 2"


def test_where_nothing_can_be_kept_work_goes_on_and_that_is_said(tmp_path):
    code = """
import logging, sys
logging.basicConfig(level=logging.INFO, stream=sys.stdout, format="%(message)s")
from trihex.kernels import caching, marks
def nowhere(self, function): raise RuntimeError("no locator")
caching._Kept.__init__, marks._folders = nowhere, lambda: iter(())
import trihex as th
area = th.Area("square", [[0, 0, 0]])
print(th.make_n_scheme(th.Scenario(area, [(0, 0)])).distance.tolist())
"""
    lines = run(code, Path(preparing.__file__).parents[2])
    assert lines[-1] == "[[0, 10, 20]]"
    assert [line for line in lines if "NUMBA_CACHE_DIR" in line] == lines[:-1] and len(lines) == 2


def test_what_cannot_be_compiled_beforehand_is_left_to_who_imports_it(caplog):
    parts = [Kernels("trihex.kernels.codes"), Kernels("trihex.kernels.there_is_none")]
    preparing._compile(parts, lambda done, total: None)
    assert ["there_is_none" in line for line in caplog.messages] == [True]


USES = {
    **{name: f'th.make_plan(scenario, "{name}")' for name in PLANNERS},
    "audit": "th.audit_plan(plan)",
    "bound": "th.make_lower_bound(th.make_n_scheme(scenario))",
    "slot_bound": "from trihex.bounds import slot_bound; slot_bound(th.make_n_scheme(scenario))",
    "d_scheme": "th.make_d_scheme(th.make_n_scheme(scenario))",
    "trial": "th.Trial(scenario, sensor=2).run()",
    "order": "th.make_passing_order(plan).run(delay=0.1)",
    "picture": "th.picture_of_plan(plan).to_array()",
    "table": "th.write_plan(plan, folder / 'plan.csv'); th.read_plan(folder / 'plan.csv', scenario)",
    "archive": "th.write_plan(plan, folder / 'plan.npz'); th.read_plan(folder / 'plan.npz')",
}


@pytest.mark.parametrize("use", list(USES)[: swept(len(USES), 3)])
def test_what_is_prepared_is_what_the_work_takes(use, tmp_path):
    """No kernel is imported during the work that was not loaded before it."""
    code = f"""
import sys
from pathlib import Path
import trihex as th
from trihex.kernels.preparing import prepare
from trihex.planners import uses_of
def kernels():
    modules = [module for name, module in sys.modules.items() if ".kernels." in name and name.count(".") > 2]
    return {{module.__name__ for module in modules if any(hasattr(one, "py_func") and one.signatures
                                                          for one in vars(module).values())}}
folder = Path({str(tmp_path)!r})
area = th.make_rooms_area("hexagonal", 24, 32, seed=1)
exits = [(1, 1)]
scenario = th.Scenario(area, exits, th.random_robots(area, 60, seed=1, avoid=exits))
is_planner = {use!r} in {tuple(PLANNERS)!r}
if not is_planner:
    plan = th.make_plan(scenario, "greedy")
prepare(*(uses_of({use!r}, scenario) if is_planner else [{use!r}]), "n_scheme")
before = kernels()
{USES[use]}
print(sorted(kernels() - before))
"""
    assert run(code, Path(preparing.__file__).parents[2]) == ["[]"]


def test_every_module_of_kernels_can_be_compiled_beforehand():
    """All that hold kernels are named, but those of the shapes of fields, which are made by their shape."""
    files = preparing.file_of("trihex").parent.glob("trihex/*/kernels/*.py")
    holding = {path.stem for path in files if re.search(r"^@(kernel|njit)", path.read_text(), re.MULTILINE)}
    named = {kernels.module.rpartition(".")[2] for kernels in kernels_of(KERNELS_OF)}
    assert len(holding) > 30 and holding == named  # what holds helpers alone would never count as compiled
    assert {kernels.module.rpartition(".")[2] for kernels in every_field_kernels()} == {"buckets", "queue"}


def test_what_was_not_compiled_is_not_marked():
    codes = Kernels("trihex.kernels.codes")
    preparing._compile([codes], lambda done, total: None)
    assert not is_marked(codes)


def test_every_use_names_kernels_that_there_are():
    for use in KERNELS_OF:
        assert all(preparing.file_of(kernels.module).is_file() for kernels in kernels_of([use])), use
    assert kernels_of(["nothing"]) == []
