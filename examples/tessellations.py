"""The same robots and barriers on triangles, hexagons and squares: a table of plans."""

import sys
from pathlib import Path

import trihex as th
from trihex.studies import on_tessellations

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
area = th.make_random_area("hexagonal", 20, 24, density=0.15, seed=1)
destination = [(12, 11)]
scenario = th.Scenario(area, destination, th.random_robots(area, 60, seed=1, avoid=destination))
scenarios = on_tessellations(scenario, ["triangular", "hexagonal", "square"])
rows = th.make_comparison(scenarios, ["greedy"]).rows()
print(f"{'tessellation':14}{'arrived':>8}{'steps':>7}{'total':>7}{'bound':>7}{'gap':>7}")
for row in rows:
    print("{tessellation:14}{arrived:8}{steps:7}{total_time:7}{reference:7}{gap:7.1%}".format(**row))
th.picture_of_plan(th.make_plan(scenarios[0], "greedy"), width=460).save(folder / "tessellations.png")
