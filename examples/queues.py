"""The sets of the paper, step by step: how many robots move, how many wait, how many have arrived."""

import sys
from pathlib import Path

import trihex as th

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
wall = [[x == 12 and y not in (7, 8) for x in range(24)] for y in range(16)]
area = th.Area("hexagonal", wall, "wall with a door")
robots = [(x, y) for x in range(5) for y in range(2, 14)]
plan = th.make_plan(th.Scenario(area, destinations=[(22, 8)], robots=robots), "greedy")
print("step  begin  filled  waiting  final")
for step in range(1, plan.steps + 1, 6):
    sets = plan.sets_at(step)
    print(f"{step:4} {sets.begin.size:6} {sets.filled.size:7} {sets.waiting.size:8} {sets.final.size:6}")
ax = th.draw_arrivals(plan)
ax.figure.savefig(folder / "queues.png", dpi=80)
