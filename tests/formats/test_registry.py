"""The registry of formats: each line of it leads somewhere, and what is written is recognised."""

import pytest

import trihex as th
from trihex.errors import FormatError
from trihex.formats import FORMATS, format_of
from trihex.formats.registry import WRITERS, function_at, writer_of

PLACES = [form.parser for form in FORMATS.values()] + [place for own in WRITERS.values() for place in own.values()]


@pytest.mark.parametrize("place", sorted(set(PLACES)))
def test_each_function_is_there(place):
    assert callable(function_at(place))


@pytest.mark.parametrize(
    ("what", "suffix", "name"),
    [
        ("an area", ".map", "movingai"),
        ("an area", ".txt", "letters"),
        ("an area", ".toml", "scenario"),
        ("an area", ".png", "image"),
        ("an area", ".pgm", "image"),
        ("an area", ".bmp", "image"),
        ("a scenario", ".toml", "scenario"),
        ("a scenario", ".txt", "letters"),
        ("a plan", ".csv", "plan"),
        ("a plan", ".npz", "npz"),
        ("a plan", ".parquet", "parquet"),
    ],
)
def test_what_is_written_is_recognised_by_its_content(tmp_path, what, suffix, name):
    scenario = th.Scenario(th.Area("square", [[0, 1, 0], [0, 0, 0]]), [(2, 0)], [(0, 0)])
    record = {"an area": scenario.area, "a scenario": scenario, "a plan": th.make_plan(scenario, "greedy")}[what]
    path = tmp_path / f"it{suffix}"
    writer_of(what, path)(record, path)
    assert format_of(path.read_bytes(), "nameless") == name


@pytest.mark.parametrize(
    ("content", "name"),
    [
        (b"x,y\n", "starts"),
        (b"\xef\xbb\xbfx,y\r\n1,2\r\n", "starts"),
        (b"x_metres,y_metres\n", "starts"),
        (b" robot,step,x,y,action,time \n", "plan"),
        (b"x,y,z\n", "letters"),
        (b"version 1\n", "scen"),
        (b"versions\n", "letters"),
        (b"\n\ntype octile\n", "movingai"),
        (b"....\n....\n....\n....\nmap\n", "letters"),
        (b" \n {}", "geojson"),
        (b'{ "height":5,', "tiled"),
        (b'{"infinite":false,', "tiled"),
        (b'{"type":"Feature","height":5,', "geojson"),
        (b'<?xml version="1.0"?>\n<!-- a level -->\n<map version="1.10"', "tiled"),
        (b"<mapping>", "letters"),
        (b"polygon((0 0))", "wkt"),
        (b"# a map\nimage: a.pgm\n", "ros"),
        (b"[area]\n", "scenario"),
        (b"..B\n", "letters"),
    ],
)
def test_content_tells_the_format(content, name):
    assert format_of(content, "nameless") == name


@pytest.mark.parametrize(
    ("path", "name"),
    [("a.map", "movingai"), ("a.SCEN", "scen"), ("a.json", "geojson"), ("a.yml", "ros"), ("a.toml", "scenario")],
)
def test_the_name_tells_where_the_content_does_not(path, name):
    assert format_of(b"@@\n", path) == name


@pytest.mark.parametrize(("line", "name"), [(b"a,b", "starts"), (b"a,b,c", "plan"), (b"ab", "letters")])
def test_a_table_with_a_wrong_header(line, name):
    assert format_of(line + b"\n1,2\n", "a.csv") == name


def test_what_is_not_read(tmp_path):
    with pytest.raises(FormatError, match=r"is a PDF"):
        format_of(b"%PDF-1.4", "a.map")
    with pytest.raises(FormatError, match=r"the suffix of an area must be one of \.map, \.txt, \.toml, \.png"):
        writer_of("an area", tmp_path / "a.doc")
