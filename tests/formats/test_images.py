"""Images: pixels as cells and as squares in metres, there and back, and files that are none."""

import struct
import zlib

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from PIL import Image

from tests.formats.strategies import areas
from trihex import Area, FormatError, read_area, write_area
from trihex.areas import Frame


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("images")


@settings(deadline=None, max_examples=40)
@given(area=areas(), suffix=st.sampled_from([".png", ".pgm", ".bmp"]))
def test_what_is_written_is_read_again(folder, area, suffix):
    path = folder / f"area{suffix}"
    write_area(area, path)
    assert np.array_equal(read_area(path, area.tessellation).barriers, area.barriers)


def test_dark_pixels_are_barriers_by_a_threshold_and_the_other_way_round(tmp_path):
    Image.fromarray(np.array([[0, 100, 127, 128, 255]], dtype=np.uint8)).save(tmp_path / "a.png")
    read = lambda **options: read_area(tmp_path / "a.png", "square", **options).barriers[0].tolist()  # noqa: E731
    assert read() == [True, True, True, False, False]
    assert read(threshold=0.2) == [True, False, False, False, False]
    assert read(invert=True) == [False, False, False, True, True]


def test_colours_count_as_their_mean_and_transparent_ones_as_bright(tmp_path):
    colours = [[[255, 0, 0, 255], [255, 255, 0, 255], [0, 0, 0, 0], [0, 0, 0, 255]]]
    Image.fromarray(np.array(colours, dtype=np.uint8)).save(tmp_path / "a.png")
    assert read_area(tmp_path / "a.png").barriers.tolist() == [[True, False, False, True]]


def test_in_metres_the_lower_left_corner_is_the_origin(tmp_path):
    pixels = np.full((20, 30), 255, dtype=np.uint8)
    pixels[19, 0] = 0
    Image.fromarray(pixels).save(tmp_path / "a.png")
    area = read_area(tmp_path / "a.png", "square", cell_size=0.2, resolution=0.1, unknown="free")
    x, y = area.cell_to_metres(np.flatnonzero(area.barriers))
    assert area.barriers.shape == (10, 15)
    assert list(zip(x.round(9).tolist(), y.round(9).tolist(), strict=True)) == [(0.1, 0.1)]


def test_recognised_by_content_not_by_name(tmp_path):
    Image.fromarray(np.array([[0, 255]], dtype=np.uint8)).save(tmp_path / "a.png")
    (tmp_path / "a.map").write_bytes((tmp_path / "a.png").read_bytes())
    assert read_area(tmp_path / "a.map").barriers.tolist() == [[True, False]]


def png(width, height, rows):
    """Return a PNG that claims a size, whatever its rows are."""

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (png(50_000, 50_000, b"\0" * 10_000_000), "an image may have at most 100000000 pixels"),
        (png(12_000, 12_000, b"\0" * 100), "an image may have at most 100000000 pixels, not 12000 x 12000"),
        (png(100, 100, b"\0" * 5), "the image is damaged"),
        (png(4, 4, b"\0" * 20)[:40], "is no image that trihex reads"),
        (b"P5\n4 4\n255\n..", "the image is damaged"),
        (b"P5\n-4 4\n255\n..", "image"),
        (b"BM" + bytes(60), "the image is damaged: Unsupported BMP header"),
        (b"GIF87a" + bytes(3), "image"),
    ],
)  # fmt: skip
def test_bombs_and_torn_files_are_refused(tmp_path, content, message):
    (tmp_path / "a.png").write_bytes(content)
    with pytest.raises(FormatError, match=message):
        read_area(tmp_path / "a.png")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"threshold": 1.5}, r"threshold must be between 0 and 1, not 1\.5"),
        ({"resolution": 0.0}, r"resolution must be between 1e-9 and 1e9 metres, not 0"),
        ({"resolution": 0.1}, "resolution needs cell_size, the edge step of a cell in metres, or robot_radius"),
        ({"robot_radius": 0.1}, "an image has no measure"),
        ({"cell_size": 1.0}, "say how many metres a pixel is wide"),
        ({"unknown": "fre"}, "unknown must be one of barrier, free, not 'fre'; did you mean 'free'"),
    ],
)
def test_options_that_do_not_fit_are_refused(tmp_path, options, message):
    Image.fromarray(np.array([[0, 255]], dtype=np.uint8)).save(tmp_path / "a.png")
    with pytest.raises(FormatError, match=message):
        read_area(tmp_path / "a.png", **options)


@pytest.mark.parametrize("name", ["a.png", "a.map", "a.txt"])
def test_a_frame_is_refused_not_dropped(tmp_path, name):
    with pytest.raises(FormatError, match="which this format cannot carry"):
        write_area(Area("square", [[0]], frame=Frame(1.0)), tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_letters_may_have_a_size_but_no_radius(tmp_path):
    (tmp_path / "a.txt").write_text("..D\n")
    assert read_area(tmp_path / "a.txt", cell_size=0.5).frame == Frame(0.5)
    with pytest.raises(FormatError, match="has one cell for each letter; robot_radius needs a place with walls"):
        read_area(tmp_path / "a.txt", cell_size=0.5, robot_radius=0.1)


def pfm(values):
    rows, columns = np.shape(values)
    return f"Pf\n{columns} {rows}\n-1.0\n".encode() + np.asarray(values, dtype="<f4")[::-1].tobytes()


def test_a_pfm_is_as_bright_as_its_numbers_say(tmp_path):
    (tmp_path / "a.pfm").write_bytes(pfm([[0.0, 0.49], [0.51, 1.0]]))
    assert read_area(tmp_path / "a.pfm").barriers.tolist() == [[True, True], [False, False]]


@pytest.mark.parametrize("wrong", [255.0, -0.1, float("nan"), float("inf")])
def test_a_pfm_of_other_numbers_is_refused(tmp_path, wrong):
    (tmp_path / "a.pfm").write_bytes(pfm([[0.0, wrong]]))
    with pytest.raises(FormatError, match=f"brightness in a PFM must be a number from 0 to 1, not {wrong:g}"):
        read_area(tmp_path / "a.pfm")


@pytest.mark.parametrize(("size", "told"), [("12000 9000", "12000 x 9000"), ("20000 20000", "400000000")])
def test_an_image_too_large_is_told_both_sizes_and_the_way_out(tmp_path, size, told):
    (tmp_path / "a.pgm").write_bytes(f"P5\n{size}\n255\n".encode() + bytes(70))
    with pytest.raises(FormatError, match=rf"at most 100000000 pixels, not {told}: cut off .*, or shrink it"):
        read_area(tmp_path / "a.pgm")
