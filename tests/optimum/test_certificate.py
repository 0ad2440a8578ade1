"""Certificates: the checker, which shares no code with trihex, accepts what is proven and nothing else."""

import ast
import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from examples import check_certificate

import trihex as th
from tests.sweeps import swept
from trihex.errors import PlanError, TooLargeError
from trihex.optimum import certificate as module, fair

SHAPES = (
    ("hexagonal", "full"),
    ("square", "full"),
    ("triangular", "full"),
    ("square", "edge"),
    ("triangular", "edge"),
    ("triangular", "full"),
)


def crowded_scenario(seed):
    """Many robots, few destinations, walls, cells of each shape, any costs and rules; some robots cannot arrive."""
    rng = np.random.default_rng(seed)
    tessellation = th.Tessellation(*SHAPES[seed % 6], costs=("paper", "euclidean")[seed // 6 % 2])
    area = th.Area(tessellation, rng.random(rng.integers(3, 9, 2)) < 0.25)
    free = rng.permutation(np.flatnonzero(~area.barriers))
    goals = int(rng.integers(1, 4))
    robots = free[int(rng.integers(0, goals + 1)) :][: int(rng.integers(0, 30))]
    return th.Scenario(
        area,
        free[:goals],
        robots,
        destination_capacity=(None, 1, 2)[seed // 3 % 3],
        waiting_cost=None if seed % 5 else tessellation.edge_cost * int(rng.integers(0, 13)) // 10,
        crossing=("forbid", "allow")[int(rng.random() < 0.3)],
        corners=("allow", "no-squeeze", "no-cut")[rng.integers(3)],
    )


def proven_optimum(scenario):
    """Return the certificate of an optimal plan, None if the planner could not prove it either."""
    plan = th.make_plan(scenario, "optimal")
    if plan.optimal:
        return th.make_certificate(plan)
    with pytest.raises(PlanError, match="needs the best plan"):
        th.make_certificate(plan)
    return None


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


@pytest.mark.parametrize("arguments", [[], ["area.map", "plan.npz"], ["--help"]])
def test_the_checker_tells_how_it_is_used(arguments, monkeypatch):
    monkeypatch.setattr("sys.argv", [check_certificate.__file__, *arguments])
    with pytest.raises(SystemExit, match=r"^usage: python check_certificate.py AREA PLAN CERTIFICATE$"):
        runpy.run_path(check_certificate.__file__, run_name="__main__")


@pytest.mark.parametrize("share", range(3))
def test_optima_are_proven_and_the_checker_accepts_the_proof(share, tmp_path):
    held_up = crossed = 0
    for seed in range(share, swept(300, 60), 3):
        certificate = proven_optimum(crowded_scenario(seed))
        if certificate is None:
            continue
        words = check_certificate.check(*written(certificate, tmp_path))
        assert f": {certificate.plan.total_time} in all, and no plan takes less" in words
        assert (certificate.toll > 0).all() and (certificate.vertex_toll > 0).all()
        held_up += certificate.toll.size > 0
        crossed += certificate.vertex.size > 0
    assert held_up > swept(300, 60) / 12
    assert crossed or share != 2


def test_a_plan_of_any_planner_is_proven_just_if_there_is_none_better():
    proven, refused = 0, 0
    for seed in range(swept(120, 60)):
        scenario = crowded_scenario(seed)
        best, plan = th.make_plan(scenario, "optimal"), th.make_plan(scenario, "greedy")
        # Where waiting is dear, the planner may miss the optimum and know it; then another may have found it.
        is_best = plan.total_time == best.total_time if best.optimal else None
        try:
            is_proven = th.make_certificate(plan).plan is plan
        except PlanError:
            is_proven = False
        assert is_proven == is_best if best.optimal else not is_proven or plan.total_time <= best.total_time, seed
        proven += is_proven
        refused += not is_proven
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
    names = ("cell", "step", "toll")
    if certificate.vertex.size and rng.random() < 0.5:
        names = ("vertex", "vertex_step", "vertex_toll")
    columns = np.stack([getattr(certificate, name) for name in names])
    last, dearest = int(certificate.plan.steps) + 1, 2 * int(columns[2].max()) + 2
    for _ in range(int(rng.integers(1, 4))):
        at, kind = int(rng.integers(columns.shape[1])), rng.integers(4)
        if kind < 3 and columns.size:
            most = (certificate.plan.scenario.area.cell_count, last, dearest)[kind]
            columns[kind, at] = rng.integers(0 if kind == 0 else -1, most)
        elif rng.random() < 0.5 and columns.shape[1] > 1:
            columns = np.delete(columns, at, axis=1)
        else:
            columns = np.append(columns, [[rng.integers(certificate.plan.scenario.area.cell_count)], [at], [1]], axis=1)
    return replace(certificate, **dict(zip(names, columns, strict=True)))


@pytest.mark.parametrize("share", range(4))
def test_what_is_accepted_of_mutated_plans_and_certificates_is_true(share, tmp_path):
    """A plan is optimal if the judge finds no conflict and it is as short as the optimum; tolls cannot make it so."""
    seen = {True: 0, False: 0}
    for seed in range(share, swept(1200, 160), 4):
        rng, scenario = np.random.default_rng(seed), crowded_scenario(seed % 180)
        certificate = proven_optimum(scenario)
        if certificate is None or not certificate.toll.size:
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


HEADER = "place,x,y,step,toll\n"


def test_the_area_must_be_that_of_the_plan(tmp_path):
    paths = written(th.make_certificate(plan_in_a_row()), tmp_path)
    assert is_accepted(*paths)
    th.write_area(th.Area("hexagonal", [[0, 0, 0, 1]]), paths[0])
    assert not is_accepted(*paths)


@pytest.mark.parametrize(
    "text",
    [
        "place,x,y,step\ncell,1,0,2\n",
        HEADER + "cell,1,0,2\n",
        HEADER + "cell,1,0,2,one\n",
        HEADER + "wall,1,0,2,0\n",
        HEADER + "cell,4,0,2,0\n",  # outside
        HEADER + "cell,1,0,0,0\n",  # before the first step
        HEADER + "cell,1,0,9,0\n",  # after the last
        HEADER + "cell,1,0,2,-1\n",
        HEADER + "cell,1,0,2,99999999999999999999\n",
        HEADER + "cell,1,0,2,0\ncell,1,0,2,0\n",  # twice
        HEADER + "cell,3,0,2,0\n",  # at a destination that any number may enter
        HEADER + "vertex,6,0,2,0\n",  # outside, though vertices may lie a cell farther out
        "",
    ],
)
def test_tolls_that_break_a_rule_are_rejected(text, tmp_path):
    paths = written(th.make_certificate(plan_in_a_row()), tmp_path)
    paths[2].write_text(HEADER + "cell,1,0,2,0\n")
    assert is_accepted(*paths)
    paths[2].write_text(text)
    assert not is_accepted(*paths)


def test_where_vertices_are_free_for_all_they_have_no_toll(tmp_path):
    scenario = th.Scenario(th.Area("square", [[0, 0], [0, 0]]), [(1, 1)], [(0, 0)])
    paths = written(th.make_certificate(th.make_plan(scenario, "greedy")), tmp_path)
    paths[2].write_text(HEADER + "vertex,1,1,1,0\n")
    assert is_accepted(*paths)
    paths[2].write_text(HEADER + "vertex,1,1,1,4\n")  # whoever goes that way pays it, and nobody else is there
    assert is_accepted(*paths)
    paths[2].write_text(HEADER + "vertex,1,1,1,7\n")  # then it would be cheaper to go along edges
    assert not is_accepted(*paths)
    th.write_plan(th.make_plan(replace(scenario, crossing="allow"), "greedy"), paths[1])
    paths[2].write_text(HEADER + "vertex,1,1,1,0\n")
    assert not is_accepted(*paths)


def test_robots_that_cross_or_squeeze_are_found_out(tmp_path):
    free = th.Scenario(th.Area("square", [[0, 0], [0, 0]]), [(1, 1), (0, 1)], [(0, 0), (1, 0)], crossing="allow")
    crossing = replace(th.make_plan(free, "greedy"), actions=np.array([5, 6], dtype=np.uint8))
    for plan in (crossing, replace(crossing, scenario=replace(free, crossing="forbid"))):
        paths = written(replace(th.make_certificate(th.make_plan(free, "optimal")), plan=plan), tmp_path)
        with pytest.raises(ValueError, match="must not cross" if plan is not crossing else "take"):
            check_certificate.check(*paths)
    walls = th.Scenario(th.Area("square", [[0, 1], [1, 0]]), [(1, 1)], [(0, 0)])
    plan = th.make_plan(walls, "optimal")
    assert is_accepted(*written(th.make_certificate(plan), tmp_path))
    squeezed = replace(th.make_certificate(plan), plan=replace(plan, scenario=replace(walls, corners="no-squeeze")))
    assert not is_accepted(*written(squeezed, tmp_path))


@pytest.mark.parametrize("rules", [{"following": "forbid"}, {"clock": "costs"}])
def test_where_moves_last_there_is_no_certificate(rules):
    plan = th.make_plan(th.Scenario(th.Area("square", [[0, 0, 0]]), [(2, 0)], [(0, 0)], **rules), "greedy")
    with pytest.raises(PlanError, match="needs time in steps alone: clock='steps' and following='allow', not "):
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


def test_fair_prices_are_found_bit_by_bit_as_at_once(monkeypatch):
    scenario = th.Scenario(th.Area("triangular", np.zeros((12, 12))), [(6, 6)], np.arange(60))
    plan = th.make_plan(scenario, "optimal")
    at_once = th.make_certificate(plan)
    assert at_once.toll.size > 20
    monkeypatch.setattr(fair, "_BUDGET", 3)
    monkeypatch.setattr(fair, "_LIST", 1)
    told = []
    assert th.make_certificate(plan, progress=lambda *done: told.append(done)) == at_once
    assert len(told) > 10
    with pytest.raises(TooLargeError, match="memory_limit"):
        th.make_certificate(plan, memory_limit=10)
