"""Trial: events, sensing and delays, in worlds that fit in the head."""

import numpy as np
import pytest

import trihex as th
from trihex.areas import Zone
from trihex.kernels.codes import LATE
from trihex.running import ARRIVED, BROKEN, GOING, LEFT, Event, Trial, audit_run


def corridor(robots, cells=7, rows=1):
    area = th.Area("square", np.zeros((rows, cells), dtype=bool))
    return th.Scenario(area, [(cells - 1, 0)], robots)


def outcome(scenario, *events, **options):
    run = Trial(scenario, events=events, **options).run(most_steps=500)
    audit = audit_run(run)
    assert audit.is_clean, [str(conflict) for conflict in audit.conflicts]
    return run


def refusals(run):
    return [occurrence.refusal for occurrence in run.occurrences]


def test_without_events_or_fog_a_run_is_a_plan():
    run = outcome(corridor([(0, 0), (3, 0)]))
    assert run.time_of_robot.tolist() == [60, 30] and run.steps == 6 and run.total_time == 90
    assert run.ended.tolist() == [6, 3] and (run.known_since == 0).all() and not run.touched.any()


def test_a_late_robot_stands_and_those_behind_it_wait():
    run = outcome(corridor([(0, 0), (1, 0)]), Event(2, "late", robot=1, steps=3))
    assert run.actions[:, 1].tolist() == [1, LATE, LATE, LATE, 1, 1, 1, 1, 255]
    assert run.time_of_robot.tolist() == [90, 80]


def test_delays_come_by_chance_from_the_seed():
    runs = [outcome(corridor([(0, 0)], 40), delay=0.3, seed=seed) for seed in (1, 1, 2)]
    assert runs[0] == runs[1] and runs[0].steps != runs[2].steps
    late = np.count_nonzero(runs[0].actions == LATE)
    assert late > 3 and runs[0].steps == 39 + late


def test_a_door_that_closes_and_opens():
    run = outcome(corridor([(0, 0)]), Event(2, "barrier", cell=(4, 0)), Event(6, "clear", cell=(4, 0)))
    assert run.steps == 10 and run.arrived.all()  # waits in steps 2 to 5
    shut = outcome(corridor([(0, 0)]), Event(2, "barrier", cell=(4, 0)))
    assert not shut.arrived.any() and shut.cut_off_since.tolist() == [1] and shut.steps == 2


def test_a_robot_in_the_fog_walks_up_to_a_barrier_and_is_told_off_as_soon_as_it_is_seen():
    area = th.Area("square", [[0, 0, 0, 0, 1, 0, 0]])
    scenario = th.Scenario(area, [(6, 0)], [(0, 0)])
    knowing, unknowing = outcome(scenario), outcome(scenario, sensor=1)
    assert knowing.steps == 0 and knowing.cut_off_since.tolist() == [0]
    assert unknowing.steps == 4 and unknowing.cut_off_since.tolist() == [3]
    assert unknowing.known_since.tolist() == [[0, 0, 1, 2, 3, -1, -1]]
    assert outcome(scenario, sensor=2).steps == 3


def test_what_one_robot_sees_all_know():
    barriers = np.zeros((3, 9), dtype=bool)
    barriers[1:, 7] = True
    scenario = th.Scenario(th.Area("square", barriers), [(8, 2)], [(0, 2), (6, 2)])
    run = outcome(scenario, sensor=1)
    alone = outcome(scenario.with_robots([(0, 2)]), sensor=1)
    assert run.time_of_robot[0] < alone.time_of_robot[0]  # it need not walk into the corner itself


def test_a_barrier_out_of_sight_is_noticed_when_seen_one_that_goes_is_announced():
    hidden = outcome(corridor([(0, 0)], 9), Event(1, "barrier", cell=(6, 0)), sensor=2)
    assert hidden.cut_off_since.tolist() == [4]
    told = outcome(corridor([(0, 0)], 9), Event(1, "barrier", cell=(6, 0)), Event(6, "clear", cell=(6, 0)), sensor=2)
    assert told.arrived.all() and told.steps == 9


def test_destinations_open_close_and_move():
    run = outcome(corridor([(0, 0)]), Event(2, "move", cell=(6, 0), to=(0, 0)))
    assert run.steps == 2 and run.time_of_robot.tolist() == [20]
    run = outcome(corridor([(3, 0), (0, 0)]), Event(2, "open", cell=(4, 0)))
    assert run.ended.tolist() == [1, 4]  # robot 0 has arrived where it stands when step 2 begins
    run = outcome(corridor([(0, 0)]), Event(3, "close", cell=(6, 0)))
    assert run.state_of_robot.tolist() == [GOING] and run.cut_off_since.tolist() == [2]
    run = outcome(corridor([(0, 0)]), Event(3, "close", cell=(6, 0)), Event(5, "open", cell=(6, 0)))
    assert run.arrived.all() and run.steps == 8


