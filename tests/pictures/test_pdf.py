"""Pictures in PDF: the page of the other formats, as vectors, with fonts."""

import re
import sys
import zlib
from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner

import trihex as th
from trihex.cli import main
from trihex.pictures.sheet import arrange

AREA = th.Area("triangular", [[0, 0, 1, 0], [0, 1, 0, 0], [0, 0, 0, 0]], "yard → 庭")
SCENARIO = th.Scenario(AREA, [(3, 2)], [(0, 0), (1, 0)])


def saved(picture, folder, name="p.pdf"):
    picture.save(folder / name)
    return (folder / name).read_bytes()


def streams_of(content):
    """Return what the page draws, and the fonts, decompressed."""
    parts = re.findall(rb"stream\r?\n(.*?)\r?\nendstream", content, re.DOTALL)
    return [zlib.decompress(part) for part in parts if part[:1] == b"x"]


def pictures():
    n_scheme = th.make_n_scheme(SCENARIO)
    yield th.picture_of_area(SCENARIO)
    yield th.picture_of_n_scheme(n_scheme)
    yield th.picture_of_d_scheme(th.make_d_scheme(n_scheme))
    yield th.picture_of_plan(th.make_plan(SCENARIO))
    yield th.picture_of_run(th.Trial(SCENARIO, sensor=th.Sensor(AREA.tessellation, 1)).run())


def test_the_page_is_as_large_as_that_of_svg_and_its_fonts_are_embedded(tmp_path):
    for picture in pictures():
        content = saved(picture, tmp_path)
        sheet = arrange(picture.scene)
        (box,) = re.findall(rb"/MediaBox \[ 0 0 ([0-9.]+) ([0-9.]+) \]", content)
        assert [float(side) for side in box] == pytest.approx([0.75 * sheet.width, 0.75 * sheet.height])
        assert content.startswith(b"%PDF") and b"/FontFile2" in content and b"/FontName" in content


def test_cells_are_vectors_where_they_are(tmp_path):
    picture = th.picture_of_area(AREA, width=400, title="", legend=False)
    page = max(streams_of(saved(picture, tmp_path)), key=len)
    x, y = AREA.cell_to_xy(np.arange(AREA.cell_count))
    corners = AREA.tessellation.polygon_of_cell(x, y) * picture.scene.scale * 0.75
    height = arrange(picture.scene).height * 0.75
    drawn = np.array([[float(n) for n in pair] for pair in re.findall(rb"([0-9.-]+) ([0-9.-]+) [ml]\n", page)])
    for cx, cy in corners.reshape(-1, 2):
        assert np.abs(drawn - (cx, height - cy)).max(axis=1).min() < 0.6


def test_the_same_picture_is_the_same_file(tmp_path):
    picture = th.picture_of_n_scheme(th.make_n_scheme(SCENARIO))
    assert saved(picture, tmp_path, "a.pdf") == saved(picture, tmp_path, "b.pdf")


def test_large_areas_and_what_stands_in_the_world_are_images(tmp_path):
    small = saved(th.picture_of_area(AREA, title="", legend=False), tmp_path)
    large = saved(th.picture_of_area(th.Area("square", np.zeros((200, 200))), width=300, title=""), tmp_path)
    ground = th.areas.RasterGround(np.array([[False, True]]), 0.5)
    framed = replace(AREA, frame=th.Frame(1.0))
    world = saved(th.picture_of_area(framed, title="", legend=False, ground=ground), tmp_path)
    assert [b"/Subtype /Image" in content for content in (small, large, world)] == [False, True, True]


def test_every_command_that_draws_takes_pdf(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "w.txt").write_text("D..B\n....\nb.aB\n")
    commands = [
        ["plan", "w.txt", "--picture"],
        ["field", "w.txt", "--picture"],
        ["field", "w.txt", "--directions-picture"],
        ["run", "w.txt", "--picture"],
        ["generate", "random", "--size", "8,6", "--out", "g.map", "--picture"],
        ["compare", "w.txt", "--planners", "greedy", "--picture"],
    ]
    for number, command in enumerate(commands):
        result = CliRunner().invoke(main, [*command, f"{number}.pdf"])
        assert result.exit_code == 0, result.output
        assert (tmp_path / f"{number}.pdf").read_bytes().startswith(b"%PDF")


def test_without_matplotlib_nothing_is_begun(tmp_path, monkeypatch):
    for module in [name for name in sys.modules if name.split(".")[0] == "matplotlib"]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(th.MissingExtraError, match=r"^a picture in PDF needs matplotlib: pip install"):
        th.picture_of_area(AREA).save(tmp_path / "p.pdf")
    assert not list(tmp_path.iterdir())
    (tmp_path / "w.txt").write_text("D.a\n")
    for command, picture in (("plan", "p.pdf"), ("compare", "p.png")):
        words = [command, str(tmp_path / "w.txt"), "--picture", str(tmp_path / picture)]
        result = CliRunner().invoke(main, words)
        assert (result.exit_code, result.stdout) == (2, "")
        kind = {"plan": "a picture in PDF", "compare": "a chart"}[command]
        assert result.stderr == f"trihex: error: {kind} needs matplotlib: pip install 'trihex[plot]'\n"
