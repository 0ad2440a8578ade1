"""Many random runs with events, sensing radii and delays: they end, no rule is broken, all arrive who can.

``TRIHEX_SWEEPS=7 pytest tests/properties/test_many_runs.py`` runs 2100 of them.
"""

import numpy as np
import pytest

from tests.running.random_runs import random_trial
from tests.sweeps import swept
from trihex.running import GOING, audit_run, resume_trial

COUNT = swept(300)
SHARES, MOST_STEPS = 4, 5000


@pytest.mark.parametrize("share", range(SHARES))
def test_every_run_ends_safely_and_leaves_nobody_behind(share):
    for seed in range(share, COUNT, SHARES):
        run = random_trial(seed, has_start_times=seed % 3 == 0).run(most_steps=MOST_STEPS)
        assert run.steps < MOST_STEPS, seed
        audit = audit_run(run)
        assert audit.is_clean, (seed, [str(conflict) for conflict in audit.conflicts])
        still_going = np.flatnonzero(run.state_of_robot == GOING)
        assert np.array_equal(np.flatnonzero(run.cut_off_since >= 0), still_going), seed


@pytest.mark.parametrize("share", range(SHARES))
def test_the_same_trial_gives_the_same_run_also_after_a_stop(share):
    for seed in range(share, COUNT // 10, SHARES):
        late = {"has_start_times": seed % 3 == 0}
        run = random_trial(seed, **late).run()
        if seed % 5 == 0:  # it follows plans, and makes a new one after a stop
            assert random_trial(seed, **late).run() == run, seed
            continue
        again, events = random_trial(seed, **late), [occurrence.event for occurrence in run.occurrences]
        stopped = again.run(most_steps=seed % 23)
        resumed = resume_trial(stopped, events[len(stopped.occurrences) :], aside=again.execution.aside)
        assert resumed.run() == run == again.run(), seed
