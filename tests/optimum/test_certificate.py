"""Certificates: the checker, which shares no code with trihex, accepts what is proven and nothing else."""

import ast
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from examples import check_certificate

import trihex as th
from tests.sweeps import swept
from trihex.errors import PlanError, TooLargeError
from trihex.optimum import certificate as module

SHAPES = (("hexagonal", "full"), ("square", "edge"), ("triangular", "edge"))


def crowded_scenario(seed):
    """Many robots, few destinations, walls, on cells of each shape; some robots cannot arrive."""
    rng = np.random.default_rng(seed)
    tessellation = th.Tessellation(*SHAPES[seed % 3], costs=("paper", "euclidean")[seed % 2])
    area = th.Area(tessellation, rng.random(rng.integers(3, 9, 2)) < 0.25)
    free = rng.permutation(np.flatnonzero(~area.barriers))
    goals = int(rng.integers(1, 4))
    robots = free[int(rng.integers(0, goals + 1)) :][: int(rng.integers(0, 30))]
    return th.Scenario(area, free[:goals], robots, destination_capacity=(None, 1, 2)[seed // 3 % 3])


def written(certificate, folder):
    """Return area, plan and certificate as files."""
    paths = [folder / name for name in ("area.map", "plan.npz", "certificate.csv")]
    th.write_area(certificate.plan.scenario.area, paths[0])
    th.write_plan(certificate.plan, paths[1])
    th.write_certificate(certificate, paths[2])
    return paths


def is_accepted(*paths):
    try:
        check_certificate.check(*paths)
    except Exception:  # as the script does it: whatever is wrong, nothing is proven
        return False
    return True


@pytest.mark.parametrize("share", range(3))
def test_optima_are_proven_and_the_checker_accepts_the_proof(share, tmp_path):
    held_up = 0
    for seed in range(share, swept(300, 60), 3):
        plan = th.make_plan(crowded_scenario(seed), "optimal")
        certificate = th.make_certificate(plan)
        words = check_certificate.check(*written(certificate, tmp_path))
        assert f": {plan.arrival_step_of_robot[plan.arrived].sum()} steps, and no plan takes fewer" in words
        assert (certificate.toll > 0).all()
        held_up += certificate.toll.size > 0
    assert held_up > swept(300, 60) / 12


def test_a_plan_of_any_planner_is_proven_just_if_there_is_none_better():
    proven, refused = 0, 0
    for seed in range(swept(120, 60)):
        scenario = crowded_scenario(seed)
        best, plan = th.make_plan(scenario, "optimal"), th.make_plan(scenario, "greedy")
        if best.total_time == plan.total_time:
            assert th.make_certificate(plan).plan is plan
            proven += 1
        else:
            with pytest.raises(PlanError, match=f"take {plan.arrival_step_of_robot[plan.arrived].sum()} steps"):
                th.make_certificate(plan)
            refused += 1
    assert proven > 5 < refused


def mutated_plan(plan, rng):
    """Return the plan with one thing changed: an action, the order of two, where one robot ends, or the rules."""
    actions, first, at = plan.actions.copy(), plan.first_action.copy(), int(rng.integers(plan.actions.size))
    kind = rng.integers(5)
    if kind == 0:
        actions[at] = rng.choice([*range(plan.scenario.area.tessellation.direction_count), 255])
    elif kind == 1:
        other = int(rng.integers(actions.size))
        actions[[at, other]] = actions[[other, at]]
    elif kind == 2:  # one action less
        actions, first = np.delete(actions, at), first - (first > at)
    elif kind == 3:  # a wait more
        actions, first = np.insert(actions, at, 255), first + (first > at)
    else:
        one = replace(plan.scenario, destination_capacity=int(rng.integers(1, 3)))
        return replace(plan, scenario=one)
    return replace(plan, actions=actions, first_action=first)


def mutated_tolls(certificate, rng):
    """Return the certificate with one to three of its numbers changed, a toll dropped, or one more."""
    columns = np.stack([certificate.cell, certificate.step, certificate.toll])
    last = int(certificate.plan.steps) + 1
    for _ in range(int(rng.integers(1, 4))):
        at, kind = int(rng.integers(columns.shape[1])), rng.integers(4)
        if kind < 3 and columns.size:
            most = (certificate.plan.scenario.area.cell_count, last, last)[kind]
            columns[kind, at] = rng.integers(0 if kind == 0 else -1, most)
        elif rng.random() < 0.5 and columns.shape[1] > 1:
            columns = np.delete(columns, at, axis=1)
        else:
            columns = np.append(columns, [[rng.integers(certificate.plan.scenario.area.cell_count)], [at], [1]], axis=1)
    return replace(certificate, cell=columns[0], step=columns[1], toll=columns[2])


@pytest.mark.parametrize("share", range(4))
def test_what_is_accepted_of_mutated_plans_and_certificates_is_true(share, tmp_path):
    """A plan is optimal if the judge finds no conflict and it is as short as the optimum; tolls cannot make it so."""
    seen = {True: 0, False: 0}
    for seed in range(share, swept(2000, 200), 4):
        rng, scenario = np.random.default_rng(seed), crowded_scenario(seed % 90)
        certificate = th.make_certificate(th.make_plan(scenario, "optimal"))
        if not certificate.toll.size:
            continue
        longer = th.make_plan(scenario, "greedy")
        if rng.random() < 0.5:
            mutant = replace(certificate, plan=mutated_plan(certificate.plan, rng))
        elif longer.total_time > certificate.plan.total_time and rng.random() < 0.5:
            mutant = mutated_tolls(replace(certificate, plan=longer), rng)
        else:
            mutant = mutated_tolls(certificate, rng)
        accepted = is_accepted(*written(mutant, tmp_path))
        seen[accepted] += 1
        if accepted:
            assert th.audit_plan(mutant.plan).is_clean, seed
            best = th.make_plan(mutant.plan.scenario, "optimal")
            assert np.array_equal(mutant.plan.arrived, best.arrived), seed
            assert mutant.plan.total_time == best.total_time, seed
    assert seen[False] > seen[True] > 0


def test_the_checker_shares_no_code_with_trihex_and_fits_on_a_few_pages():
    source = Path(check_certificate.__file__).read_text()
    imports = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Import | ast.ImportFrom)]
    names = {alias.name for node in imports for alias in node.names if isinstance(node, ast.Import)}
    names |= {node.module for node in imports if isinstance(node, ast.ImportFrom)}
    assert names == {"sys", "functools", "pathlib", "numpy"}
    assert len(source.splitlines()) <= 150


