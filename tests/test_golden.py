"""The optimum of 20 scenarios on generated areas, frozen: ``python -m tests.test_golden`` writes them anew."""

import json
from itertools import product
from pathlib import Path

import pytest

import trihex as th
from trihex.areas import GENERATORS
from trihex.planners import make_plan

FILE = Path(__file__).parent / "golden" / "optimal.json"
KINDS = ("random", "rooms", "maze", "caves", "warehouse")
TESSELLATIONS = ("triangular", "hexagonal", "square")


def scenarios():
    """Yield a name and a scenario: five kinds of area by tessellation and crossing."""
    for number, (kind, (name, crossing)) in enumerate(
        product(KINDS, [*product(TESSELLATIONS, ["forbid"]), ("triangular", "allow")])
    ):
        area = GENERATORS[kind](name, 24, 24, seed=number)
        inside = th.random_robots(area, min(121, area.free_count // 2), seed=number)
        lone = th.Scenario(area, inside[:1], inside[1:], crossing=crossing)
        cut_off = set(th.make_n_scheme(lone).unreachable_robots.tolist())
        robots = [robot for i, robot in enumerate(inside[1:].tolist()) if i not in cut_off]
        yield (
            f"{kind} {name} {crossing}",
            th.Scenario(area, inside[:1], robots, crossing=crossing, destination_capacity=(None, 2)[number % 2]),
        )


def figures(scenario):
    plan, steps = make_plan(scenario, "optimal"), make_plan(scenario, "optimal", objective="steps")
    assert plan.optimal
    assert th.audit_plan(plan).is_clean
    return {
        "robots": scenario.robot_count,
        "total_time": int(plan.total_time),
        "sum_of_steps": int(steps.arrival_step_of_robot.sum()),
        "makespan": int(steps.steps),
    }


@pytest.mark.parametrize(
    ("name", "scenario"), list(scenarios()), ids=lambda value: value if isinstance(value, str) else ""
)
def test_the_optimum_is_what_it_was(name, scenario):
    assert figures(scenario) == json.loads(FILE.read_text())[name]


if __name__ == "__main__":
    FILE.write_text(json.dumps({name: figures(scenario) for name, scenario in scenarios()}, indent=1) + "\n")
