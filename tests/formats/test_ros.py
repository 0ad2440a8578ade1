"""ROS maps: each pixel judged by hand, the place in the world, and every mistake a map file may hold."""

from math import pi

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from PIL import Image

from trihex import AreaError, FormatError, TooLargeError, read_area

YAML = (
    "image: {image}\nresolution: 0.1\norigin: [-2.0, 3.0, {yaw}]\n"
    "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
)


def write_map(folder, grey, *, yaml="", image="map.pgm", yaw=0.0, name="place.yaml"):
    Image.fromarray(np.asarray(grey, dtype=np.uint8)).save(folder / image)
    path = folder / name
    path.write_text(YAML.format(image=image, yaw=yaw) + yaml)
    return path


def read_pixels_as_cells(path, **options):
    """Return the barriers of squares that are as large as the pixels: each cell is its pixel, seen from its centre."""
    options = {"unknown": "free", "cell_size": 0.1, **options}
    wide = read_area(path, "square", **{**options, "cell_size": options["cell_size"] / 5})
    return wide.barriers[2::5, 2::5]  # the cell in the middle of the pixel touches no other


def state_by_hand(grey, mode="trinary", negate=False, over=0.65, under=0.196):
    """Return "occupied", "free" or "unknown" for one pixel, after the documentation of map_server."""
    if mode == "raw":
        if grey > 100:
            return "unknown"
        p = grey / 100
    else:
        p = grey / 255 if negate else (255 - grey) / 255
    return "occupied" if p > over else "free" if p < under else "unknown"


@settings(deadline=None, max_examples=40)
@given(
    grey=st.lists(st.integers(0, 255), min_size=6, max_size=6),
    mode=st.sampled_from(["trinary", "scale", "raw"]),
    negate=st.booleans(),
    thresholds=st.sampled_from([(0.65, 0.196), (0.65, 0.25), (0.5, 0.5), (1.0, 0.0)]),
    suffix=st.sampled_from([".pgm", ".png"]),
)
def test_each_pixel_has_the_state_that_map_server_gives_it(tmp_path_factory, grey, mode, negate, thresholds, suffix):
    folder = tmp_path_factory.mktemp("map")
    Image.fromarray(np.reshape(grey, (2, 3)).astype(np.uint8)).save(folder / f"m{suffix}")
    path = folder / "m.yaml"
    path.write_text(
        f"# made by hand\nimage: 'm{suffix}'  # beside\nresolution: 1e-1\norigin:\n - 0\n - 0\n - 0\n"
        f"mode: {mode}\nnegate: {int(negate)}\noccupied_thresh: {thresholds[0]}\nfree_thresh: {thresholds[1]}\n"
    )
    state = [state_by_hand(one, mode, negate, *thresholds) for one in grey]
    barriers = read_pixels_as_cells(path, unknown="free").reshape(-1)
    assert barriers.tolist() == [one == "occupied" for one in state]
    # What lies outside is unknown as well; a border of free pixels keeps it away.
    Image.fromarray(np.pad(np.reshape(grey, (2, 3)), 1, constant_values=0).astype(np.uint8)).save(folder / f"m{suffix}")
    inner = read_pixels_as_cells(path, unknown="barrier")[1:-1, 1:-1].reshape(-1)
    assert inner.tolist() == [one != "free" for one in state]


def test_the_origin_is_the_lower_left_corner_and_rows_run_to_the_south(tmp_path):
    grey = np.full((20, 30), 254)
    grey[18, 4] = 0  # 4.5 pixels to the east and 1.5 to the north of the lower left corner
    area = read_area(write_map(tmp_path, grey), "square", cell_size=0.1, unknown="free")
    blocked = np.flatnonzero(area.barriers)
    x, y = area.cell_to_metres(blocked)
    assert (x.mean(), y.mean()) == pytest.approx((-2 + 0.45, 3 + 0.15))
    assert area.frame.origin == pytest.approx((-2.0, 5.0))
    assert area.name == "place"


def test_yaw_turns_the_map_about_its_lower_left_corner(tmp_path):
    grey = np.full((20, 30), 254)
    grey[18, 4] = 0
    area = read_area(write_map(tmp_path, grey, yaw=pi / 2), "square", cell_size=0.1, unknown="free")
    x, y = area.cell_to_metres(np.flatnonzero(area.barriers))
    assert (x.mean(), y.mean()) == pytest.approx((-2 - 0.15, 3 + 0.45))  # east became north, north became west


