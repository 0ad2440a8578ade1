import sys

import matplotlib
import numpy as np
import pytest

import trihex as th

matplotlib.use("Agg")
from matplotlib import pyplot
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection

from trihex.areas import TESSELLATIONS, Area, Frame, Scenario
from trihex.errors import FormatError, MissingExtraError
from trihex.fields import distance_generations, make_d_scheme, make_n_scheme
from trihex.kernels.codes import WAIT
from trihex.pictures import (
    draw_area,
    draw_arrivals,
    draw_comparison,
    draw_d_scheme,
    draw_generation,
    draw_generations,
    draw_n_scheme,
    draw_plan,
    palette,
)
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
    assert [text.get_text() for text in ax.get_legend().get_texts()] == [
        "greedy", "optimal", "95 % over 2 rows", "proven optimal",
    ]  # fmt: skip
    assert not draw_comparison([]).patches


def words_of_legend(ax) -> list[str]:
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_rows_of_other_rules_become_other_bars():
    row = {"tessellation": "square", "planner": "fcost", "gap": 0.1, "optimal": False, "corners": "allow"}
    rows = [
        row,
        {**row, "planner_options": '{"rule":"paper"}', "gap": 0.3},
        {**row, "planner_options": {"rule": "queue"}, "gap": 0.4},
        {**row, "corners": "no-cut", "gap": 0.5},
        {**row, "gap": None},
    ]
    ax = draw_comparison(rows)
    assert [round(bar.get_height(), 6) for bar in ax.patches] == [10.0, 30.0, 40.0, 50.0]
    assert words_of_legend(ax) == [
        "fcost, corners allow", "fcost rule=paper, corners allow", "fcost rule=queue, corners allow",
        "fcost, corners no-cut",
    ]  # fmt: skip
    assert words_of_legend(draw_comparison([{**each, "corners": "allow"} for each in rows])) == [
        "fcost", "fcost rule=paper", "fcost rule=queue", "95 % over 2 rows",
    ]  # fmt: skip


def test_lines_on_bars_are_intervals_over_seeds():
    row = {"tessellation": "square", "planner": "fcost", "optimal": False}
    # Two areas of each of three seeds: the means of the seeds are 20, 30 and 40 %.
    rows = [{**row, "seed": seed, "gap": 0.1 * seed + gap} for seed in (1, 2, 3) for gap in (0.05, 0.15)]
    ax = draw_comparison(rows)
    (line,) = [one for one in ax.collections if isinstance(one, LineCollection)]
    half = 4.303 * 10 / 3**0.5
    ((low, high),) = [path.vertices[:, 1] for path in line.get_paths()]
    assert (low, high) == (pytest.approx(30 - half), pytest.approx(30 + half))
    assert words_of_legend(ax) == ["fcost", "95 % over 3 seeds"]
    assert not draw_comparison(rows[:2]).collections  # one seed tells nothing of others


def test_a_comparison_is_taken_as_it_is():
    scenario = Scenario(Area("square", [[0, 0, 0, 0]]), [(3, 0)], [(0, 0), (1, 0)])
    ax = draw_comparison(th.make_comparison([scenario], ["greedy", "fcost:rule=paper"]), title="Gaps", legend=False)
    assert (texts_of(ax), ax.get_title(), ax.get_legend()) == (["0.0*", "0.0*"], "Gaps", None)


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ({"planner": "fcost", "gap": 0.1}, "row 0 has no 'tessellation'"),
        ({"tessellation": "square", "planner": "fcost", "gap": "0.1"}, "gap must be a number or None, not '0.1'; "),
        ("row", "rows must be mappings, or a comparison; row 0 is 'row'"),
    ],
)
def test_rows_that_are_none_are_refused(row, message):
    with pytest.raises(FormatError, match=message):
        draw_comparison([row])


def boxes_of(figure, parts):
    figure.canvas.draw()
    return [part.get_window_extent() for part in parts]


@pytest.mark.parametrize("layout", [None, "constrained"])
def test_no_words_of_a_small_chart_are_cut_off(layout):
    row = {"tessellation": "square", "optimal": True, "planner_options": '{"rule":"paper"}'}
    rows = [{**row, "planner": f"planner {number}", "gap": 0.1} for number in range(5)]
    for size in ((5, 3), (4, 2.4)):
        figure, ax = pyplot.subplots(figsize=size, layout=layout)
        draw_comparison(rows, ax, title="Gaps of five planners")
        for box in boxes_of(figure, [ax.yaxis.label, ax.get_legend(), ax.title]):
            assert box.x0 >= 0 and box.y0 >= 0 and box.x1 <= figure.bbox.width and box.y1 <= figure.bbox.height
        assert not ax.get_legend().get_window_extent().overlaps(ax.title.get_window_extent())


