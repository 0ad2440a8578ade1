"""Scen: starts of robots from the benchmark's own scenarios, goals left aside."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from trihex import Area, AreaError, FormatError, ScenarioError
from trihex.areas import Frame
from trihex.formats import read_area, read_starts

AREA = Area("hexagonal", np.zeros((3, 5)))
GOOD = "version 1\n4\tx.map\t5\t3\t4\t2\t0\t0\t4.0\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("scen")


@settings(deadline=None, max_examples=30)
@given(
    starts=st.lists(st.tuples(st.integers(0, 4), st.integers(0, 2)), max_size=8), end=st.sampled_from(["\n", "\r\n"])
)
def test_starts_in_the_order_of_the_file(folder, starts, end):
    path = folder / "a.scen"
    lines = ["version 1", *(f"{n}\tx.map\t5\t3\t{x}\t{y}\t0\t1\t{n / 2}" for n, (x, y) in enumerate(starts)), ""]
    path.write_bytes(end.join(lines).encode())
    assert read_starts(path, AREA).tolist() == [y * 5 + x for x, y in starts]


def test_columns_may_be_parted_by_spaces_and_the_name_may_be_any(tmp_path):
    (tmp_path / "a").write_text(GOOD.replace("\t", " ").replace("version 1", "version 1.0"))
    assert read_starts(tmp_path / "a", AREA).tolist() == [14]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("version 1", "verzion 1", r"line 1: must be 'version 1', not 'verzion 1'"),
        ("\t5\t3\t", "\t6\t3\t", "line 2: is for an area of 6 x 3 cells, not of 5 x 3"),
        ("\t4\t2\t", "\t5\t2\t", r"line 2: start \(5, 2\) lies outside the area"),
        ("\t4\t2\t", "\t-1\t2\t", "line 2: start x must be a whole number, not '-1'"),
        ("\t4\t2\t", "\t4\t1" + "0" * 5000 + "\t", "line 2: start y must be a whole number"),
        ("\t0\t0", "\t0", "line 2: must have 9 columns .*, not 8"),
    ],
)
def test_lines_that_are_wrong_are_named(tmp_path, old, new, message):
    (tmp_path / "a.scen").write_text(GOOD.replace(old, new))
    with pytest.raises(FormatError, match=message):
        read_starts(tmp_path / "a.scen", AREA)


def test_a_scen_file_is_no_area(tmp_path):
    (tmp_path / "a.scen").write_text(GOOD)
    with pytest.raises(FormatError, match="must hold an area, not starts"):
        read_area(tmp_path / "a.scen")


def test_one_start_twice_is_told_by_the_scenario(tmp_path):
    (tmp_path / "a.scen").write_text(GOOD + GOOD.partition("\n")[2])
    from trihex import Scenario

    with pytest.raises(ScenarioError, match="robots 0 and 1 both start at"):
        Scenario(AREA, [(0, 0)], read_starts(tmp_path / "a.scen", AREA))


def test_starts_may_be_points_in_metres(tmp_path):
    area = Area("square", np.zeros((3, 5)), frame=Frame(0.5, (10.0, 20.0)))
    (tmp_path / "a.csv").write_text("x_metres,y_metres\r\n10.1,19.9\r\n12.2,18.6\r\n")
    assert read_starts(tmp_path / "a.csv", area).tolist() == [0, 14]
    (tmp_path / "a.csv").write_text("x_metres,y_metres\n")
    assert read_starts(tmp_path / "a.csv", area).tolist() == []
    (tmp_path / "a.csv").write_text("x_metres,y_metres\n10.1,19.9\n12.2\n")
    with pytest.raises(FormatError, match=r"line 3: must be two numbers, not '12.2'"):
        read_starts(tmp_path / "a.csv", area)
    (tmp_path / "a.csv").write_text("x_metres,y_metres\n10.1,19.9\n12.2,nan\n")
    with pytest.raises(FormatError, match=r"line 3: point \(12.2, nan\) metres lies outside the area"):
        read_starts(tmp_path / "a.csv", area)
    with pytest.raises(AreaError, match="give it a frame"):
        read_starts(tmp_path / "a.csv", AREA)
