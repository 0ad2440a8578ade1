"""Tiled fields: equal to those in memory, whatever the tiles, the order and the interruptions."""

import os
import random
import signal
import subprocess
import sys
import time
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from itertools import product

import numpy as np
import pytest
import zarr
from click.testing import CliRunner

import trihex as th
from tests.cluster import make_cluster
from trihex.cli import main
from trihex.errors import FormatError, ScenarioError
from trihex.fields import make_tiled_field

NEIGHBOURHOODS = [
    ("triangular", "full"),
    ("triangular", "edge"),
    ("hexagonal", "full"),
    ("square", "full"),
    ("square", "edge"),
]
RULES = [
    (th.Tessellation(name, neighbourhood, costs), corners)
    for (name, neighbourhood), costs, corners in product(
        NEIGHBOURHOODS, ("paper", "euclidean"), ("allow", "no-squeeze", "no-cut")
    )
]


class AnyOrder(Executor):
    """Runs each call when it is asked for, or one of those before it: results come in any order."""

    def __init__(self, seed):
        self.random, self.held = random.Random(seed), []

    def submit(self, function, /, *arguments):
        future = Future()
        self.held.append((future, function, arguments))
        if len(self.held) == 3:
            self.random.shuffle(self.held)
            while self.held:
                held, call, given = self.held.pop()
                held.set_result(call(*given))
        elif len(self.held) == 1:  # so that somebody is always done
            self.held.pop()
            future.set_result(function(*arguments))
        return future