def plan_in_a_row(**rules):
    scenario = th.Scenario(th.Area("hexagonal", [[0, 0, 0, 0]]), [(3, 0)], [(1, 0), (0, 0)], **rules)
    return th.make_plan(scenario, "greedy")


def test_the_area_must_be_that_of_the_plan(tmp_path):
    paths = written(th.make_certificate(plan_in_a_row()), tmp_path)
    assert is_accepted(*paths)
    th.write_area(th.Area("hexagonal", [[0, 0, 0, 1]]), paths[0])
    assert not is_accepted(*paths)


@pytest.mark.parametrize(
    "text",
    [
        "x,y,step\n1,0,2\n",
        "x,y,step,toll\n1,0,2\n",
        "x,y,step,toll\n1,0,2,one\n",
        "x,y,step,toll\n4,0,2,0\n",  # outside
        "x,y,step,toll\n1,0,0,0\n",  # before the first step
        "x,y,step,toll\n1,0,9,0\n",  # after the last
        "x,y,step,toll\n1,0,2,-1\n",
        "x,y,step,toll\n1,0,2,99999999999999999999\n",
        "x,y,step,toll\n1,0,2,0\n1,0,2,0\n",  # twice
        "x,y,step,toll\n3,0,2,0\n",  # at a destination that any number may enter
        "",
    ],
)
def test_tolls_that_break_a_rule_are_rejected(text, tmp_path):
    paths = written(th.make_certificate(plan_in_a_row()), tmp_path)
    paths[2].write_text("x,y,step,toll\n1,0,2,0\n")
    assert is_accepted(*paths)
    paths[2].write_text(text)
    assert not is_accepted(*paths)


@pytest.mark.parametrize(
    ("tessellation", "rules", "message"),
    [
        (th.Tessellation("square"), {}, "needs steps that all cost the same: .* or neighbourhood='edge'"),
        (th.Tessellation("hexagonal"), {"waiting_cost": 5}, "waiting_cost must be that of a move, 10, not 5"),
        (th.Tessellation("hexagonal"), {"following": "forbid"}, "following='allow', not 'steps', 'forbid'"),
    ],
)
def test_where_steps_cost_differently_there_is_no_certificate(tessellation, rules, message):
    plan = th.make_plan(th.Scenario(th.Area(tessellation, [[0, 0, 0]]), [(2, 0)], [(0, 0)], **rules), "greedy")
    with pytest.raises(PlanError, match=message):
        th.make_certificate(plan)


def test_a_plan_must_be_whole_and_without_conflicts():
    plan = plan_in_a_row()
    with pytest.raises(PlanError, match="all arrive who can, unlike robot 1"):
        th.make_certificate(
            replace(plan, actions=plan.actions[:-1], first_action=plan.first_action - np.array([0, 0, 1]))
        )
    waits = replace(plan, actions=np.insert(plan.actions, 0, 255), first_action=plan.first_action + np.array([0, 1, 1]))
    with pytest.raises(PlanError, match="without conflicts"):
        th.make_certificate(waits)
    with pytest.raises(TooLargeError, match="memory_limit"):
        th.make_certificate(plan, memory_limit=10)


def test_the_work_can_be_watched_and_grows_its_stack(monkeypatch):
    monkeypatch.setattr(module, "_BUDGET", 3)
    monkeypatch.setattr(module, "_STACK", 9)
    scenario = th.Scenario(th.Area("hexagonal", np.zeros((9, 9))), [(4, 4)], np.arange(30))
    plan = th.make_plan(scenario, "optimal")
    told = []
    again = th.make_certificate(plan, progress=lambda done, all_steps: told.append((done, all_steps)))
    monkeypatch.undo()
    assert again == th.make_certificate(plan)
    assert told[-1] == (plan.steps, plan.steps)
    assert len(told) > 10
