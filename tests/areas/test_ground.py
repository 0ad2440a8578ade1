"""Ground: what stands in the world, from files to pixels of pictures."""

import json

import numpy as np
import pytest
from PIL import Image

import trihex as th
from trihex.areas import Ground
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


def test_points_are_looked_up_in_edge_steps():
    ground = Ground([[0, 1], [1, 0]], 0.5)
    assert ground.occupied_at([[0.1, 0.6, 1.0]], [[0.1], [0.6], [-0.1]]).tolist() == [
        [False, True, False],
        [True, False, False],
        [False, False, False],
    ]


@pytest.mark.parametrize("suffix", ["yaml", "pgm"])
def test_maps_and_images_bring_their_ground(tmp_path, suffix):
    pixels = write_house(tmp_path)
    options = {"cell_size": 0.5, "resolution": 0.1 if suffix == "pgm" else None}
    draft = read_draft(tmp_path / f"house.{suffix}", "square", **options)
    assert np.array_equal(draft.ground.occupied, pixels == 0)
    assert draft.ground.square == pytest.approx(0.2)


def test_polygons_are_drawn_as_ground(tmp_path):
    hall = [[[0, 0], [8, 0], [8, 4], [0, 4], [0, 0]], [[2, 1], [4, 1], [4, 2], [2, 2], [2, 1]]]
    features = [("free", "Polygon", hall), ("obstacle", "LineString", [[6, 0], [6, 2]])]
    document = {
        "type": "FeatureCollection",
        "features": [
            {"type": "Feature", "properties": {"kind": kind}, "geometry": {"type": shape, "coordinates": coordinates}}
            for kind, shape, coordinates in features
        ],
    }
    (tmp_path / "hall.json").write_text(json.dumps(document))
    ground = read_draft(tmp_path / "hall.json", "square", cell_size=1.0).ground
    assert ground.occupied_at([3, 1, 6, 6, 3], [2.5, 2.5, 3, 1, 1]).tolist() == [True, False, True, False, False]


@pytest.mark.parametrize("suffix", ["png", "svg"])
def test_pictures_show_the_ground_below_the_marks(tmp_path, suffix):
    ground = Ground([[0, 0, 0, 0], [0, 0, 0, 1]], 1.0)
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
