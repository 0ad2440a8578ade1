import sys

import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")
from matplotlib import pyplot
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection

from trihex.areas import TESSELLATIONS, Area, Frame, Scenario
from trihex.errors import MissingExtraError
from trihex.fields import make_d_scheme, make_n_scheme
from trihex.kernels.codes import WAIT
from trihex.pictures import draw_area, draw_arrivals, draw_comparison, draw_d_scheme, draw_n_scheme, draw_plan, palette
from trihex.plans import plan_from_lists


@pytest.fixture(autouse=True)
def _close_figures():
    yield
    pyplot.close("all")


def scenario_of(name: str) -> Scenario:
    barriers = np.zeros((5, 6), dtype=bool)
    barriers[1, 2] = barriers[2, 2] = barriers[3, 4] = True
    return Scenario(Area(name, barriers, "small"), [(5, 4)], [(0, 0), (3, 1)])


def texts_of(ax) -> list[str]:
    return [text.get_text() for text in ax.texts]


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_cells_are_the_polygons_of_the_tessellation(name):
    scenario = scenario_of(name)
    ax = draw_area(scenario)
    (cells,) = [one for one in ax.collections if isinstance(one, PolyCollection)]
    for cell, path in enumerate(cells.get_paths()):
        corners = scenario.area.tessellation.polygon_of_cell(cell % 6, cell // 6)
        assert np.allclose(path.vertices[: len(corners)], corners)
    barrier = np.append(np.array(palette.BARRIER) / 255, 1)
    is_barrier = (np.abs(cells.get_facecolors() - barrier) < 1e-9).all(axis=1)
    assert np.array_equal(is_barrier.reshape(5, 6), scenario.area.barriers)
    (robots,) = [one for one in ax.collections if isinstance(one, EllipseCollection)]
    assert np.allclose(robots.get_offsets(), np.stack(scenario.area.tessellation.centre_of_cell([0, 3], [0, 1]), -1))
    assert ax.yaxis_inverted()
    assert ax.get_title() == "small"
    assert texts_of(ax) == ["D", "a", "b"]
    ax.figure.canvas.draw()


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_schemes_and_plans_on_given_axes(name):
    scenario = scenario_of(name)
    n_scheme = make_n_scheme(scenario)
    d_scheme = make_d_scheme(n_scheme)
    figure, axes = pyplot.subplots(1, 3, figsize=(20, 8))
    assert draw_n_scheme(n_scheme, axes[0]) is axes[0]
    assert sorted(texts_of(axes[0])) == sorted(str(d) for d in n_scheme.distance[~scenario.area.barriers])
    draw_d_scheme(d_scheme, axes[1])
    (arrows,) = [one for one in axes[1].collections if isinstance(one, LineCollection)]
    assert len(arrows.get_paths()) == sum(bin(bits).count("1") for bits in d_scheme.directions.reshape(-1).tolist())
    draw_plan(plan_from_lists(scenario, [[WAIT], []], planner="hand"), axes[2])
    assert axes[2].get_title() == "Plan (hand) of small"
    assert [text.get_text() for text in axes[2].get_legend().get_texts()] == ["barrier", "destination", "never arrives"]
    figure.canvas.draw()


def test_places_in_the_world_have_a_scale_and_discs_lie_above_lines():
    scenario = scenario_of("square")
    area = Area("square", scenario.area.barriers, "hall", Frame(0.5))
    ax = draw_plan(plan_from_lists(Scenario(area, scenario.destinations, scenario.robots), [[WAIT], []]))
    line, words = (text for text in ax.texts if text.get_text() not in ("D", "a", "b"))
    assert words.get_text() == "0.5 m"
    assert (line.xy[0], line.get_position()[0]) == (1.0, 0.0)
    assert line.xy[1] == line.get_position()[1] < 0
    ax.figure.canvas.draw()
    below = line.get_window_extent()
    assert ax.get_legend().get_window_extent().y1 <= below.y0 + 2
    orders = {type(one): one.get_zorder() for one in ax.collections}
    assert orders[LineCollection] < orders[EllipseCollection] < min(text.get_zorder() for text in ax.texts)


def test_large_areas_are_drawn_as_an_image():
    scenario = Scenario(Area("hexagonal", np.zeros((200, 200))), [(3, 3)])
    ax = draw_n_scheme(make_n_scheme(scenario))
    assert not ax.collections
    (image,) = ax.images
    across, down = scenario.area.tessellation.extent(200, 200)
    assert image.get_extent() == [0, across, down, 0]
    x, y = scenario.area.tessellation.centre_of_cell(3, 3)
    pixels = np.asarray(image.get_array())
    pixel = pixels[int(y / down * pixels.shape[0]), int(x / across * pixels.shape[1])]
    assert tuple(pixel) == palette.DESTINATION


def test_arrivals_are_a_staircase():
    scenario = Scenario(Area("square", np.zeros((1, 5))), [(0, 0)], [(1, 0), (3, 0)])
    west = scenario.area.tessellation.direction_names[0].index("W")
    one = plan_from_lists(scenario, [[west], [west] * 3], planner="one")
    other = plan_from_lists(scenario, [[west], [WAIT, west, west, west]], planner="other")
    ax = draw_arrivals([one, other])
    assert [line.get_xydata().tolist() for line in ax.lines] == [
        [[0, 0], [1, 1], [3, 2], [3, 2]],
        [[0, 0], [1, 1], [4, 2], [4, 2]],
    ]
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["one, square", "other, square"]
    assert len(draw_arrivals(one).lines) == 1


def test_comparison_has_a_bar_for_each_planner_and_tessellation():
    rows = [
        {"tessellation": "square", "planner": "greedy", "gap": 0.2, "optimal": False},
        {"tessellation": "square", "planner": "greedy", "gap": 0.4, "optimal": False},
        {"tessellation": "square", "planner": "optimal", "gap": 0.0, "optimal": True},
        {"tessellation": "hexagonal", "planner": "optimal", "gap": 0.01, "optimal": True},
    ]
    ax = draw_comparison(rows)
    bars = [(round(bar.get_x() + bar.get_width() / 2, 6), round(bar.get_height(), 6)) for bar in ax.patches]
    assert bars == [(-0.2, 30.0), (0.2, 0.0), (1.2, 1.0)]
    assert texts_of(ax) == ["30.0", "0.0*", "1.0*"]
    assert [label.get_text() for label in ax.get_xticklabels()] == ["square", "hexagonal"]
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["greedy", "optimal"]
    assert not draw_comparison([]).patches


def test_without_matplotlib_the_error_says_what_to_install(monkeypatch):
    for module in [name for name in sys.modules if name.split(".")[0] == "matplotlib"]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(MissingExtraError, match=r"trihex\[plot\]"):
        draw_area(Area("square", [[0]]))