def draw(rng, sides=(1, 40)):
    height, width = rng.integers(*sides, 2)
    barriers = rng.random((height, width)) < rng.uniform(0, 0.55)
    cells = rng.choice(height * width, size=min(int(rng.integers(1, 4)), height * width), replace=False)
    barriers.reshape(-1)[cells] = False
    return barriers, [(int(cell % width), int(cell // width)) for cell in cells]


def in_memory(barriers, destinations, tessellation, corners="allow"):
    return th.make_n_scheme(th.Scenario(th.Area(tessellation, barriers), destinations, corners=corners)).distance


@pytest.mark.parametrize(("tessellation", "corners"), RULES, ids=lambda rule: getattr(rule, "name", rule))
def test_tiles_of_any_size_give_the_field_in_memory(tessellation, corners, tmp_path):
    rng = np.random.default_rng(5)
    for side in (2 * int(rng.integers(1, 5)), 16, 64):
        barriers, destinations = draw(rng)
        np.save(tmp_path / "area.npy", barriers.astype(rng.choice(["bool", "uint8", "int32"])))
        field = make_tiled_field(
            tmp_path / "area.npy", destinations, tmp_path / "field.npy", tessellation, corners=corners, side=side
        )
        want = in_memory(barriers, destinations, tessellation, corners)
        assert np.array_equal(np.load(field.path), want)
        assert field.shape == barriers.shape
        assert sorted(path.name for path in tmp_path.iterdir()) == ["area.npy", "field.npy"]


def test_a_maze_winds_through_its_tiles_many_times(tmp_path):
    area = th.make_maze_area("hexagonal", 120, 120, seed=1)
    np.save(tmp_path / "area.npy", area.barriers)
    start = tuple(int(i) for i in area.cell_to_xy(np.flatnonzero(~area.barriers)[0]))
    field = make_tiled_field(tmp_path / "area.npy", [start], tmp_path / "field.npy", side=16)
    assert np.array_equal(np.load(field.path), in_memory(area.barriers, [start], "hexagonal"))
    assert field.visit_count > 2 * field.tile_count


@pytest.mark.parametrize("seed", range(6))
def test_tiles_may_be_settled_in_any_order_and_at_once(seed, tmp_path):
    rng = np.random.default_rng(seed)
    barriers, destinations = draw(rng, (30, 60))
    np.save(tmp_path / "area.npy", barriers)
    want = in_memory(barriers, destinations, "triangular")
    for executor in (AnyOrder(seed), ThreadPoolExecutor(4)):
        make_tiled_field(
            tmp_path / "area.npy",
            destinations,
            tmp_path / "field.npy",
            "triangular",
            side=8,
            executor=executor,
            workers=3,
        )
        executor.shutdown()
        assert np.array_equal(np.load(tmp_path / "field.npy"), want)


def test_tiles_are_settled_by_the_workers_of_a_dask_scheduler(tmp_path):
    barriers, destinations = draw(np.random.default_rng(2), (30, 50))
    np.save(tmp_path / "area.npy", barriers)
    x, y = destinations[0]
    with make_cluster(n_workers=2, processes=False) as cluster:
        words = ["field", str(tmp_path / "area.npy"), "--destination", f"{x},{y}", "--out", str(tmp_path / "field.npy")]
        result = CliRunner().invoke(main, [*words, "--tile", "8", "--scheduler", cluster.scheduler_address])
    assert result.exit_code == 0, result.output
    assert np.array_equal(np.load(tmp_path / "field.npy"), in_memory(barriers, destinations[:1], "hexagonal"))


def test_zarr_in_and_out(tmp_path):
    barriers, destinations = draw(np.random.default_rng(3), (30, 50))
    zarr.create_array(tmp_path / "area.zarr", data=barriers, chunks=(16, 16))
    for _ in range(2):  # the second time over the first
        make_tiled_field(tmp_path / "area.zarr", destinations, tmp_path / "field.zarr", side=12)
        found = zarr.open_array(tmp_path / "field.zarr", mode="r")[:]
        assert np.array_equal(found, in_memory(barriers, destinations, "hexagonal"))


class PulledPlugError(Exception):
    """Somebody pulls the plug."""


@pytest.mark.parametrize("visits", [1, 2, 5, 11, 20])
def test_what_was_stopped_goes_on(visits, tmp_path):
    barriers, destinations = draw(np.random.default_rng(visits), (50, 60))
    np.save(tmp_path / "area.npy", barriers)
    arguments = (tmp_path / "area.npy", destinations, tmp_path / "field.npy", "square")
    count = 0

    def stop(done, total):
        nonlocal count
        count += 1
        if count == visits:
            raise PulledPlugError

    with pytest.raises(PulledPlugError):
        make_tiled_field(*arguments, side=8, progress=stop)
    assert not (tmp_path / "field.npy").exists()
    # The tile under way when the plug was pulled may be torn: whatever the journal does not vouch for is garbage now.
    states = np.frombuffer((tmp_path / "field.npy.tiles").read_bytes().split(b"\n", 1)[1], dtype=np.uint8)
    part = np.load(tmp_path / "field.npy.part", mmap_mode="r+")
    columns = -(-barriers.shape[1] // 8)
    for tile in np.flatnonzero(states & 1 == 0):
        row, column = divmod(int(tile), columns)
        part[8 * row : 8 * row + 8, 8 * column : 8 * column + 8] = 7
    del part
    make_tiled_field(*arguments, side=8)
    assert np.array_equal(np.load(tmp_path / "field.npy"), in_memory(barriers, destinations, "square"))


def test_killed_at_random_moments_it_ends_with_the_same_field(tmp_path):
    area = th.make_maze_area("hexagonal", 240, 240, seed=3)
    np.save(tmp_path / "area.npy", area.barriers)
    x, y = (int(i) for i in area.cell_to_xy(np.flatnonzero(~area.barriers)[0]))
    words = [sys.executable, "-m", "trihex", "field", "area.npy", "--destination", f"{x},{y}", "--out", "field.npy"]
    kills, rng = 0, random.Random(1)
    journal = tmp_path / "field.npy.tiles"
    while not (tmp_path / "field.npy").exists():
        process = subprocess.Popen([*words, "--tile", "16"], cwd=tmp_path, stdout=subprocess.DEVNULL)
        while kills < 4 and process.poll() is None and not journal.exists():
            time.sleep(0.01)
        if kills < 4:
            time.sleep(rng.uniform(0, 0.3))
            os.kill(process.pid, signal.SIGKILL)
            kills += 1
        process.wait()
    assert np.array_equal(np.load(tmp_path / "field.npy"), in_memory(area.barriers, [(x, y)], "hexagonal"))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["area.npy", "field.npy"]


def test_another_field_is_not_gone_on_with(tmp_path):
    np.save(tmp_path / "area.npy", np.zeros((20, 20), dtype=bool))

    def stop(done, total):
        raise PulledPlugError

    with pytest.raises(PulledPlugError):
        make_tiled_field(tmp_path / "area.npy", [(1, 1)], tmp_path / "field.npy", side=8, progress=stop)
    for destinations, side in ([(2, 1)], 8), ([(1, 1)], 4):
        with pytest.raises(FormatError, match=r"field.npy.tiles: is of another field; remove it and .*part to begin"):
            make_tiled_field(tmp_path / "area.npy", destinations, tmp_path / "field.npy", side=side)
    make_tiled_field(tmp_path / "area.npy", [(1, 1)], tmp_path / "field.npy", side=8)


def test_bad_input(tmp_path):
    barriers = np.zeros((4, 5), dtype=bool)
    barriers[0, 0] = True
    np.save(tmp_path / "area.npy", barriers)
    np.save(tmp_path / "flat.npy", np.zeros(5))
    (tmp_path / "text.npy").write_text("x" * 200)
    (tmp_path / "none.zarr").mkdir()
    out = tmp_path / "field.npy"
    for arguments, options, error, message in (
        (("area.npy", []), {}, ScenarioError, "at least one cell"),
        (("area.npy", [(5, 0)]), {}, ScenarioError, r"cell \(5, 0\) lies outside the area: x is 0..4, y is 0..3"),
        (("area.npy", [(0, 0)]), {}, ScenarioError, r"\(0, 0\) is a barrier"),
        (("area.npy", [(1, 0)]), {"side": 3}, ScenarioError, "even number from 2 on, not 3"),
        (("area.npy", [(1, 0)]), {"corners": "x"}, ScenarioError, "corners"),
        (("flat.npy", [(1, 0)]), {}, FormatError, r"flat.npy: must hold .*, not float64 of shape \(5,\)"),
        (("text.npy", [(1, 0)]), {}, FormatError, "text.npy: must be an array in numpy's format"),
        (("none.zarr", [(1, 0)]), {}, FormatError, "none.zarr: must be an array in zarr's format"),
        (("nowhere.npy", [(1, 0)]), {}, FileNotFoundError, "nowhere.npy"),
    ):
        with pytest.raises(error, match=message):
            make_tiled_field(tmp_path / arguments[0], arguments[1], out, **options)
    with pytest.raises(FormatError, match="suffix of a field"):
        make_tiled_field(tmp_path / "area.npy", [(1, 0)], tmp_path / "field.csv")
    assert not any(path.name.startswith("field") for path in tmp_path.iterdir())


def test_command(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    barriers, destinations = draw(np.random.default_rng(8), (20, 30))
    np.save("area.npy", barriers)
    x, y = destinations[0]
    words = ["field", "area.npy", "--destination", f"{x},{y}", "--tessellation", "triangular", "--corners", "no-cut"]
    result = CliRunner().invoke(main, [*words, "--out", "field.npy", "--tile", "8"])
    assert result.exit_code == 0, result.output
    assert "tiles" in result.output
    assert np.array_equal(np.load("field.npy"), in_memory(barriers, destinations[:1], "triangular", "no-cut"))
    np.save("map.npy", barriers)
    for wrong, message in (
        (words, "add --out FILE"),
        ([*words, "--out", "f.npy", "--picture", "p.png"], "need an area in memory"),
        ([*words[:2], "--out", "f.npy"], "add --destination X,Y"),
        ([*words, "--out", "f.npy", "--jobs", "2", "--scheduler", "tcp://x"], "exclude each other"),
        (["field", "a.map", "--tile", "8"], "--tile is for areas in .npy or .zarr"),
    ):
        result = CliRunner().invoke(main, wrong)
        assert result.exit_code == 2
        assert message in result.stderr
