"""Bundles and documents: what goes in comes out, and nothing else gets in."""

import json
import struct

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

import trihex as th
from tests.strategies import scenarios, with_start_times
from trihex.formats import Draft, draft_of
from trihex.viewer.bundle import MAGIC, decode, encode
from trihex.viewer.document import document_of, draft_of_document

ARRAYS = st.dictionaries(
    st.text(max_size=4),
    st.tuples(st.sampled_from(["u1", "u2", "i4", "f8"]), st.lists(st.integers(0, 255), max_size=9)).map(
        lambda pair: np.array(pair[1], dtype=pair[0])
    ),
    max_size=4,
)


@settings(max_examples=60)
@given(ARRAYS)
def test_a_bundle_comes_back(arrays):
    header, again = decode(encode({"a": [1, None, "ü"]}, arrays))
    assert header == {"a": [1, None, "ü"]} and again.keys() == arrays.keys()
    for name, array in arrays.items():
        assert again[name].dtype == array.dtype and again[name].tolist() == array.tolist()


@settings(max_examples=200)
@given(st.binary(max_size=60), st.integers(0, 80))
def test_damaged_bundles_are_refused_or_read_but_never_crash(noise, at):
    whole = encode({"op": "x"}, {"a": np.arange(3, dtype=np.int32)})
    for content in (noise, whole[:at], whole[:at] + noise + whole[at + len(noise) :]):
        try:
            bundle = decode(content)
        except th.FormatError:
            continue
        assert isinstance(bundle.header, dict)


@pytest.mark.parametrize(
    "arrays",
    [{"a": ["i4", -1]}, {"a": ["i4", 10**18]}, {"a": ["i4", True]}, {"a": ["O", 1]}, {"a": ["i4"]}, {"a": 3}, [], None],
)
def test_arrays_that_are_none_are_refused(arrays):
    text = json.dumps({"header": {}, "arrays": arrays}).encode()
    with pytest.raises(th.FormatError, match="bundle"):
        decode(MAGIC + struct.pack("<II", len(text), 0) + text + bytes(64))


@settings(max_examples=60, deadline=None)
@given(scenarios())
def test_a_document_is_the_scenario_that_it_was_made_from(scenario):
    if scenario.seed % 2:
        scenario = with_start_times(scenario, scenario.seed)
    document = document_of(draft_of(scenario))
    header, arrays = decode(encode(*document))
    assert draft_of_document(header, arrays).complete() == scenario


def test_a_document_keeps_the_frame():
    area = th.Area("hexagonal", np.zeros((3, 4)), "yard", th.Frame(0.5, (1.0, 2.0), 0.1, 0.05))
    assert draft_of_document(*document_of(draft_of(th.Scenario(area, [(0, 0)])))).area == area


GOOD = document_of(draft_of(th.Scenario(th.Area("square", np.zeros((3, 5))), [(0, 0)], [(1, 1)])))


@pytest.mark.parametrize(
    ("changes", "rule"),
    [
        ({"height": 0}, "height"),
        ({"height": 2**24}, "at most"),
        ({"width": 6}, "bits"),
        ({"width": "5"}, "width"),
        ({"tessellation": "round"}, "tessellation"),
        ({"crossing": "never"}, "crossing"),
        ({"waiting_cost": -1}, "waiting_cost"),
        ({"destination_capacity": 0}, "destination_capacity"),
        ({"frame": {"cell_size": 1.0}}, "frame"),
        ({"more": 1}, "more"),
    ],
)
def test_documents_that_break_a_rule_are_refused(changes, rule):
    with pytest.raises(th.TrihexError, match=rule):
        draft_of_document({**GOOD.header, **changes}, GOOD.arrays).complete()


@pytest.mark.parametrize("cells", [[15], [-1], [2**31 - 1]])
def test_cells_outside_of_the_area_are_refused(cells):
    for name in ("robots", "destinations"):
        with pytest.raises(th.ScenarioError, match=name):
            draft_of_document(GOOD.header, {**GOOD.arrays, name: np.array(cells, dtype=np.int32)}).complete()


def test_areas_too_large_for_a_page_are_refused():
    with pytest.raises(th.TooLargeError, match="viewer shows at most"):
        document_of(draft_of(th.Scenario(th.Area("square", np.zeros((4097, 4096), dtype=bool)), [(0, 0)])))


def test_start_times_stay_with_the_cells_of_robots():
    area = th.Area("hexagonal", np.zeros((3, 5)), frame=th.Frame(cell_size=0.5))
    draft = Draft(area, np.array([0]), np.array([4, 7, 9]), start_times=np.array([0.0, 1.0, 2.0]))  # seconds
    header, arrays = document_of(draft)
    assert header["start_times"] == [[7, 2], [9, 4]] and "start_times" not in GOOD.header
    moved = {**arrays, "robots": np.array([9, 5], dtype=np.int32)}
    assert draft_of_document(header, moved).complete().start_times.tolist() == [4, 0]
    drawn = Draft(area, np.array([0]), np.array([4, 7]), seed=1, start_times="constant:3")
    assert document_of(drawn).header["start_times"] == [[4, 6], [7, 6]]
