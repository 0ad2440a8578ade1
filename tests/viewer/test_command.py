"""`trihex view`: what it tells, serves and refuses."""

import re
import signal
import subprocess
import sys
from urllib.request import ProxyHandler, build_opener

import pytest
from click.testing import CliRunner

import trihex as th
from trihex.cli import main
from trihex.planners import make_plan
from trihex.viewer import open_viewer


def test_it_tells_an_address_serves_it_and_stops_when_interrupted(tmp_path):
    scenario = th.Scenario(th.Area("square", [[0, 0, 0]]), [(2, 0)], [(0, 0)])
    th.write_plan(make_plan(scenario, "greedy"), tmp_path / "plan.npz")
    words = [sys.executable, "-m", "trihex", "view", "plan.npz", "--no-browser"]
    with subprocess.Popen(words, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
        address = re.search(r"http://127\.0\.0\.1:\d+/[\w-]{20,}/", process.stdout.readline())
        with build_opener(ProxyHandler({})).open(address[0], timeout=180) as page:
            assert b"<title>trihex</title>" in page.read()
        process.send_signal(signal.SIGINT)
        assert process.stdout.read() == "Ctrl-C stops it.\nstopped\n"
    assert process.returncode == 0


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["view", "--tessellation", "square"], "name a FILE"),
        (["view", "no-such.map"], "no-such.map"),
        (["view", "--port", "65536"], "at most 65535"),
        (["view", "a.map", "b.map"], "AREA belongs to a plan"),
    ],
)
def test_wrong_use_is_told_in_one_line(tmp_path, monkeypatch, words, told):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.map").write_text("type octile\nheight 1\nwidth 2\nmap\n..\n")
    done = CliRunner().invoke(main, words)
    assert done.exit_code == 2 and told in done.output and done.output.count("\n") == 1


def test_the_folder_must_be_there(tmp_path):
    with pytest.raises(FileNotFoundError):
        open_viewer(folder=tmp_path / "nowhere", browser=False)
