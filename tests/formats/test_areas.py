"""Areas and letters: what is written is read again, and files are known by what is in them."""

import numpy as np
import pytest
from hypothesis import given, settings

from tests.formats.strategies import areas, scenarios
from trihex import Area, FormatError, Scenario, read_area, read_scenario, write_area, write_scenario
from trihex.formats import read_draft


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("areas")


@pytest.mark.parametrize("name", ["area.map", "area.txt", "area.toml"])
@settings(deadline=None, max_examples=50)
@given(area=areas())
def test_area_round_trip(folder, name, area):
    path = folder / name
    write_area(area, path)
    again = read_area(path, area.tessellation)
    assert np.array_equal(again.barriers, area.barriers)
    assert again.tessellation == area.tessellation
    assert again.name == "area"


@settings(deadline=None, max_examples=25)
@given(area=areas())
def test_an_area_goes_from_each_format_to_each_other(folder, area):
    suffixes = ("map", "txt", "toml", "png", "pgm", "bmp")
    for one, other in ((one, other) for one in suffixes for other in suffixes):
        write_area(area, folder / f"one.{one}")
        write_area(read_area(folder / f"one.{one}", area.tessellation), folder / f"other.{other}")
        again = read_area(folder / f"other.{other}", None if one == other == "toml" else area.tessellation)
        assert np.array_equal(again.barriers, area.barriers)
        assert again.tessellation == area.tessellation


@settings(deadline=None, max_examples=50)
@given(scenario=scenarios())
def test_letters_round_trip(folder, scenario):
    path = folder / "letters.txt"
    if np.intersect1d(scenario.robots, scenario.destinations).size:
        with pytest.raises(FormatError, match="holds both"):
            write_scenario(scenario, path)
        return
    write_scenario(scenario, path)
    again = read_scenario(path, scenario.area.tessellation)
    assert np.array_equal(again.robots, scenario.robots)
    assert set(again.destinations) == set(scenario.destinations)
    assert np.array_equal(again.area.barriers, scenario.area.barriers)


def test_movingai_letters(tmp_path):
    path = tmp_path / "w.map"
    path.write_text("type octile\nheight 2\nwidth 4\nmap\n.GSE\n@OTW\n")
    assert read_area(path).barriers.tolist() == [[False] * 4, [True] * 4]
    assert read_area(path).tessellation.name == "hexagonal"
    assert read_area(path, "square").tessellation.name == "square"


@pytest.mark.parametrize(
    "text", ["height 1\nwidth 2\ntype tile\nmap\n.@", "type  hex \nwidth 2\nheight 1\nmap\n.@\n\n\n"]
)
def test_movingai_header_in_any_order(tmp_path, text):
    path = tmp_path / "a.map"
    path.write_text(text)
    assert read_area(path).barriers.tolist() == [[False, True]]


def test_line_ends_of_windows_and_byte_order_mark(tmp_path):
    path = tmp_path / "a.map"
    path.write_bytes(b"\xef\xbb\xbftype octile\r\nheight 2\r\nwidth 2\r\nmap\r\n.@\r\n@.\r\n")
    assert read_area(path).barriers.tolist() == [[False, True], [True, False]]
    letters = tmp_path / "a.txt"
    letters.write_bytes(b".B\r\na.")
    assert read_area(letters).barriers.tolist() == [[False, True], [False, False]]


def test_formats_are_known_by_content(tmp_path):
    letters, movingai = tmp_path / "letters.map.bak", tmp_path / "movingai.txt"
    letters.write_text("B.\n.D\n")
    movingai.write_text("type octile\nheight 1\nwidth 3\nmap\n.@.\n")
    assert read_area(letters).barriers.tolist() == [[True, False], [False, False]]
    assert read_area(movingai).barriers.tolist() == [[False, True, False]]


def test_robots_are_numbered_by_letter(tmp_path):
    path = tmp_path / "w.txt"
    path.write_text("c.D\nzab\n")
    scenario = read_scenario(path, "square")
    assert scenario.robots.tolist() == [4, 5, 0, 3]  # a, b, c, z
    assert scenario.destinations.tolist() == [2]


def test_letters_without_destination_or_robots_leave_them_open(tmp_path):
    path = tmp_path / "w.txt"
    path.write_text("..B\n")
    draft = read_draft(path)
    assert draft.destinations is None
    assert draft.robots is None


def test_letters_cannot_carry_27_robots(tmp_path):
    scenario = Scenario(Area("square", np.zeros((4, 10))), [(0, 0)], np.arange(1, 28))
    with pytest.raises(FormatError, match="at most 26 robots, not 27"):
        write_scenario(scenario, tmp_path / "w.txt")
    assert list(tmp_path.iterdir()) == []


def test_large_area_round_trip(tmp_path):
    barriers = np.random.default_rng(1).random((900, 1100)) < 0.3
    for name in ("w.map", "w.txt"):
        write_area(Area("triangular", barriers), tmp_path / name)
        assert np.array_equal(read_area(tmp_path / name).barriers, barriers)


@pytest.mark.parametrize("rows", ["#####\n#a.D#\n##.##\n", "#abcD#\n######\n", "BB#\na.D\n"])
@pytest.mark.parametrize("name", ["walls.txt", "walls"])
def test_walls_may_be_hashes(tmp_path, rows, name):
    (tmp_path / name).write_text(rows)
    (tmp_path / "plain.txt").write_text(rows.replace("#", "B"))
    own, plain = read_scenario(tmp_path / name), read_scenario(tmp_path / "plain.txt")
    assert own.area.barriers.tolist() == plain.area.barriers.tolist()
    assert own.robots.tolist() == plain.robots.tolist() and own.destinations.tolist() == plain.destinations.tolist()


@pytest.mark.parametrize("text", ['# A hall.\n\n[area]\nrows = ["..", ".."]\n', '#\n\narea.rows = ["..", "#."]\n'])
def test_toml_may_begin_with_a_comment(tmp_path, text):
    (tmp_path / "hall").write_text(text)
    assert read_area(tmp_path / "hall").barriers.sum() == text.count('"#')


def test_a_wrong_letter_among_walls_is_told_as_such(tmp_path):
    (tmp_path / "walls").write_text("#####\n#X.D#\n#####\n")
    with pytest.raises(FormatError, match="row 1, column 1: unknown letter 'X'"):
        read_area(tmp_path / "walls")
