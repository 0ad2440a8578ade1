"""Plans as Parquet: what is written is read again, here, by pandas and by polars."""

import numpy as np
import pandas as pd
import polars as pl
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings

from tests.formats.strategies import walks
from trihex import Area, FormatError, Plan, Scenario
from trihex.formats import read_plan, write_plan
from trihex.plans import plan_from_lists

COLUMNS = ["robot", "step", "x", "y", "action", "time"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("parquet")


@settings(deadline=None, max_examples=50)
@given(plan=walks())
def test_parquet_round_trip(folder, plan):
    path = folder / "plan.parquet"
    write_plan(plan, path)
    again = read_plan(path, plan.scenario.with_robots([]))
    assert np.array_equal(again.scenario.robots, plan.scenario.robots)
    assert np.array_equal(again.actions, plan.actions)
    assert np.array_equal(again.first_action, plan.first_action)
    assert again.jumps.size == 0


@settings(deadline=None, max_examples=25)
@given(plan=walks())
def test_pandas_and_polars_read_the_rows_of_the_csv(folder, plan):
    write_plan(plan, folder / "p.parquet")
    write_plan(plan, folder / "p.csv")
    kinds = {name: "str" if name == "action" else "int64" for name in COLUMNS}
    expected = pd.read_csv(folder / "p.csv", dtype=kinds)
    frame = pd.read_parquet(folder / "p.parquet")
    assert frame.columns.tolist() == COLUMNS
    assert all(frame[name].dtype == "int64" for name in COLUMNS if name != "action")
    assert frame.astype({"action": "str"}).values.tolist() == expected.values.tolist()
    polars = pl.read_parquet(folder / "p.parquet")
    assert polars.columns == COLUMNS
    assert [
        list(row) for row in polars.with_columns(pl.col("action").cast(pl.String)).rows()
    ] == expected.values.tolist()


def test_jumps_are_kept_for_the_judge(tmp_path):
    scenario = Scenario(Area("square", [[0, 0, 0]]), [(2, 0)], [(0, 0)])
    plan = Plan(scenario, [254], [0, 1], jumps=[[0, 2]])
    write_plan(plan, tmp_path / "p.parquet")
    assert read_plan(tmp_path / "p.parquet", scenario).jumps.tolist() == [[0, 2]]


def test_what_pandas_and_polars_write_is_read(tmp_path):
    scenario = Scenario(Area("square", [[0, 0, 0]]), [(2, 0)], [(0, 0)])
    plan = plan_from_lists(scenario, [[1, 1]])
    write_plan(plan, tmp_path / "p.parquet")
    frame = pd.read_parquet(tmp_path / "p.parquet")
    frame.assign(action=frame.action.astype("str")).iloc[::-1].to_parquet(tmp_path / "pandas.parquet")
    pl.read_parquet(tmp_path / "p.parquet").cast({"x": pl.Int16}).write_parquet(tmp_path / "polars.parquet")
    for name in ("pandas", "polars"):
        assert np.array_equal(read_plan(tmp_path / f"{name}.parquet", scenario).actions, plan.actions)


GOOD = {"robot": [0, 0], "step": [0, 1], "x": [0, 1], "y": [0, 0], "action": ["start", "E"], "time": [0, 10]}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"time": None}, "there must be one column 'time'; the columns are robot, step, x, y, action"),
        (
            {"x": ["a", "b"]},
            "is no whole Parquet file of a plan: Failed to parse string",
        ),
        ({"x": [0, None]}, "column x must have a value in each row"),
        ({"x": [0.0, 1.5]}, "is no whole Parquet file of a plan: Float value 1.5"),
        ({"x": [0, 2**63]}, "is no whole Parquet file of a plan: Integer value"),
        ({"x": [0, 7]}, r"\(as CSV\): line 3: cell \(7, 0\) lies outside the area"),
        ({"action": ["strat", "E"]}, "action must be one of N, .*, not 'strat'; did you mean 'start'"),
        ({"action": ["E", "E"]}, r"line 2: action must be 'start' at step 0"),
        ({"time": [0, 14]}, "line 3: time must rise by 10 for 'E', not by 14"),
        ({"step": [0, 2]}, "line 3: robot 0 lacks step 1"),
    ],
)
def test_tables_that_are_no_plan_are_refused(tmp_path, change, message):
    columns = {name: values for name, values in (GOOD | change).items() if values is not None}
    arrays = {name: pa.array(values, type=pa.uint64() if 2**63 in values else None) for name, values in columns.items()}
    pq.write_table(pa.table(arrays), tmp_path / "p.parquet")
    with pytest.raises(FormatError, match=message):
        read_plan(tmp_path / "p.parquet", Scenario(Area("square", [[0, 0, 0]]), [(2, 0)]))


@pytest.mark.parametrize("cut", [5, 100, -5, -100])
def test_a_torn_file_is_refused(tmp_path, cut):
    scenario = Scenario(Area("square", [[0, 0, 0]]), [(2, 0)], [(0, 0)])
    write_plan(plan_from_lists(scenario, [[1, 1]]), tmp_path / "p.parquet")
    (tmp_path / "p.parquet").write_bytes((tmp_path / "p.parquet").read_bytes()[:cut])
    with pytest.raises(FormatError, match="is no whole Parquet file"):
        read_plan(tmp_path / "p.parquet", scenario)


def test_a_plan_in_parquet_needs_its_area(tmp_path):
    scenario = Scenario(Area("square", [[0, 0, 0]]), [(2, 0)], [(0, 0)])
    write_plan(plan_from_lists(scenario, [[1, 1]]), tmp_path / "p.parquet")
    with pytest.raises(FormatError, match="does not hold its area; name the area"):
        read_plan(tmp_path / "p.parquet")
