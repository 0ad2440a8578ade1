"""Records as text: one readable line each, however much they hold."""

import numpy as np
import pytest

import trihex as th
from trihex.record import short


@pytest.fixture(scope="module")
def records():
    area = th.make_caves_area("hexagonal", 60, 90, seed=4)
    exits = np.flatnonzero(~area.barriers)[:1]
    scenario = th.Scenario(area, exits, th.random_robots(area, 200, seed=1, avoid=exits), corners="no-cut")
    plan, n_scheme = th.make_plan(scenario, "greedy"), th.make_n_scheme(scenario)
    trial = th.Trial(scenario.with_robots(scenario.robots[:5]), sensor=3)
    order, run = trial.execution.step(), th.Trial(scenario.with_robots(scenario.robots[:5])).run()
    repair = th.LivingField(scenario).change(opened=np.flatnonzero(~area.barriers)[-1:])
    study = th.make_comparison([scenario.with_robots(scenario.robots[:5])], ["greedy"])
    return [
        area, area.tessellation, area.layout, scenario, n_scheme, th.make_d_scheme(n_scheme), plan,
        th.make_report(plan), th.audit_plan(plan), th.make_lower_bound(n_scheme), th.make_arrivals(plan),
        th.picture_of_plan(plan), plan.sets_at(1), th.make_passing_order(plan), th.Frame(0.5),
        th.make_distance_automaton("hexagonal"), order, run, th.make_run_report(run), th.audit_run(run), repair, study,
    ]  # fmt: skip


def test_every_record_is_one_line(records):
    for record in records:
        text = repr(record)
        assert text == str(record)
        assert text.startswith(f"{type(record).__name__}(")
        assert "\n" not in text
        assert "array(" not in text
        assert len(text) < 1000


def test_the_line_says_what_one_wants_to_know(records):
    text = {type(record).__name__: repr(record) for record in records}
    area = "hexagonal, 90 x 60 cells, "
    assert text["Area"].startswith(f"Area({area}")
    assert "1 destination, 200 robots, corners='no-cut')" in text["Scenario"]
    assert text["Plan"].startswith(f"Plan('greedy', {area}")
    assert "200 of 200 robots arrive" in text["Plan"]
    assert ", gap " in text["Report"]
    assert text["Report"].endswith(" %, 0 conflicts)")
    assert text["Audit"] == "Audit(0 conflicts)"
    assert text["Tessellation"] == "Tessellation(name='hexagonal', neighbourhood='full', costs='paper', clock='steps')"
    assert "5 of 5 robots arrived" in text["Run"]
    assert text["Comparison"] == "Comparison(1 scenario, 1 plan by greedy)"


def test_reports_and_comparisons_are_tables_in_notebooks(records):
    shown = {type(one).__name__: one._repr_html_() for one in records if hasattr(one, "_repr_html_")}
    assert set(shown) == {"Report", "RunReport", "Comparison"}
    assert "<tr><th>robots</th><td>200</td></tr>" in shown["Report"]
    assert "<td>greedy</td>" in shown["Comparison"]
    name = th.Area("square", [[0, 0]], name="<b>")
    report = th.make_report(th.make_plan(th.Scenario(name, (0, 0), (1, 0))))
    assert "&lt;b&gt;" in report._repr_html_()


def test_long_values_are_cut_short():
    assert short("x" * 1000) == "'" + "x" * 199 + "..."
    assert short({number: number for number in range(9)}) == "<9 items>"
    assert short(np.arange(2)) == "[0, 1]"
