"""Ground: what stands in the world, from files to pixels of pictures."""

import json

import numpy as np
import pytest
from PIL import Image

import trihex as th
from trihex.areas import RasterGround
from trihex.formats import read_draft
from trihex.pictures import picture_of_area, picture_of_plan
from trihex.pictures.palette import GROUND, TIGHT
from trihex.plans import plan_from_lists


def write_house(folder):
    pixels = np.full((60, 80), 254, dtype=np.uint8)
    pixels[20:40, 40] = 0
    pixels[5, 60:70] = 205
    Image.fromarray(pixels).save(folder / "house.pgm")
    (folder / "house.yaml").write_text("image: house.pgm\nresolution: 0.1\norigin: [-1, -1, 0.4]\n")
    return pixels


def test_points_are_looked_up_in_metres():
    ground = RasterGround([[0, 1], [1, 0]], 0.5)
    assert ground.occupied_at([[0.1, 0.6, 1.0]], [[-0.1], [-0.6], [0.1]]).tolist() == [
        [False, True, False],
        [True, False, False],
        [False, False, False],
    ]
    turned = RasterGround([[0, 1], [1, 0]], 0.5, (3.0, -2.0), np.pi / 2)  # its rows run to the north
    assert turned.occupied_at([3.1, 3.1, 3.6, 3.6], [-1.9, -1.4, -1.9, -1.4]).tolist() == [False, True, True, False]


def test_an_area_keeps_its_ground_whatever_becomes_of_its_cells():
    area = th.areas.cover_raster([[0] * 40] * 20, th.areas.Covering("square", 0.5), resolution=0.1)
    assert area.ground.size == (4.0, 2.0) and area.with_tessellation("square").ground is area.ground
    assert area == th.Area("square", area.barriers, frame=area.frame)  # which has none


@pytest.mark.parametrize("suffix", ["yaml", "pgm"])
def test_maps_and_images_bring_their_ground(tmp_path, suffix):
    pixels = write_house(tmp_path)
    options = {"cell_size": 0.5, "resolution": 0.1 if suffix == "pgm" else None}
    ground = read_draft(tmp_path / f"house.{suffix}", "square", **options).area.ground
    assert np.array_equal(ground.shown, pixels == 0)
    assert np.array_equal(ground.occupied, pixels != 254 if suffix == "yaml" else pixels == 0)
    assert ground.resolution == pytest.approx(0.1)


def test_polygons_are_drawn_as_ground(tmp_path):
    hall = [[[0, 0], [8, 0], [8, 4], [0, 4], [0, 0]], [[2, 1], [4, 1], [4, 2], [2, 2], [2, 1]]]
    corners = [
        [(low, low - 4), (high, low - 4), (high, high - 4), (low, high - 4)] for low, high in ((7, 7.8), (7.2, 7.6))
    ]
    ring = [[*ends, ends[0]] for ends in corners]
    features = [
        ("free", "Polygon", hall),
        ("obstacle", "LineString", [[6, 0], [6, 2]]),
        ("obstacle", "Polygon", ring),
    ]
    document = {
        "type": "FeatureCollection",
        "features": [
            {"type": "Feature", "properties": {"kind": kind}, "geometry": {"type": shape, "coordinates": coordinates}}
            for kind, shape, coordinates in features
        ],
    }
    (tmp_path / "hall.json").write_text(json.dumps(document))
    area = read_draft(tmp_path / "hall.json", "square", cell_size=1.0).area
    x, y = np.array([[3, 1, 6, 6, 3, 7.1, 7.4, 9], [1.5, 1.5, 1, 3, 3, 3.1, 3.4, 1]])
    assert area.ground.occupied_at(x, y).tolist() == [True, False, True, False, False, True, False, True]


def test_no_picture_is_made_of_polygons_before_one_is_drawn(tmp_path, monkeypatch):
    """It took longer than all else that `show` does."""
    path = tmp_path / "hall.wkt"
    path.write_text("POLYGON ((0 0, 9 0, 9 6, 0 6, 0 0))")
    monkeypatch.setattr("trihex.areas.ground._inside", None)
    area = read_draft(path, "square", cell_size=1.0).area
    with pytest.raises(TypeError):
        area.ground.occupied_at(1, 1)


@pytest.mark.parametrize("suffix", ["png", "svg"])
def test_pictures_show_the_ground_below_the_marks(tmp_path, suffix):
    ground = RasterGround([[0, 0, 0, 0], [0, 0, 0, 1]], 1.0)
    area = th.Area("square", [[0, 0, 0, 1], [0, 0, 1, 1]], frame=th.Frame(1.0))
    plan = plan_from_lists(th.Scenario(area, [(2, 0)], [(0, 0)]), [[1, 1]])
    for picture in (picture_of_area(area, ground=ground), picture_of_plan(plan, ground=ground)):
        picture.save(tmp_path / f"p.{suffix}")
    if suffix == "svg":
        text = (tmp_path / "p.svg").read_text()
        assert text.count("<image ") == 1 and text.index("<image ") < text.index("<circle ") and "no room" in text
        return
    image = picture_of_area(area, width=400, title="", legend=False, ground=ground).to_array()
    assert [tuple(image[y, x]) for y, x in ((50, 350), (150, 250), (150, 350))] == [TIGHT, TIGHT, GROUND]
    plain = picture_of_area(area, width=400, title="", legend=False).to_array()
    assert tuple(plain[50, 350]) == GROUND
