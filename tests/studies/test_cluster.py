"""Cluster: Dask makes the table that others make, whoever is killed; and what a wrong address says."""

import os
import signal
import socket
from contextlib import suppress
from dataclasses import replace

import pytest
from click.testing import CliRunner

import trihex as th
from tests.cluster import make_cluster
from tests.sweeps import swept
from trihex.cli import main
from trihex.studies import cluster, connected
from trihex.studies.study import make_study

AREA = {"generator": "random", "size": [12, 9], "density": 0.1}
RUNS = [
    {"area": AREA, "robots": 5, "seed": seed, "planner": planner}
    for seed in range(swept(40, 10))
    for planner in ("greedy", "fcost")
]


def without_seconds(rows):
    return [{name: value for name, value in row.items() if not name.startswith("seconds")} for row in rows]


def test_a_cluster_makes_the_same_table_though_its_worker_is_killed():
    killed = []
    with make_cluster(n_workers=1, processes=True) as own:

        def kill(done, total):
            if not killed and done >= 10:
                killed.append(next(iter(own.workers.values())).pid)
                os.kill(killed[0], signal.SIGKILL)

        with connected(own.scheduler_address, seconds=180) as workers:
            rows = th.run_study(RUNS, executor=workers, progress=kill)
            limited = th.run_study(replace(make_study(RUNS[:1]), seconds=600.0), executor=workers)
            with pytest.raises(th.StudyError, match=r"tcp://.*: the worker has trihex 0\.1\.0, this is 9\.9"):
                cluster._check_workers(workers.client, own.scheduler_address, 180, "9.9")
    assert without_seconds(rows) == without_seconds(th.run_study(RUNS))
    assert without_seconds(limited) == without_seconds(rows[:1])
    assert killed


def test_a_scheduler_without_workers_is_of_no_use():
    own = make_cluster(n_workers=0, processes=False, protocol="tcp://")
    told = pytest.raises(th.StudyError, match="the scheduler has no workers; start some with: dask worker tcp://")
    with own, told, connected(own.scheduler_address, seconds=3):
        pass


def test_clusters_need_no_port_of_their_own():
    """Port 8787 is that of the dashboard, which somebody else may have."""
    with socket.socket() as taken, suppress(OSError):
        taken.bind(("127.0.0.1", 8787))
        taken.listen()
        with make_cluster(n_workers=0, processes=False), make_cluster(n_workers=0, processes=False):
            pass


@pytest.mark.parametrize(
    ("address", "line"),
    [
        ("tcp://127.0.0.1:1", "tcp://127.0.0.1:1: no Dask scheduler answers there within 0.3 s"),
        ("nowhere", "scheduler must be an address such as tcp://10.0.0.1:8786, not 'nowhere': missing port number"),
        ("ftp://x:1", "scheduler must be an address such as tcp://10.0.0.1:8786, not 'ftp://x:1': unknown address"),
    ],
)
def test_a_wrong_address_is_told_in_one_line(address, line, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.toml").write_text("robots = [1]\nareas = {generator = 'random', size = [4, 4]}\n")
    monkeypatch.setattr("trihex.studies.connected", lambda address: connected(address, 0.3))
    result = CliRunner().invoke(main, ["study", "s.toml", "--scheduler", address])
    assert result.exit_code == 2
    assert result.stderr.startswith(f"trihex: error: {line}") and result.stderr.count("\n") == 1
    assert {path.name for path in tmp_path.iterdir()} == {"s.toml"}
