"""Scenario files of places in metres: what they say of maps, destinations and robots, and what is wrong with it."""

import numpy as np
import pytest
from PIL import Image

from trihex import FormatError, Tessellation, read_area, read_scenario
from trihex.areas import Frame

TOML = """
destinations_in_metres = [[2.2, 2.2]]
[area]
path = "house.yaml"
tessellation = "square"
cell_size = 0.5
robot_radius = 0.1
unknown = "free"
[robots]
metres = [[1.2, 1.2], [4.1, 3.2]]
"""


@pytest.fixture
def house(tmp_path):
    pixels = np.full((60, 80), 254, dtype=np.uint8)
    pixels[10:20, 30:40] = 0
    Image.fromarray(pixels).save(tmp_path / "house.pgm")
    (tmp_path / "house.yaml").write_text("image: house.pgm\nresolution: 0.1\norigin: [0, 0, 0]\n")
    return tmp_path


def test_a_map_is_read_as_the_file_says(house):
    (house / "s.toml").write_text(TOML)
    scenario = read_scenario(house / "s.toml")
    options = {"cell_size": 0.5, "robot_radius": 0.1, "unknown": "free"}
    assert scenario.area == read_area(house / "house.yaml", "square", **options)
    assert scenario.destinations.tolist() == [scenario.area.xy_to_cell(4, 7)]
    assert scenario.robots.tolist() == scenario.area.xy_to_cell([2, 8], [9, 5]).tolist()
    assert scenario.destination_capacity == 1


def test_the_rule_asked_for_decides_on_the_least_cells(house):
    """On hexagons robots of 0.1 m need 0.4 m if others follow at once, 0.2 / sqrt(3 / 4) = 0.231 m if none does."""
    text = TOML.replace("cell_size = 0.5\n", "").replace("square", "hexagonal")
    sizes = {}
    for following in (None, "allow", "forbid"):
        rule = "" if following is None else f"[rules]\nfollowing = {following!r}\n"
        (house / "s.toml").write_text(text + rule)
        scenario = read_scenario(house / "s.toml")
        sizes[following] = scenario.area.frame.cell_size
        assert scenario.following == (following or "allow")
        own = {} if following is None else {"following": following}
        area = read_area(house / "house.yaml", "hexagonal", robot_radius=0.1, unknown="free", **own)
        assert area == scenario.area
    assert sizes == {None: 0.4, "allow": 0.4, "forbid": 0.231}


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("cell_size = 0.5", "cell_size = 0", "area.cell_size: must be greater than 0, not 0"),
        ("cell_size = 0.5", "cell_size = 0.25", r"area: cell_size must be at least 0\.4473 metres \(0\.2829"),
        ("cell_size = 0.5\nrobot_radius = 0.1\n", "", r"metres\) is measured in metres: say how far apart"),
        ("cell_size = 0.5", "cellsize = 0.5", "area.cellsize: there is no such key; did you mean 'cell_size'"),
        ('"free"', '"fre"', "area.unknown: must be one of barrier, free, not 'fre'; did you mean 'free'"),
        ("[[2.2, 2.2]]", "[[2, 20]]", r"destinations_in_metres: point \(2, 20\) metres lies outside the area"),
        ("[[2.2, 2.2]]", "[[2]]", "destinations_in_metres.0: must have at least 2 items"),
        ("[[2.2, 2.2]]", "[[2, 2]]\ndestinations = [[1, 1]]", "must have only one of destinations, destin"),
        ("[4.1, 3.2]", "[4.1, -3]", r"robots.metres: point \(4.1, -3\) metres lies outside the area"),
        ("[robots]", "[area.frame]\ncell_size = 1\n[robots]", "area: frame is known already from the file"),
        ('path = "house.yaml"', 'rows = ["."]', "area: cell_size tells how the file at area.path is read"),
    ],
)  # fmt: skip
def test_mistakes_name_the_key(house, old, new, message):
    assert old in TOML
    (house / "s.toml").write_text(TOML.replace(old, new))
    with pytest.raises(FormatError, match=message):
        read_scenario(house / "s.toml")


def test_rows_may_have_a_frame_and_places_in_metres(tmp_path):
    rows = 'rows = ["...", "..."]\ntessellation = "hexagonal"\n[area.frame]\ncell_size = 2\norigin = [10, 20]\n'
    (tmp_path / "s.toml").write_text(f"destinations_in_metres = [[11.2, 19.0]]\n[area]\n{rows}")
    scenario = read_scenario(tmp_path / "s.toml")
    assert scenario.area.frame == Frame(2.0, (10.0, 20.0)) and scenario.destinations.tolist() == [0]
    (tmp_path / "s.toml").write_text('destinations_in_metres = [[11.2, 19.0]]\n[area]\nrows = ["..."]\n')
    with pytest.raises(FormatError, match="destinations_in_metres: the area is measured in cells"):
        read_scenario(tmp_path / "s.toml")
    assert scenario.area.tessellation == Tessellation("hexagonal")