@pytest.mark.parametrize("layout", [None, "constrained", "tight"])
def test_legends_of_subplots_do_not_overlap(layout):
    n_scheme = make_n_scheme(scenario_of("triangular"))
    plan = plan_from_lists(n_scheme.scenario, [[WAIT], []], planner="hand")
    figure, axes = pyplot.subplots(3, 3, figsize=(7, 7), layout=layout)
    for row in axes:
        draw_area(n_scheme.scenario, row[0])
        draw_d_scheme(make_d_scheme(n_scheme), row[1], title="D")
        draw_plan(plan, row[2], title="P")
    legends = [ax.get_legend() for ax in axes.flat]
    boxes = boxes_of(figure, [*legends, *(ax.title for ax in axes.flat)])
    assert all(box.width > 0 for box in boxes)
    for number, box in enumerate(boxes):
        assert box.x0 >= 0 and box.y0 >= 0
        assert not any(box.overlaps(other) for other in boxes[:number])


def test_titles_and_legends_are_as_asked():
    scenario = scenario_of("hexagonal")
    n_scheme = make_n_scheme(scenario)
    plan = plan_from_lists(scenario, [[WAIT], []], planner="hand")
    states = list(distance_generations(scenario))
    for draw in (
        lambda **asked: draw_area(scenario, **asked),
        lambda **asked: draw_n_scheme(n_scheme, **asked),
        lambda **asked: draw_d_scheme(make_d_scheme(n_scheme), **asked),
        lambda **asked: draw_plan(plan, **asked),
        lambda **asked: draw_generation(scenario, states[1], 1, **asked),
        lambda **asked: draw_arrivals(plan, **asked),
    ):
        ax = draw(title="mine", legend=False)
        assert (ax.get_title(), ax.get_legend(), len(ax.figure.axes)) == ("mine", None, 1)
        assert draw(title="").get_title() == ""
        assert draw().get_legend() is not None


def test_a_sheet_of_generations_has_one_scale():
    scenario = scenario_of("triangular")
    n_scheme, states = make_n_scheme(scenario), list(distance_generations(scenario))
    plan = plan_from_lists(scenario, [[WAIT], []], planner="hand")
    axes = draw_generations(
        scenario, iter(states), d_scheme=make_d_scheme(n_scheme), plan=plan, configuration=True, title="Figure 7"
    )
    last = len(states) - 1
    titles = ["", *(f"Generation {number}" for number in range(last)), f"Generation {last}: the N-scheme", "D-scheme"]
    assert [ax.get_title() for ax in axes] == [*titles, "Plan, total time 0"]
    *panels, bar = axes[0].figure.axes
    assert panels == axes
    assert bar.get_ylim() == (0, n_scheme.farthest)
    assert axes[0].figure.get_suptitle() == "Figure 7"
    # A cell keeps its colour from when it has its distance on.
    faces = [
        next(one for one in ax.collections if isinstance(one, PolyCollection)).get_facecolors()
        for ax in axes[1 : 1 + len(states)]
    ]
    for early, states_then in zip(faces, states, strict=False):
        is_final = (states_then == states[-1]).reshape(-1)
        assert np.array_equal(early[is_final], faces[-1][is_final])
    (legend,) = axes[0].figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["destination", "barrier", "not reached"]


def test_a_sheet_shows_the_generations_asked_for():
    scenario = Scenario(Area("square", np.zeros((1, 40))), [(0, 0)])
    states = list(distance_generations(scenario))
    axes = draw_generations(scenario, states, columns=2, legend=False)
    assert (len(states), len(axes), len(axes[0].figure.axes)) == (40, 12, 12)
    assert axes[0].get_title() == "Generation 0" and axes[-1].get_title() == "Generation 39: the N-scheme"
    shown = draw_generations(scenario, states, numbers=[0, 7])
    assert [ax.get_title() for ax in shown] == ["Generation 0", "Generation 7"]
    for wrong in ([40], [-1], [1.5], []):
        with pytest.raises(FormatError, match="numbers of generations must be"):
            draw_generations(scenario, states, numbers=wrong)
    with pytest.raises(FormatError, match="generations must be at least one"):
        draw_generations(scenario, [])
    with pytest.raises(FormatError, match="columns must be a whole number"):
        draw_generations(scenario, states, columns=0)


def test_without_matplotlib_the_error_says_what_to_install(monkeypatch):
    for module in [name for name in sys.modules if name.split(".")[0] == "matplotlib"]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(MissingExtraError, match=r"trihex\[plot\]"):
        draw_area(Area("square", [[0]]))
