"""The judge: each rule broken on purpose, and nonsense plans against a judge that looks at drawn polygons."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

import trihex as th
from tests.oracles.rules import judge
from tests.strategies import scenarios, with_start_times
from tests.sweeps import swept
from trihex.areas import Claim
from trihex.judging.conflict import KINDS
from trihex.kernels.codes import JUMP, WAIT
from trihex.plans import plan_from_lists

N, E, S, W, NE, SE, SW, NW = range(8)  # the directions of squares


def squares(drawing, actions, *, jumps=(), **rules):
    """Plan on squares from a drawing: `.` free, `#` barrier, `D` destination, `a`, `b`, ... robots."""
    rows = drawing.split()
    place = {letter: (x, y) for y, row in enumerate(rows) for x, letter in enumerate(row)}
    area = th.Area("square", [[letter == "#" for letter in row] for row in rows])
    destinations = [(x, y) for y, row in enumerate(rows) for x, letter in enumerate(row) if letter == "D"]
    robots = [place[letter] for letter in sorted(place) if letter.islower()]
    scenario = th.Scenario(area, destinations, robots, **rules)
    return plan_from_lists(scenario, actions, jumps=list(jumps))


CLEAN = [
    squares("abD", [[E, E], [E]]),  # each enters the cell that the other leaves
    squares("ab. dcD", [[E, E, S], [E, S], [E], [N, E, E, S]]),  # nobody waits, all turn
    squares("a#D", [[]]),  # cannot arrive, and stands still
    squares("aDb", [[E], [W]]),  # two enter D in one step, each from its own cell
    squares("Da", [[W]], destination_capacity=1),
    squares("ab DD", [[SE], [SW]], crossing="allow"),
    squares("a. .D", [[SE]], corners="no-cut"),
    squares("a# .D", [[SE]], corners="no-squeeze"),
    squares("a.D", [[WAIT, WAIT, E, E]], start_times=2),
    squares("a#D", [[]], start_times=2),
]
# Each rule broken once: the plan, the kind, and how the conflict reads.
BROKEN = [
    (
        squares("ab.D", [[E, WAIT, E, E], [WAIT, E, E]]),
        "cell",
        "step 1: robots 0 and 1 are both in cell (1, 0)",
    ),
    (
        squares("ab#. .D..", [[SE], []]),  # b stands still where it could go
        "arrival",
        "step 0: robot 1 ends in (1, 0), which is no destination, though it could have reached one",
    ),
    (
        squares("a.D #b#", [[E, E], [N, WAIT, E]]),
        "cell",
        "step 1: robots 0 and 1 are both in cell (1, 0)",
    ),
    (
        squares("abD ...", [[E, E], [W, S, E, NE]]),
        "exchange",
        "step 1: robots 0 and 1 exchange cells (0, 0) and (1, 0)",
    ),
    (
        squares("ab DD", [[SE], [SW]]),
        "crossing",
        "step 1: robots 0 and 1 pass one vertex, from (0, 0) to (1, 1) and from (1, 0) to (0, 1)",
    ),
    (
        squares("a..D", [[JUMP, E]], jumps=[(0, 2)]),
        "jump",
        "step 1: robot 0 jumps from (0, 0) to (2, 0), which is no neighbour",
    ),
    (
        squares("a#D", [[E, E]]),
        "barrier",
        "step 1: robot 0 moves from (0, 0) onto the barrier (1, 0)",
    ),
    (
        squares("aD", [[W]]),
        "barrier",
        "step 1: robot 0 leaves the area from (0, 0)",
    ),
    (
        squares("a# #D", [[SE]], corners="no-squeeze"),
        "corner",
        "step 1: robot 0 moves from (0, 0) to (1, 1) round a corner that the rule closes",
    ),
    (
        squares("a# .D", [[SE]], corners="no-cut"),
        "corner",
        "step 1: robot 0 moves from (0, 0) to (1, 1) round a corner that the rule closes",
    ),
    (
        squares("aDb", [[E], [W]], destination_capacity=1),
        "capacity",
        "step 1: robot 1 is one too many to enter destination (1, 0)",
    ),
    (
        squares("a.D", [[E]]),
        "arrival",
        "step 1: robot 0 ends in (1, 0), which is no destination, though it could have reached one",
    ),
    (
        squares("aD.", [[E, E]]),
        "arrival",
        "step 1: robot 0 acts on after it has entered destination (1, 0)",
    ),
    (
        squares("a.D", [[WAIT, E, E]], start_times=[2]),
        "start",
        "step 2: robot 0 leaves (0, 0) before its start time, 2",
    ),
]


@pytest.mark.parametrize("plan", CLEAN)
def test_a_clean_plan_is_clean(plan):
    audit = th.audit_plan(plan)
    assert audit.is_clean, [str(c) for c in audit.conflicts]


@pytest.mark.parametrize(("plan", "kind", "text"), BROKEN)
def test_each_rule_broken_once_is_found(plan, kind, text):
    audit = th.audit_plan(plan)
    assert [(c.kind, str(c)) for c in audit.conflicts] == [(kind, text)]
    assert (audit.conflict_count, audit.is_clean) == (1, False)


def test_every_kind_is_broken_above():
    assert {kind for _, kind, _ in BROKEN} == set(KINDS)


def test_robots_that_have_stopped_stay_in_the_way():
    # Robot 1 cannot arrive and stands; robot 0 passes over it; robot 2 has stopped on the way.
    plan = squares(".a.cD ##### b####", [[E, E, E], [], [WAIT]])
    assert [str(c) for c in th.audit_plan(plan).conflicts] == [
        "step 1: robot 2 ends in (3, 0), which is no destination, though it could have reached one",
        "step 2: robots 0 and 2 are both in cell (3, 0)",
    ]
    walled = th.Scenario(th.Area("square", [[0, 0, 1, 0]]), [(3, 0)], [(0, 0), (1, 0)])
    moved = plan_from_lists(walled, [[E], []])
    assert [str(c) for c in th.audit_plan(moved).conflicts] == ["step 1: robots 0 and 1 are both in cell (1, 0)"]


def test_a_robot_that_starts_on_a_destination_does_not_act():
    scenario = th.Scenario(th.Area("square", [[0, 0, 0]]), [(0, 0)], [(0, 0), (1, 0)])
    assert th.audit_plan(plan_from_lists(scenario, [[], [W]])).is_clean
    acts = th.audit_plan(plan_from_lists(scenario, [[E], [W]]))
    assert [str(c) for c in acts.conflicts] == ["step 0: robot 0 acts on after it has entered destination (0, 0)"]


def test_no_more_conflicts_are_described_than_asked_for_but_all_are_counted():
    area = th.Area("square", np.zeros((2, 40), bool))
    scenario = th.Scenario(area, [(39, 1)], [(x, 0) for x in range(30)])
    plan = plan_from_lists(scenario, [[WAIT] * (40 - x) for x in range(30)])
    few, all_of_them = th.audit_plan(plan, limit=4), th.audit_plan(plan)
    assert (few.conflict_count, all_of_them.conflict_count, len(all_of_them.conflicts)) == (30, 30, 30)
    assert few.conflicts == all_of_them.conflicts[:4]
    assert [c.step for c in few.conflicts] == [11, 12, 13, 14]
    assert th.audit_plan(plan, limit=0).conflicts == ()


def test_progress_is_told_and_ends_complete():
    told = []
    th.audit_plan(squares("abD", [[E, E], [E]]), progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (3, 3)


def nonsense(scenario, seed):
    """Actions that no planner would dream of, though most of them stay within the area."""
    rng, area = np.random.default_rng(seed), scenario.area
    tessellation, jump_share = area.tessellation, rng.choice([0, 0, 0.1])
    actions, jumps, count = [], [], 0
    for cell in scenario.robots.tolist():
        own = []
        for _ in range(rng.integers(0, 7)):
            x, y = cell % area.width, cell // area.width
            steps = tessellation.step_of_direction[int(tessellation.orientation_of_cell(x, y))]
            inside = [k for k, (i, j) in enumerate(steps) if 0 <= x + i < area.width and 0 <= y + j < area.height]
            if rng.random() < jump_share:
                own.append(JUMP)
                cell = int(rng.integers(area.cell_count))
                jumps.append((count, cell))
            elif inside and rng.random() < 0.8:
                own.append(int(rng.choice(inside)))
                cell += int(steps[own[-1]] @ (1, area.width))
            else:
                own.append(int(rng.choice([WAIT, WAIT, rng.integers(tessellation.direction_count)])))
            count += 1
        actions.append(own)
    return plan_from_lists(scenario, actions, jumps=jumps)


@settings(max_examples=swept(400), deadline=None)
@given(scenarios(sides=(1, 5)), st.integers(0, 2**32 - 1))
def test_the_judge_agrees_with_one_that_draws_polygons(scenario, seed):
    plan = nonsense(with_start_times(scenario, seed, latest=4), seed)
    audit = th.audit_plan(plan, limit=10**6)
    found = [(c.kind, c.step, c.robots, c.cells) for c in audit.conflicts]
    assert sorted(found) == judge(plan)
    assert audit.conflict_count == len(found)
    assert [c.step for c in audit.conflicts] == sorted(c.step for c in audit.conflicts)


@settings(deadline=None)
@given(data=st.data(), tessellation=st.sampled_from(th.areas.TESSELLATIONS))
def test_what_is_wrong_before_the_first_step_is_found_at_step_0(data, tessellation):
    barriers = np.array(data.draw(st.lists(st.booleans(), min_size=20, max_size=20))).reshape(4, 5)
    cells = st.integers(0, 19)
    destinations = data.draw(st.lists(cells, min_size=1, max_size=3, unique=True))
    robots = data.draw(st.lists(cells, max_size=8))
    claim = Claim(th.Area(tessellation, barriers), np.array(destinations), np.array(robots, dtype=int))
    acts = data.draw(st.lists(st.integers(0, 2), min_size=len(robots), max_size=len(robots)))
    audit = th.audit_plan(plan_from_lists(claim, [[WAIT] * own for own in acts]), limit=1000)
    is_barrier = barriers.reshape(-1)
    expected = sorted(
        [("barrier", (), cell) for cell in destinations if is_barrier[cell]]
        + [("barrier", (robot,), cell) for robot, cell in enumerate(robots) if is_barrier[cell]]
        + [
            ("cell", (robots.index(cell), robot), cell)
            for robot, cell in enumerate(robots)
            if robots.index(cell) < robot
        ]
    )
    found = [one for one in audit.conflicts if one.step == 0 and one.kind in ("barrier", "cell")]
    assert sorted((one.kind, one.robots, one.cells[0][1] * 5 + one.cells[0][0]) for one in found) == expected
    assert audit.is_clean == (audit.conflict_count == 0) and audit.conflict_count >= len(expected)
    report = th.make_report(audit.plan, audit=audit)
    assert not expected or not report.optimal


def test_a_robot_parked_on_a_barrier_does_not_open_it():
    area = th.Area("square", [[0, 1, 0]])
    plan = plan_from_lists(Claim(area, [(2, 0)], [(1, 0), (0, 0)]), [[], [E, E]])
    assert [str(conflict) for conflict in th.audit_plan(plan).conflicts] == [
        "step 0: robot 0 starts on the barrier (1, 0)",
        "step 1: robots 0 and 1 are both in cell (1, 0)",
        "step 1: robot 1 moves from (0, 0) onto the barrier (1, 0)",
    ]


def test_nobody_plans_for_a_claim():
    claim = Claim(th.Area("square", [[0, 1, 0]]), [(2, 0)], [(1, 0)])
    with pytest.raises(th.ScenarioError, match=r"robot 0 must stand on a free cell; \(1, 0\) is a barrier"):
        th.make_plan(claim)
