"""The same robots and barriers on triangles, hexagons and squares: a table of plans."""

import sys
from pathlib import Path

from examples.drawing import bare, in_a_row

import trihex as th
from trihex.studies import on_tessellations

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
area = th.make_random_area("hexagonal", 12, 12, density=0.15, seed=1)
destination = [(6, 6)]
scenario = th.Scenario(area, destination, th.random_robots(area, 20, seed=1, avoid=destination))
scenarios = on_tessellations(scenario, ["triangular", "hexagonal", "square"])
rows = th.make_comparison(scenarios, ["greedy"]).rows()
print(f"{'tessellation':14}{'arrived':>8}{'steps':>7}{'total':>7}{'bound':>7}{'gap':>7}")
for row in rows:
    print("{tessellation:14}{arrived:8}{steps:7}{total_time:7}{reference:7}{gap:7.1%}".format(**row))
pictures = []
for plan in (th.make_plan(scenario, "greedy") for scenario in scenarios):
    across, down = plan.scenario.area.tessellation.extent(area.height, area.width)
    picture = th.picture_of_plan(plan, width=round(400 * across / down))
    pictures.append(bare(picture, f"{plan.scenario.area.tessellation.name}, {plan.steps} steps"))
in_a_row(pictures).save(folder / "tessellations.png")