@pytest.mark.parametrize(("unknown", "expected"), [("barrier", 0), ("free", 100)])
def test_unknown_ground_is_a_barrier_unless_it_is_to_be_free(tmp_path, unknown, expected):
    path = write_map(tmp_path, np.full((10, 10), 205))
    assert read_area(path, "square", cell_size=0.1, unknown=unknown).free_count == expected


def test_grey_205_is_unknown_or_free_as_the_threshold_says(tmp_path):
    path = write_map(tmp_path, np.full((10, 10), 205))
    path.write_text(path.read_text().replace("0.196", "0.25"))
    assert read_area(path, "square", cell_size=0.3).free_count == 4  # what lies outside is unknown


def test_transparent_pixels_are_unknown_in_mode_scale(tmp_path):
    colours = np.full((10, 10, 4), 255, dtype=np.uint8)
    colours[:, 5:, 3] = 128
    path = write_map(tmp_path, [[0]], yaml="mode: scale\n", image="m.png")
    Image.fromarray(colours).save(tmp_path / "m.png")
    barriers = read_area(path, "square", cell_size=0.1).barriers
    assert not barriers[2:-2, 2:3].any() and barriers[:, 5:].all()
    path.write_text(path.read_text().replace("scale", "trinary"))
    assert not read_area(path, "square", cell_size=0.1).barriers[2:-2, 6:8].any()


def test_sixteen_bit_images_and_pgm_with_comments_are_read(tmp_path):
    path = write_map(tmp_path, [[0]])
    pixels = " ".join(["65535"] * 90 + ["0"] * 10)
    (tmp_path / "map.pgm").write_text(f"P2\n# CREATOR: someone\n10 10\n65535\n{pixels}\n")
    assert (
        read_area(path, "square", cell_size=0.1, unknown="free").barriers.sum() == 20
    )  # the row and the one beside it
    (tmp_path / "map.pgm").write_bytes(b"P5\n# CREATOR: someone\n10 10\n# more\n255\n" + b"\xfe" * 100)
    assert read_area(path, "square", cell_size=0.1, unknown="free").free_count == 100


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("resolution: 0.1\n", "", "a ROS map must have the key 'resolution'"),
        ("resolution", "resolutoin", "must have the key 'resolution'; is it 'resolutoin'"),
        ("resolution: 0.1", "resolution: fine", "resolution must be a number, not 'fine'"),
        ("resolution: 0.1", "resolution: [0.1]", r"resolution must be one value, not \['0.1'\]"),
        ("resolution: 0.1", "resolution: -1", "resolution must be between 1e-9 and 1e9 metres, not -1"),
        ("resolution: 0.1", "resolution: nan", "resolution must be a number, not 'nan'"),
        ("resolution: 0.1", "resolution: 1e300", "resolution must be between 1e-9 and 1e9 metres, not 1e\\+300"),
        ("resolution: 0.1", "resolution: 1e-320", "resolution must be between 1e-9 and 1e9 metres"),
        ("resolution: 0.1", "resolution: 1e8", "cell_size must be at least .* metres for a world of"),
        ("origin: [-2.0, 3.0, 0.0]", "origin: 3", r"origin must be a list \[x, y, yaw\], not '3'"),
        ("origin: [-2.0, 3.0, 0.0]", "origin: [1, 2, 3, 4]", "origin must be a list"),
        ("origin: [-2.0, 3.0, 0.0]", "origin: [1, 2", "the list of origin must end with ] on the same line"),
        ("origin: [-2.0, 3.0, 0.0]", "origin: [1, east]", "origin must be a number, not 'east'"),
        ("negate: 0", "negate: 2", "negate must be 0 or 1, not '2'"),
        ("negate: 0", "mode: ternary", "mode must be one of trinary, scale, raw, .*; did you mean 'trinary'"),
        ("free_thresh: 0.196", "free_thresh: 0.9", "0 <= free_thresh <= occupied_thresh <= 1, not 0.9"),
        ("negate: 0", "negate", "line 4: must be 'key: value', not 'negate'"),
        ("negate: 0", "image: twice", "line 4: image is there twice"),
        ("image: map.pgm", "image:", "image must be one value"),
        ("image: map.pgm", "image: place.yaml", "place.yaml: is no image that trihex reads"),
    ],
)  # fmt: skip
def test_mistakes_are_told_with_their_key(tmp_path, old, new, message):
    path = write_map(tmp_path, np.full((4, 4), 254))
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises((FormatError, TooLargeError), match=message):
        read_area(path, "square", cell_size=0.1)


