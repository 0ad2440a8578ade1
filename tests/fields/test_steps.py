"""Steps to the nearest destination, whatever they cost."""

import numpy as np

import trihex as th
from trihex.fields import steps_to_destination


def test_steps_to_the_nearest_destination():
    area = th.Area("hexagonal", [[False, False, False, True, False]])
    scenario = th.Scenario(area, [(0, 0)])
    steps = steps_to_destination(scenario)
    assert steps[area.layout.cell_to_site(np.arange(5))].tolist() == [0, 1, 2, -1, -1]
    assert not steps.flags.writeable
