"""Sweeps: small unless asked for, never to nothing, and whole in CI."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
CODE = "from tests.sweeps import swept; print(swept(10_000), swept(30, 10), swept(5, 10), swept(3))"


@pytest.mark.parametrize(
    ("wish", "counts"),
    [(None, "1000 10 5 1"), ("full", "10000 30 5 3"), ("2.5", "25000 75 12 8"), ("0", "1 10 5 1")],
)
def test_sweeps_are_as_large_as_asked_for(wish, counts):
    others = {name: value for name, value in os.environ.items() if name != "TRIHEX_SWEEPS"}
    environment = others if wish is None else {**others, "TRIHEX_SWEEPS": wish}
    command = [sys.executable, "-c", CODE]
    assert subprocess.check_output(command, cwd=ROOT, env=environment, text=True) == f"{counts}\n"


def test_ci_tries_all_cases_and_misses_no_browser():
    lines = (ROOT / ".ci" / "run").read_text().splitlines()
    assert lines[-1] == "make lint test-all" and "export CI=true" in lines
    recipe = (ROOT / "Makefile").read_text().partition("\ntest-all:")[2].splitlines()[1]
    assert recipe.startswith("\tTRIHEX_SWEEPS=full $(BIN)/python -m pytest ")
