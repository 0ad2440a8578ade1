"""The judge at work: a plan made by hand in which everything goes wrong, and what the audit says of it."""

import sys
from pathlib import Path

from examples.drawing import picture_of_step

import trihex as th
from trihex.kernels.codes import WAIT
from trihex.plans import plan_from_lists

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
N, E, S, W, NE, SE, SW, NW = range(8)
area = th.Area("square", [[0, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 0]])
robots = [(0, 0), (1, 0), (0, 1), (1, 1), (3, 2)]
scenario = th.Scenario(area, destinations=[(3, 0)], robots=robots)
actions = [
    [E, E, E],  # robot 0 exchanges cells with robot 1
    [W, E, E, E, WAIT],  # ... and waits after it has arrived
    [SE, E, NE, N],  # crosses the way of robot 3
    [SW, N, E, E],  # and goes on into the barrier
    [WAIT],  # stops before it has arrived
]
audit = th.audit_plan(plan_from_lists(scenario, actions))
print("clean" if audit.is_clean else f"{audit.conflict_count} conflicts")
for conflict in audit.conflicts:
    print(f"{conflict.kind:9} {conflict}")

found = [conflict for conflict in audit.conflicts if conflict.step == 1]
words = "; ".join(conflict.text for conflict in found)
picture_of_step(audit.plan, 1, {robot for one in found for robot in one.robots}, words).save(folder / "judge.png")