def test_robots_join_leave_and_break_down():
    run = outcome(
        corridor([(0, 0), (2, 0), (5, 0)]),
        Event(2, "break", robot=1),
        Event(2, "join", cell=(5, 0)),
        Event(3, "leave", robot=0),
        Event(4, "clear", cell=(3, 0)),
    )
    assert run.state_of_robot.tolist() == [LEFT, BROKEN, ARRIVED, ARRIVED]
    assert run.joined.tolist() == [0, 0, 0, 1] and run.robots.tolist() == [0, 2, 5, 5]
    assert [cells.tolist() for cells in run.cells_by_step()][:3] == [[0, 2, 5, -1], [1, -1, -1, 5], [-1, -1, -1, -1]]


def test_cells_by_step_show_who_is_in_the_area():
    run = outcome(corridor([(0, 0), (5, 0)]), Event(2, "join", cell=(5, 0)))
    assert [cells.tolist() for cells in run.cells_by_step()][:3] == [[0, 5, -1], [1, -1, 5], [2, -1, -1]]


@pytest.mark.parametrize(
    ("event", "why"),
    [
        (Event(1, "barrier", cell=(2, 0)), "robot 1 stands at (2, 0)"),
        (Event(1, "barrier", cell=(6, 0)), "(6, 0) is a destination, close it first"),
        (Event(1, "barrier", cell=(0, 1)), "(0, 1) is a barrier already"),
        (Event(1, "barrier", cell=(7, 0)), "(7, 0) lies outside the area"),
        (Event(1, "clear", cell=(3, 0)), "(3, 0) is no barrier"),
        (Event(1, "open", cell=(0, 1)), "(0, 1) is a barrier"),
        (Event(1, "open", cell=(6, 0)), "(6, 0) is a destination already"),
        (Event(1, "close", cell=(3, 0)), "(3, 0) is no destination"),
        (Event(1, "move", cell=(6, 0), to=(0, 1)), "(0, 1) is a barrier"),
        (Event(1, "join", cell=(2, 0)), "a robot must join on an empty cell; robot 1 stands at (2, 0)"),
        (Event(1, "join", cell=(0, 1)), "a robot must join on a free cell; (0, 1) is a barrier"),
        (Event(1, "leave", robot=9), "robot must be one of 0..1, not 9"),
        (Event(5, "break", robot=1), "robot 1 is not on its way: it has arrived"),
        (Event(5, "late", robot=1, steps=2), "robot 1 is not on its way: it has arrived"),
    ],
)
def test_what_cannot_happen_is_refused_with_a_reason_and_changes_nothing(event, why):
    barriers = np.zeros((2, 7), dtype=bool)
    barriers[1] = True
    scenario = th.Scenario(th.Area("square", barriers), [(6, 0)], [(0, 0), (2, 0)])
    for sensor in (None, 2):
        run, calm = outcome(scenario, event, sensor=sensor), outcome(scenario, sensor=sensor)
        assert refusals(run) == [why] and str(run.occurrences[0]).endswith(f"refused: {why}")
        assert np.array_equal(run.actions, calm.actions)


def test_events_can_be_told_while_robots_run():
    trial = Trial(corridor([(0, 0)]))
    trial.step()
    trial.tell(Event(1, "barrier", cell=(2, 0)))
    trial.tell(Event(5, "clear", cell=(2, 0)))
    run = trial.run()
    assert [occurrence.event.step for occurrence in run.occurrences] == [2, 5] and run.steps == 9
    assert audit_run(run).is_clean


def halls(robots):
    """Two rows and two exits at the ends."""
    zones = Zone("west", [0, 9]), Zone("east door", [8, 17]), Zone("middle", [4, 13])
    return th.Scenario(th.Area("square", np.zeros((2, 9), dtype=bool), zones=zones), [0, 9, 8, 17], robots)


def test_an_exit_is_closed_and_opened_by_its_name():
    calm = outcome(halls([(2, 0), (3, 1)]))
    assert calm.arrivals_of_exit == {"west": 2, "east door": 0, "middle": 0}
    run = outcome(halls([(2, 0), (3, 1)]), Event(2, "close", zone="west"))
    assert run.arrivals_of_exit == {"west": 0, "east door": 2, "middle": 0} and run.occurrences[0].closed == (0, 9)
    run = outcome(halls([(2, 0), (3, 1)]), Event(2, "close", zone="west"), Event(3, "open", zone="west"))
    assert run.arrivals_of_exit["west"] == 2 and run.occurrences[1].opened == (0, 9)
    assert str(run.occurrences[1]) == "step 3: destination opens at 'west'"


