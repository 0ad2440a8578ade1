"""The judges of plans where doors have a flow: broken on purpose, and nonsense against the oracles."""

import pytest

import trihex as th
from tests.judging.test_audit import E, nonsense, squares
from tests.oracles import owners
from tests.oracles.rules import judge
from tests.oracles.timed import with_time
from tests.strategies import random_scenario, with_random_doors
from tests.sweeps import swept
from trihex.kernels.codes import WAIT

TIMES = [("steps", "allow"), ("costs", "allow"), ("costs", "forbid"), ("steps", "forbid")]


@pytest.mark.parametrize(
    ("plan", "told"),
    [
        (squares("aD", [[E]], doors=[([1], "1/2")]), "step 1: robot 0 is one too many to enter destination (1, 0)"),
        (squares("aD", [[WAIT, E]], doors=[([1], "1/2")]), None),
        (squares("a.D", [[E, E]], doors=[([1], "1/3")]), "step 1: robot 0 enters the door (1, 0) while it is shut"),
        (squares("a.D", [[WAIT, WAIT, E, WAIT, E]], doors=[([1], "1/3")]), None),  # it may stay in the door
        (squares("a.D", [[WAIT, E, E]], doors=[([1], "1/2")], following="forbid"), None),
        (
            squares("a.D", [[E, E]], doors=[([1], "1/7")], clock="costs"),
            "step 5: robot 0 enters the door (1, 0) while it is shut",
        ),
        (squares("a.D", [[WAIT, WAIT, E, E]], doors=[([1], "1/7")], clock="costs"), None),  # in tick 7 its move ends
    ],
)  # fmt: skip
def test_who_comes_when_a_door_is_shut_is_told(plan, told):
    assert [str(conflict) for conflict in th.audit_plan(plan).conflicts] == ([] if told is None else [told])


def test_nonsense_is_judged_as_by_the_oracles():
    found = 0
    for seed in range(swept(300, 60)):
        scenario = with_time(with_random_doors(random_scenario(seed, sides=(1, 5), most_filled=0.6)), *TIMES[seed % 4])
        plan = nonsense(scenario, seed)
        own = {(c.kind, c.step, c.robots, c.cells) for c in th.audit_plan(plan, limit=10**6).conflicts}
        told = set(judge(plan) if scenario.is_stepwise else owners.judge(plan))
        if scenario.is_stepwise:
            assert own == told, seed
        own, told = ({one for one in some if one[0] == "capacity"} for some in (own, told))
        assert own == told, seed
        found += len(own)
    assert found > swept(300, 60) // 6
