"""On a terminal every command shows what it is doing; where nobody watches nothing is drawn."""

import os
import pty
import re
import select
import subprocess
import sys
import time

import pytest

STUDY = """
areas = [{generator = "rooms", size = [40, 30]}]
robots = [100]
seeds = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]
planners = ["optimal"]
"""


def on_terminal(words, folder, code="import trihex.cli; trihex.cli.main()"):
    """Run a command on a terminal of no size, as some are, and return what it shows, line by line."""
    own, other = pty.openpty()
    hasty = "import trihex.cli.progress as progress; progress._DELAY = progress._LEAST = progress._PERIOD = 0.02"
    code = f"{hasty}; {code}"
    process = subprocess.Popen(
        [sys.executable, "-c", code, *map(str, words)], cwd=folder, stdin=other, stdout=other, stderr=other
    )
    os.close(other)
    shown, last = b"", time.monotonic() + 300
    while time.monotonic() < last:
        if select.select([own], [], [], 0.1)[0]:
            try:
                shown += os.read(own, 65536)
            except OSError:
                break
        elif process.poll() is not None:
            break
    os.close(own)
    assert process.wait(timeout=60) == 0, shown.decode()
    return [line for line in re.split(r"[\r\n]+", shown.decode()) if line.strip()]


@pytest.mark.skipif(not hasattr(os, "openpty"), reason="this system has no pseudo-terminals")
@pytest.mark.parametrize(
    ("words", "shown", "last"),
    [
        (["plan", "a.map", "--planner", "optimal", "--robots", "400", "--out", "p.npz"], "planning", "written: p.npz"),
        (["compare", "a.map", "--robots", "100", "--out", "t.csv"], "planning: ", "written: t.csv"),
        (["study", "s.toml", "--jobs", "1"], "running: ", "s.csv: 12 runs"),
    ],
)
def test_who_watches_sees_what_is_done(words, shown, last, tmp_path):
    (tmp_path / "s.toml").write_text(STUDY)
    on_terminal(["generate", "rooms", "--size", "60,50", "--seed", "1", "--out", "a.map"], tmp_path)
    goal = [] if words[0] == "study" else ["--destination", "3,4"]
    lines = on_terminal([*words, *goal], tmp_path)
    assert any(line.startswith(shown) for line in lines[:-1]), lines
    assert lines[-1] == last
    if words[0] != "plan":  # a word comes before kernels are loaded and studies are read
        assert lines[0].startswith(f"{shown}0 "), lines


def test_kernels_that_are_missing_are_compiled_under_a_bar_of_their_own(tmp_path, monkeypatch):
    code = (
        "from trihex.kernels import preparing; preparing.watch = progress.show_compiling;"
        "from trihex.cli.progress import bar\n"
        "with bar('planning', 'plans'): preparing.prepare('table', 'archive')"
    )
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    lines = on_terminal([], tmp_path, code)
    assert lines[0].startswith("compiling kernels, once: 0 of 2 [....")
    assert any(line.startswith("compiling kernels, once: 1 of 2") for line in lines)
