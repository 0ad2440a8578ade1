"""Journal: what is done stays done, whatever dies; one clear line where a study cannot go on."""

import json
import os
import resource
import signal
import subprocess
import sys
import time

import pyarrow.parquet
import pytest
from click.testing import CliRunner

import trihex as th
from trihex.cli import main
from trihex.studies import dispatch as run, journal as journal_module, journal_of, worker
from trihex.studies.journal import Journal

STUDY = """
seeds = 10
robots = [4, 900]
tessellations = ["square"]
planners = ["greedy", "fcost"]
areas = {generator = "random", size = [12, 9], density = 0.1}
"""


@pytest.fixture
def study(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(run, "_SECONDS_AT_ONCE", 0)  # few runs at a time, however fast they are
    (tmp_path / "study.toml").write_text(STUDY)
    return th.read_study("study.toml")


@pytest.fixture
def here(monkeypatch):
    """Let the runs of the command line be done in this process, which costs no start of others."""
    monkeypatch.setattr(run, "_processes", lambda _: run._given(None))


def table(path):
    rows = [line.split(",") for line in path.read_text().splitlines()]
    kept = [i for i, name in enumerate(rows[0]) if not name.startswith("seconds")]
    # No cell of this study has a comma but options, which stand before the seconds, and nothing else follows them.
    return [row[: kept[-1] + 1 + len(row) - len(rows[0])] for row in rows]


def asked(*words):
    return CliRunner().invoke(main, ["study", *words])


class Killed(BaseException):
    """What ends the process in the midst of its work."""


def killed_after(rows, study, path="t.csv"):
    """Do the study until some rows are done."""

    def progress(done, total):
        if done >= rows:
            raise Killed

    with pytest.raises(Killed):
        th.write_study(study, path, executor=InTurn(), progress=progress)


class InTurn:
    """An executor that does what it is given at once."""

    def submit(self, function, *arguments):
        from concurrent.futures import Future

        future = Future()
        future.set_result(function(*arguments))
        return future


def test_the_table_of_a_study_killed_and_gone_on_with_is_that_of_one_undisturbed(study, tmp_path, monkeypatch):
    monkeypatch.setattr(run, "_ROWS_AT_ONCE", 3)
    outcome = th.write_study(study, "whole.csv", executor=InTurn())
    assert (outcome.runs, outcome.failed, outcome.unsafe) == (40, 20, 0)
    for rows in (0, 1, 7, 22):
        killed_after(rows, study)
    seen = []
    th.write_study(study, "t.csv", executor=InTurn(), progress=lambda *done: seen.append(done))
    assert 22 <= seen[0][0] < 30 and seen[-1] == (40, 40)
    assert table(tmp_path / "t.csv") == table(tmp_path / "whole.csv")
    assert not journal_of("t.csv").exists()


@pytest.mark.parametrize("cut", [1, 30, 400, 700])
def test_a_torn_last_line_is_done_again(study, tmp_path, cut):
    killed_after(40, study)
    path = journal_of("t.csv")
    content = path.read_bytes()
    path.write_bytes(content[:-cut])
    with Journal("t.csv", study) as journal:
        assert 37 <= journal.done_count < 40
        assert [row["run"] for row in journal.rows()] == [i for i in range(40) if journal.is_done[i]]
    assert path.read_bytes().endswith(b"\n")
    th.write_study(study, "t.csv", executor=InTurn())
    rows = [line.split(",")[0] for line in (tmp_path / "t.csv").read_text().splitlines()[1:]]
    assert rows == [str(i) for i in range(40)]


def test_a_torn_header_is_written_again_and_junk_is_left_alone(study):
    path = journal_of("t.csv")
    path.write_bytes(b'{"trihex": "0.')
    with Journal("t.csv", study) as journal:
        assert journal.done_count == 0
    assert json.loads(path.read_bytes())["runs"] == 40
    for junk in (b'{"a": 1}\n', b"x" * 5000):
        path.write_bytes(junk)
        result = asked("study.toml", "--out", "t.csv")
        assert result.exit_code == 2
        assert result.stderr.count("\n") == 1 and "is no journal of a study; move it away" in result.stderr
        assert path.read_bytes() == junk


def test_no_line_counts_twice(study):
    killed_after(12, study)
    path = journal_of("t.csv")
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join([*lines, lines[3], lines[5]]))
    th.write_study(study, "t.csv", executor=InTurn())
    with open("t.csv") as file:
        assert [line.split(",")[0] for line in file][1:] == [str(i) for i in range(40)]


def test_a_changed_study_and_another_version_are_refused(study, tmp_path, here, monkeypatch):
    killed_after(12, study)
    content = journal_of("t.csv").read_bytes()
    (tmp_path / "study.toml").write_text(STUDY.replace("seeds = 10", "seeds = 11"))
    result = asked("study.toml", "--out", "t.csv")
    assert result.exit_code == 2
    assert result.stderr == (
        f"trihex: error: {journal_of('t.csv')}: belongs to another study, or the study was changed since it was begun; "
        "change it back to go on, or remove the journal to begin anew\n"
    )
    assert journal_of("t.csv").read_bytes() == content
    monkeypatch.setattr(journal_module, "versions", lambda: {"trihex": "9.9"})
    result = asked("study.toml", "--out", "t.csv")
    assert result.exit_code == 2 and "was begun by trihex 0.1.0, this is 9.9" in result.stderr
    monkeypatch.undo()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(run, "_processes", lambda _: run._given(None))
    (tmp_path / "study.toml").write_text("# a remark changes nothing\n" + STUDY)
    result = asked("study.toml", "--out", "t.csv")
    assert result.exit_code == 1 and result.output == "t.csv: 40 runs, 20 failed\n"  # 900 robots find no room