def test_a_zone_becomes_a_barrier_but_where_robots_stand():
    run = outcome(halls([(3, 0), (4, 1)]), Event(1, "close", zone="west"), Event(1, "barrier", zone="middle"))
    assert run.occurrences[1].blocked == (4,) and run.occurrences[1].left_out == (13,) and run.arrived.all()
    run = outcome(halls([(2, 0)]), Event(1, "barrier", zone="west"))  # what was an exit is none
    assert run.occurrences[0].closed == run.occurrences[0].blocked == (0, 9) and run.arrivals_of_exit["east door"] == 1
    run = outcome(halls([(3, 0)]), Event(1, "barrier", zone="middle"), Event(2, "clear", zone="middle"))
    assert run.occurrences[1].freed == (4, 13)


def test_why_nothing_can_happen_to_a_zone():
    for kind, zone, why in (
        ("close", "middle", "no cell of 'middle' is a destination"),
        ("open", "west", "no cell of 'west' is free and no destination yet"),
        ("clear", "west", "no cell of 'west' is a barrier"),
        ("close", "est door", "zone must be one of west, east door, middle, not 'est door'; did you mean 'east door'?"),
    ):
        assert refusals(outcome(halls([(2, 0)]), Event(1, kind, zone=zone))) == [why]
    assert refusals(outcome(corridor([(0, 0)]), Event(1, "close", zone="a"))) == [
        "zone 'a' does not exist: the area has none"
    ]


def test_events_that_make_no_sense_and_wrong_delays():
    for wrong, why in (
        (dict(step=0, kind="join", cell=(0, 0)), "step of an event must be a whole number from 1"),
        (dict(step=1, kind="jon", cell=(0, 0)), "did you mean 'join'"),
        (dict(step=1, kind="join"), r"event 'join' at step 1 takes cell \(or metres\), not cell=None"),
        (dict(step=1, kind="leave", robot=1, cell=(0, 0)), "takes robot, not cell="),
        (
            dict(step=1, kind="close", cell=(0, 0), zone="a"),
            r"'close' at step 1 takes cell or zone \(or metres\), not zone='a'",
        ),
        (dict(step=1, kind="join", zone="a"), r"takes cell \(or metres\), not zone='a'"),
        (dict(step=1, kind="close", zone="a\nb"), "name of a zone must be a line"),
        (dict(step=1, kind="late", robot=1, steps=0), "steps of an event"),
        (dict(step=1, kind="join", cell=(0.5, 0)), "cell of an event must be"),
    ):
        with pytest.raises(th.ScenarioError, match=why):
            Event(**wrong)
    with pytest.raises(th.ExecutionError, match="delay must be a number from 0 to below 1"):
        Trial(corridor([(0, 0)]), delay=1.0)


def test_what_is_caught_up_with_happens_before_the_next_step_and_changes_nothing_else():
    scenario = corridor([(0, 0), (1, 0)], rows=2)
    events = [Event(2, "barrier", cell=(4, 0)), Event(2, "leave", robot=1), Event(3, "join", cell=(0, 1))]
    hasty, patient = Trial(scenario, events=events), Trial(scenario, events=events)
    while not patient.is_over:
        hasty.catch_up()
        hasty.step()
        patient.step()
    assert hasty.record() == patient.record() and hasty.repairs == patient.repairs == (1, 10)
    # What happens after the last step is part of the run as well.
    for kind, cell in (("barrier", (2, 0)), ("clear", (2, 0)), ("join", (2, 0)), ("close", (6, 0))):
        hasty.tell(Event(1, kind, cell=cell))
    hasty.catch_up()
    run = hasty.record()
    assert [str(one) for one in run.occurrences[-2:]] == [
        f"step {run.steps + 1}: robot joins at (2, 0)",
        f"step {run.steps + 1}: destination closes at (6, 0)",
    ]
    assert audit_run(run).is_clean and not run.last_world[1].size and run.last_world[0][0, 4]
    assert run.state_of_robot.tolist() == [ARRIVED, LEFT, ARRIVED, GOING]
    assert hasty.barriers.sum() == 1 and not hasty.destinations.size and hasty.known.all()


def test_the_worlds_of_a_run_are_those_of_its_steps():
    door = Event(2, "barrier", cell=(3, 0)), Event(4, "clear", cell=(3, 0))
    events = [*door, Event(4, "move", cell=(6, 0), to=(5, 0))]
    run = Trial(corridor([(0, 0)]), events=events).run()
    worlds = [(barriers[0, 3], ends.tolist()) for barriers, ends in list(run.worlds())]
    assert worlds == [(False, [6]), (True, [6]), (True, [6]), *[(False, [5])] * (run.steps - 3)]
    assert run.last_world[0].sum() == 0 and run.last_world[1].tolist() == [5]
