"""Random trials: scenario, events, sensor and delays, all drawn from one number."""

from dataclasses import replace

import numpy as np

from tests.oracles.timed import with_time
from tests.strategies import random_scenario, with_start_times
from trihex.areas import Frame, Zone
from trihex.running import KINDS, OF_SHAPES, OF_ZONES, Event, Sensor, Trial

LAST_STEP = 40
RADII = (None, 0, 1, 2.5, 3, 5)
DELAYS = (0.0, 0.05, 0.1, 0.2, 0.3)


def random_events(rng, scenario, count):
    """Return events of all kinds; many of them cannot happen."""
    area, events = scenario.area, []

    def place():
        if rng.random() < 0.4:
            cell = int(rng.choice(scenario.destinations))
            return cell % area.width, cell // area.width
        return int(rng.integers(area.width)), int(rng.integers(area.height))

    for _ in range(count):
        kind = list(KINDS)[rng.integers(len(KINDS))]
        most = {"robot": max(1, scenario.robot_count), "steps": 8}
        details = {n: place() if n in ("cell", "to") else int(rng.integers(most[n])) for n in KINDS[kind]}
        if "steps" in details:
            details["steps"] += 1
        if kind in OF_ZONES and rng.random() < 0.3:
            details = {"zone": ("west", "odd, cells", "nowhere")[rng.integers(3)]}
        if area.frame is not None and "cell" in details and rng.random() < 0.5:
            x, y = area.metres.centre_of_cell(area.tessellation, *details.pop("cell"))
            points = rng.normal([x, y], 0.4, (int(rng.integers(1, 4)) if kind in OF_SHAPES else 1, 2))
            details["metres"] = points.tolist()
        events.append(Event(int(rng.integers(1, LAST_STEP)), kind, **details))
    return events


def random_trial(seed, time=("steps", "allow"), *, has_start_times=False, **limits):
    """Return a trial; what robots see, what happens and who is late as the number says, `time` the clock and rule."""
    rng = np.random.default_rng([seed, 9])
    scenario = random_scenario(seed, **{"sides": (3, 16), **limits})
    cells = np.arange(scenario.area.cell_count)
    zones = Zone("west", cells[cells % scenario.area.width < 2]), Zone("odd, cells", cells[1::4])
    frame = Frame(0.8, (3.0, -2.0), 0.3) if seed % 2 else None
    scenario = replace(scenario, area=replace(scenario.area, zones=zones, frame=frame))
    if time != ("steps", "allow"):
        scenario = with_time(scenario, *time)
    if has_start_times:
        scenario = with_start_times(scenario, seed)
    radius = RADII[rng.integers(len(RADII))]
    return Trial(
        scenario,
        ("fcost", "greedy")[rng.integers(2)],
        aside=("always", "worth", "never")[rng.integers(3)],
        replan=seed % 5 == 0,
        sensor=None if radius is None else Sensor(scenario.area.tessellation, radius, bool(rng.integers(2))),
        events=random_events(rng, scenario, int(rng.integers(25))),
        delay=DELAYS[rng.integers(len(DELAYS))],
        seed=seed,
    )