def test_two_at_one_study_are_refused(study):
    killed_after(12, study)
    code = "import sys, trihex as th; th.write_study('study.toml', 't.csv')"
    with Journal("t.csv", study):
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert f"{journal_of('t.csv')}: another process is at this study" in done.stderr.splitlines()[-1]


def full_at(size):
    """Let no file grow beyond `size` bytes, as on a disk that is full."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))


def test_a_full_disk_is_told_in_one_line_and_what_is_done_is_kept(study, here, tmp_path):
    th.write_study(study, "whole.csv", executor=InTurn())
    full_at(9000)
    try:
        result = asked("study.toml", "--out", "t.csv")
    finally:
        full_at(resource.RLIM_INFINITY)
    assert result.exit_code == 2
    assert result.stderr == f"trihex: error: {journal_of('t.csv')}: File too large\n"
    with Journal("t.csv", study) as journal:
        assert 4 < journal.done_count < 10
    size = journal_of("t.csv").stat().st_size
    assert 8000 < size <= 9000 and journal_of("t.csv").read_bytes().endswith(b"}\n")
    killed_after(40, study)  # all runs done, but no room for the table
    full_at(9000)
    try:
        result = asked("study.toml", "--out", "t.csv")
    finally:
        full_at(resource.RLIM_INFINITY)
    assert result.exit_code == 2
    assert result.stderr == "trihex: error: t.csv: File too large\n"
    assert {path.name for path in tmp_path.iterdir()} == {"study.toml", "whole.csv", "t.csv.journal"}
    assert asked("study.toml", "--out", "t.csv").exit_code == 1
    assert table(tmp_path / "t.csv") == table(tmp_path / "whole.csv")


def test_outputs_that_cannot_be_are_told_before_the_work(study, monkeypatch):
    for words, line in (
        (["--out", "none/t.csv"], "none: No such directory"),
        (["--out", "t.json"], "t.json: the suffix of results must be one of .csv, .parquet, not '.json'"),
        (["--out", "."], ".: the suffix of results must be one of .csv, .parquet, not ''"),
        (["--jobs", "0"], "--jobs must be a whole number from 1 to 1073741824, not '0' (see trihex study --help)"),
        (["--jobs", "2", "--scheduler", "a"], "--jobs and --scheduler exclude each other (see trihex study --help)"),
    ):  # fmt: skip
        result = asked("study.toml", *words)
        assert (result.exit_code, result.stderr) == (2, f"trihex: error: {line}\n")
    monkeypatch.setattr(os, "access", lambda _, mode, **__: mode != os.W_OK)  # who runs the tests may write anywhere
    result = asked("study.toml", "--out", "t.csv")
    assert (result.exit_code, result.stderr) == (2, "trihex: error: t.csv: Permission denied\n")
    monkeypatch.undo()


def test_results_as_parquet_hold_what_those_as_csv_do(study):
    th.write_study(study, "t.parquet", executor=InTurn())
    rows = pyarrow.parquet.read_table("t.parquet").to_pylist()
    other = th.run_study(study)
    for row, same in zip(rows, other, strict=True):
        assert {k: v for k, v in row.items() if "seconds" not in k} == {
            k: v for k, v in same.items() if "seconds" not in k
        }


def test_processes_killed_in_the_midst_of_it_are_no_loss(study, tmp_path):
    """The process that asks is killed twice and the command given again, then a worker is killed."""
    whole = th.write_study(study, "whole.csv", executor=InTurn())
    words = [sys.executable, "-m", "trihex", "study", "study.toml", "--out", "t.csv", "--jobs", "1"]
    path, rows = journal_of("t.csv"), 0
    for _ in range(2):
        with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as asking:
            while asking.poll() is None and (not path.exists() or path.read_bytes().count(b"\n") < rows + 3):
                time.sleep(0.005)
            asking.send_signal(signal.SIGKILL)
        if not path.exists():  # it was done before it could be killed
            break
        rows = path.read_bytes().count(b"\n")
    killed = []

    def kill(done, total):
        if not killed and done < total and worker._workers and (child := worker._workers[-1]._child):
            killed.append(child.pid)
            os.kill(child.pid, signal.SIGKILL)

    assert th.write_study(study, "t.csv", jobs=1, progress=kill) == whole
    assert table(tmp_path / "t.csv") == table(tmp_path / "whole.csv")


def test_interrupted_it_tells_how_to_go_on(study, here, monkeypatch):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(Journal, "append", interrupted)
    result = asked("study.toml", "--out", "t.csv")
    assert result.exit_code == 130
    assert f"what is done is kept in {journal_of('t.csv')}; the same command goes on\n" in result.stderr