def test_a_map_needs_a_cell_size_and_its_image(tmp_path):
    path = write_map(tmp_path, np.full((4, 4), 254))
    with pytest.raises(FormatError, match=r"metres\) is measured in metres: say how far apart"):
        read_area(path)
    with pytest.raises(AreaError, match=r"cell_size must be at least 0\.6 metres \(0\.3465 where following"):
        read_area(path, "hexagonal", cell_size=0.3, robot_radius=0.15)
    (tmp_path / "map.pgm").unlink()
    with pytest.raises(FileNotFoundError, match=r"map\.pgm"):
        read_area(path, cell_size=1.0)


@settings(deadline=None, max_examples=30)
@given(
    colours=st.lists(st.tuples(*[st.integers(0, 255) | st.sampled_from([0, 255])] * 4), min_size=6, max_size=6),
    negate=st.booleans(),
    unknown=st.sampled_from(["barrier", "free"]),
)
def test_in_mode_trinary_opacity_counts_as_a_fourth_colour_as_in_map_server(tmp_path_factory, colours, negate, unknown):
    folder = tmp_path_factory.mktemp("alpha")
    image = np.array(colours, dtype=np.uint8).reshape(2, 3, 4)
    path = write_map(folder, image, image="map.png")
    path.write_text(path.read_text().replace("negate: 0", f"negate: {int(negate)}"))
    barriers = read_pixels_as_cells(path, unknown=unknown)
    for y, x in np.ndindex(2, 3):
        shade = image[y, x].sum() / 4 / 255
        p = shade if negate else 1 - shade
        if min(abs(p - 0.65), abs(p - 0.196)) < 1 / 255:
            continue  # grey is kept in whole steps
        state = "occupied" if p > 0.65 else "free" if p < 0.196 else "unknown"
        assert barriers[y, x] == (state == "occupied" or (state == "unknown" and unknown == "barrier"))


def test_transparent_white_is_unknown_in_mode_trinary(tmp_path):
    image = np.full((1, 3, 4), 255, dtype=np.uint8)
    image[0, 1, 3] = 0
    path = write_map(tmp_path, image, image="map.png")
    assert read_area(path, "square", cell_size=0.02).barriers[2, 2::5].tolist() == [False, True, False]
    assert read_area(path, "square", cell_size=0.02, unknown="free").free_count == 5 * 15
    (tmp_path / "map.png").unlink()
    Image.fromarray(image[..., :3]).save(tmp_path / "map.png")  # no such channel: white is free
    assert read_area(path, "square", cell_size=0.02).barriers[2, 2::5].tolist() == [False, False, False]


@pytest.mark.parametrize(
    "text",
    [
        "{image: map.pgm, resolution: 0.1, origin: [-2.0, 3.0, 0.0], negate: 0}",
        '{"image":"map.pgm","resolution":0.1,"origin":[-2.0,3.0,0.0],"negate":0,"mode":"trinary"}',
        '\n{\n  "image": "map.pgm",\n  "resolution": 0.1,  # metres\n  "origin": [-2.0,\n 3.0, 0.0]\n}\n',
        "# {made by hand}\n---\n{mode: 'trinary', image: \"map.pgm\", resolution: 0.1, origin: [-2, 3, 0]}",
        '"image": map.pgm\n\'resolution\': 0.1\n"origin": [-2, 3, 0]\n',
    ],
)
def test_a_map_file_may_be_written_in_the_style_of_json(tmp_path, text):
    grey = np.full((4, 4), 254)
    grey[1, 2] = 0
    path = write_map(tmp_path, grey)
    plain = read_area(path, "square", cell_size=0.05)
    path.write_text(text)
    assert read_area(path, "square", cell_size=0.05) == plain
    if not text.startswith("#"):  # known by its content
        assert path.rename(tmp_path / "place") and read_area(tmp_path / "place", "square", cell_size=0.05) == plain


def test_a_mistake_in_the_style_of_json_is_told(tmp_path):
    path = write_map(tmp_path, np.full((4, 4), 254))
    path.write_text('{"image": "map.pgm", "resolutoin": 0.1, "origin": [0, 0, 0]}')
    with pytest.raises(FormatError, match="must have the key 'resolution'; is it 'resolutoin'"):
        read_area(path, cell_size=0.5)


def test_a_map_smaller_than_a_cell_is_told(tmp_path):
    with pytest.raises(FormatError, match=r"must be larger than a cell of 5 metres, not 0\.4 by 0\.4 metres"):
        read_area(write_map(tmp_path, np.full((4, 4), 254)), cell_size=5)
