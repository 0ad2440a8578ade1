"""A distance field for a game: one array tells every unit on the map where to go next."""

import sys
from pathlib import Path

import numpy as np

import trihex as th

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
area = th.make_rooms_area("hexagonal", 26, 35, room=8, seed=3)
n_scheme = th.make_n_scheme(th.Scenario(area, destinations=[(30, 22), (3, 3)]))
d_scheme = th.make_d_scheme(n_scheme)
print("distance of every cell:", n_scheme.distance.shape, n_scheme.distance.dtype)
print("a unit on (12, 20) is", n_scheme.distance[20, 12], "away; best moves:", *d_scheme.names_of_cell(20 * 35 + 12))

# All units at once: the lowest bit that is set is a best direction, its step depends on the column of the unit.
units = th.random_robots(area, 500, seed=1)
bits = d_scheme.directions.reshape(-1)[units]
moving = bits > 0
direction = np.log2(bits[moving] & -bits[moving].astype(np.int32)).astype(int)
x, y = area.cell_to_xy(units[moving])
dx, dy = area.tessellation.step_of_direction[area.tessellation.orientation_of_cell(x, y), direction].T
after = n_scheme.distance_of_cell(area.xy_to_cell(x + dx, y + dy))
print("500 units, one step: all that move come nearer:", bool((after < n_scheme.distance_of_cell(units[moving])).all()))
th.picture_of_n_scheme(n_scheme, width=460).save(folder / "distance_field.png")
