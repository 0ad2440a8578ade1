"""Tables of results, read as they were written."""

import pytest

import trihex as th
from trihex.formats import write_values
from trihex.studies import on_tessellations

AREA = {"generator": "random", "size": [8, 6], "name": 'a "b", c\nd'}
RUNS = [{"area": AREA, "robots": 3, "seed": seed, "planner": name} for seed in (1, 2) for name in ("greedy", "fcost")]


@pytest.mark.parametrize("name", ["study.csv", "study.parquet"])
def test_rows_are_read_as_they_were_written(tmp_path, name):
    runs = [*RUNS, {**RUNS[0], "robots": 1000}]
    th.write_study(th.studies.study.make_study(runs), tmp_path / name, jobs=1)
    seconds = ("seconds_area", "seconds_field", "seconds_plan", "seconds_audit", "seconds_bound")
    rows, wanted = th.read_results(tmp_path / name), th.run_study(runs)
    assert [list(row) for row in rows] == [list(row) for row in wanted]
    for row, other in zip(rows, wanted, strict=True):
        assert {**row, **dict.fromkeys(seconds)} == {**other, **dict.fromkeys(seconds)}
        assert all(value is None or isinstance(value, float) for value in (row[name] for name in seconds))
    assert rows[4]["gap"] is None and "free" in rows[4]["error"]


def test_tables_of_comparisons_are_read_alike(tmp_path):
    area = th.Area("square", [[0, 0, 0, 0]], "row")
    scenario = th.Scenario(area, [(3, 0)], [(0, 0), (1, 0)])
    rows = th.make_comparison(on_tessellations(scenario, ["square", "hexagonal"]), ["greedy"]).rows()
    write_values(rows, tmp_path / "table.csv")
    read = th.read_results(tmp_path / "table.csv")
    assert read == [{**row, "refusal": None} for row in rows]


GOOD = "tessellation,planner,total_time,gap,optimal,mine\nsquare,greedy,30,0.5,False,x\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (GOOD.replace("gap,", "gaps,"), "is no table of a study or comparison: there is no column 'gap'"),
        (GOOD.replace("0.5", "half"), "line 2: gap must be a number, not 'half'"),
        (GOOD.replace("30", "3.5"), "line 2: total_time must be a whole number, not '3.5'"),
        (GOOD.replace("False", "no"), "line 2: optimal must be True or False, not 'no'"),
        (GOOD + "square,greedy\n", "line 3: there must be 6 columns, as in the header, not 2"),
        (GOOD + '"square\n', "line 3: is no CSV: unexpected end of data"),
        ("", "the file is empty"),
    ],
)
def test_what_is_no_table_is_refused(tmp_path, text, message):
    path = tmp_path / "t.csv"
    path.write_text(text)
    with pytest.raises(th.FormatError) as error:
        th.read_results(path)
    assert str(error.value) == f"{path}: {message}"


def test_columns_of_ones_own_are_text_and_empty_ones_none(tmp_path):
    (tmp_path / "t.csv").write_text(GOOD + "square,greedy,,,,\n")
    first, second = th.read_results(tmp_path / "t.csv")
    assert first == dict(tessellation="square", planner="greedy", total_time=30, gap=0.5, optimal=False, mine="x")
    assert second == {**dict.fromkeys(first), "tessellation": "square", "planner": "greedy"}


def test_other_files_are_refused(tmp_path):
    (tmp_path / "t.parquet").write_bytes(b"PAR2")
    with pytest.raises(th.FormatError, match="is no Parquet file"):
        th.read_results(tmp_path / "t.parquet")
    with pytest.raises(th.FormatError, match=r"the suffix of results must be one of .csv, .parquet, not '.xlsx'"):
        th.read_results(tmp_path / "t.xlsx")
    with pytest.raises(FileNotFoundError):
        th.read_results(tmp_path / "none.csv")
