"""Files through the desk: every format that trihex reads is opened, every one that it writes is saved."""

import numpy as np
import pytest
from fuzz.seeds import make_seeds

import trihex as th
from trihex.viewer.bundle import decode, encode
from trihex.viewer.desk import Desk
from trihex.viewer.document import document_of
from trihex.viewer.exports import EXPORTS
from trihex.viewer.folder import SUFFIXES, Folder

# What a page asks for beside the name, where a file leaves something open.
METRES = {"cell_size": 0.5, "robot_radius": 0.05, "unknown": "free"}
WISHES = {
    "house.geojson": METRES,
    "house.wkt": METRES,
    "house.yaml": METRES,
    "plan.dxf": METRES,
    "binary.dxf": METRES,
    "style.yaml": METRES,
    "parts.geojson": METRES,
    "srid.wkt": METRES,
    "house.png": {"cell_size": 0.5, "resolution": 0.1, "invert": True, "threshold": 0.3},
}
OTHERS = {
    "request.bundle",
    "events.csv",
    "seconds.csv",
    "events.toml",
    "study.toml",
    "crowd.sqlite",
    "crowd.txt",
}  # not for the viewer
NAMES = [name for name in make_seeds() if name not in OTHERS]


def yard():
    return th.Area(
        "square",
        np.array([[letter == "B" for letter in row] for row in ["...B....", ".B....B.", "........", "..BB...."]]),
        frame=th.Frame(0.5),
    )


def ask(desk, header, arrays=None):
    frames = []
    desk.answer(encode(header, arrays or {}), frames.append)
    answer = decode(frames[-1])
    assert answer.header["kind"] == "result", answer.header
    return answer


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("files")
    for name, content in make_seeds().items():
        (folder / name).write_bytes(content)
    return folder


def test_there_is_a_file_of_every_format_that_may_be_opened():
    same = {".yml": ".yaml", ".json": ".geojson", ".jpg": ".jpeg"}
    assert {same.get(suffix, suffix) for suffix in SUFFIXES} == {"." + name.rpartition(".")[2] for name in NAMES}


@pytest.mark.parametrize("in_folder", [True, False])
@pytest.mark.parametrize("name", NAMES)
def test_every_format_is_opened(folder, name, in_folder):
    if not in_folder and name in ("house.yaml", "style.yaml", "place.toml"):
        return  # they name other files, which a page cannot send; see test_server
    desk = Desk(Folder(folder))
    document = document_of(th.formats.draft.Draft(yard(), np.array([7, 24])))
    wish = {"op": "open", "name": name, "in_folder": in_folder, "document": document.header, **WISHES.get(name, {})}
    content = {} if in_folder else {"content": np.frombuffer((folder / name).read_bytes(), dtype=np.uint8)}
    answer = ask(desk, wish, {**document.arrays, **content})
    if name == "run.npz":
        assert answer.header["watched"]["steps"] > 0 and answer.header["live"]  # it does again what it did
    elif name.startswith("plan.") and not name.endswith(".dxf"):
        assert answer.header["summary"]["robots"] == 2 and answer.arrays["actions"].tolist() == [2, 2, 2, 1, 1, 1, 0]
    elif name.endswith((".csv", ".scen")):
        assert answer.arrays["robots"].size in (2, 3) and answer.header["document"]["frame"]["cell_size"] == 0.5
    elif name == "house.png":  # dark is free: the walls, too thin for a cell but at the corners
        assert answer.header["document"]["frame"]["cell_size"] == 0.5
        assert (answer.header["document"]["width"], answer.header["document"]["height"]) == (18, 12)
    else:
        direct = th.formats.read_draft(folder / name, **WISHES.get(name, {})).area
        assert np.array_equal(answer.arrays["barriers"], np.packbits(direct.barriers))


@pytest.mark.parametrize("what", EXPORTS)
def test_every_format_is_saved(tmp_path, what):
    place = th.Scenario(yard(), [(7, 0), (0, 3)], [(0, 0), (4, 1)])
    cells = th.Scenario(th.Area("square", place.area.barriers), [(7, 0), (0, 3)], [(0, 0), (4, 1)])
    desk = Desk(Folder(tmp_path))
    for suffix in EXPORTS[what][0]:
        # Metres go into what can carry them, and are demanded by waypoints.
        needs_metres = what.endswith("waypoints") or suffix == ".toml"
        shown = desk.show(th.make_plan(place if needs_metres else cells, "greedy"))
        plan = shown.header["plan"] if EXPORTS[what][1] == "plan" else None
        document = {"document": shown.header["document"], "plan": plan}
        arrays = {name: shown.arrays[name] for name in ("barriers", "destinations", "robots")}
        if EXPORTS[what][1] == "run":
            live = {"op": "live", "planner": "greedy", "document": shown.header["document"]}
            document["live"] = ask(desk, live, arrays).header["live"]
            ask(desk, {"op": "advance", "live": document["live"], "steps": 3})
        name = f"saved{suffix}"
        answer = ask(desk, {"op": "save", "what": what, "name": name, "in_folder": True, **document}, arrays)
        assert answer.header["saved"] == name and (tmp_path / name).stat().st_size > 0
        loaded = ask(desk, {"op": "save", "what": what, "name": name, "in_folder": False, **document}, arrays)
        assert loaded.arrays["content"].size > 0
        if what in ("area", "scenario"):
            assert np.array_equal(th.read_area(tmp_path / name).barriers, place.area.barriers)
        (tmp_path / name).unlink()
