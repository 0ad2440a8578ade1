"""Plans with dependencies as files: by the schema, executed by what reads nothing else, and as orders of VDA 5050."""

import json
import subprocess
import sys
from functools import cache
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from click.testing import CliRunner
from examples.executor import Execution

import trihex as th
from tests.oracles.closest import closest
from tests.oracles.continuous import contacts_between_robots, read_waypoints
from tests.oracles.executions import crowded_plan, holding, is_contact, paces, tally_of, without, written
from tests.strategies import SHAPES
from tests.sweeps import swept
from trihex.cli import main
from trihex.errors import AreaError, FormatError, PlanError
from trihex.plans import plan_from_lists

ROOT = Path(__file__).parents[2]
SCHEMAS = ROOT / "docs" / "schemas"
EXECUTOR = ROOT / "examples" / "executor.py"


@cache
def validator(name):
    """Return what raises unless a document is as its schema says."""
    schema = json.loads((SCHEMAS / name).read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def check(document, name):
    validator(name).validate(document)


def ring_plan():
    """Return a plan in which four robots go round at once."""
    area = th.Area(th.Tessellation("square", "edge"), np.zeros((2, 4)), frame=th.Frame(1.0))
    scenario = th.Scenario(area, [(3, 0)], [(0, 0), (1, 0), (1, 1), (0, 1)], following="allow")
    names = area.tessellation.direction_names[0]
    return plan_from_lists(scenario, [[names.index(name)] for name in "ESWN"])


@pytest.mark.parametrize("shape", SHAPES)
def test_executions_at_any_speed_never_touch_and_all_arrive_and_no_dependency_is_too_many(shape):
    tally = tally_of(shape, swept(100, 8), swept(20, 3))
    assert (tally.contacts, tally.stuck) == (0, 0)
    assert tally.contacts_without + tally.vertices_without == tally.taken_out > 5
    assert tally.contacts_without > 0.8 * tally.taken_out
    least = th.areas.clearance.least_distance(th.Tessellation(*shape, "euclidean"), following="forbid")
    assert tally.nearest == pytest.approx(least, abs=1e-5)


@pytest.mark.parametrize("shape", SHAPES)
def test_plans_in_which_robots_follow_are_executed_where_they_have_no_ring(shape):
    executed = 0
    for seed in range(swept(40, 6)):
        plan = written(crowded_plan(shape, seed, "allow"))
        execution = Execution(plan, paces(seed)).run()
        assert not is_contact(plan, execution.tracks)
        assert bool(execution.stuck()) == bool(plan["rings"])
        executed += not plan["rings"]
    assert executed > 2


def test_the_judge_in_continuous_space_finds_the_same():
    seen = 0
    for seed in range(swept(30, 6)):
        plan = written(crowded_plan(SHAPES[seed % len(SHAPES)], 4 * seed + 3))
        less, first = without(plan, 0), plan["dependencies"][0]
        for one, pace in (
            (plan, paces(seed)),
            (less, holding(first, 0.0)),
            (less, holding(first, 0.5)),
        ):
            tracks = Execution(one, pace).run().tracks
            if len(tracks) > 40:
                continue
            found = contacts_between_robots(dict(enumerate(map(np.array, tracks))), plan["robot_radius"])
            assert bool(found) == is_contact(plan, tracks)
            assert one is not plan or not found
            seen += bool(found)
    assert seen > 0


def test_nearest_robots_by_hand():
    tracks = [[(0, 0, 0), (2, 2, 0)], [(0, 2, 1), (2, 0, 1)], [(3, 0, 0), (4, 0, 0)]]
    assert closest(tracks) == (1.0, 1.0, 0, 1)
    assert closest([*tracks, [(0, 0, 0.5), (4, 0, 0.5)]])[0] == 0.5
    assert closest(tracks[1:])[0] == np.inf


@pytest.mark.parametrize("in_metres", [False, True])
def test_a_file_is_as_its_schema_says_and_holds_the_plan(tmp_path, in_metres):
    frame = th.Frame(0.5, origin=(3.0, -2.0), yaw=0.3, robot_radius=0.2) if in_metres else None
    area = th.Area("hexagonal", [[0, 0, 0, 1, 0], [0, 0, 0, 1, 0]], frame=frame)
    scenario = th.Scenario(area, [(2, 0)], [(0, 0), (1, 0), (0, 1), (4, 0), (2, 0)], following="forbid")
    plan, path = th.make_plan(scenario), tmp_path / "plan.dependencies.json"
    th.write_dependencies(plan, path, speed=0.25)
    document = json.loads(path.read_text())
    check(document, "dependencies.schema.json")
    assert document["unit"] == ("metres" if in_metres else "edge steps")
    assert document["seconds_per_step"] == (2.0 if in_metres else 4.0)
    assert [robot["arrives"] for robot in document["robots"]] == [True, True, True, False, True]
    world = frame or th.Frame(1.0)
    for robot, own in enumerate(document["robots"]):
        cells = plan.cells_of_robot(robot)
        ticks = plan.ticks_of_robot(robot)
        moved = [0, *(np.flatnonzero(np.diff(cells)) + 1).tolist()]
        rows = [(point["x"], point["y"]) for point in own["waypoints"]]
        places = [world.centre_of_cell(area.tessellation, *area.cell_to_xy(cells[i])) for i in moved]
        assert [point["cell"] for point in own["waypoints"]] == [[int(cells[i]) % 5, int(cells[i]) // 5] for i in moved]
        assert np.allclose(rows, np.reshape(places, (-1, 2)), atol=1e-6)
        assert [point["earliest"] for point in own["waypoints"]] == [
            ticks[i] * document["seconds_per_step"] for i in moved
        ]
        for (x, y), (to_x, to_y), point in zip(rows, rows[1:], own["waypoints"], strict=False):
            assert point["yaw"] == pytest.approx(np.arctan2(to_y - y, to_x - x), abs=1e-5)


def test_the_executor_runs_alone(tmp_path):
    plan = crowded_plan(("hexagonal", "full"), 4)
    th.write_plan(plan, tmp_path / "plan.npz")
    done = CliRunner().invoke(main, ["convert", str(tmp_path / "plan.npz"), str(tmp_path / "plan.dependencies.json")])
    assert (done.exit_code, done.stderr) == (0, "")
    assert "trihex" not in "".join(line for line in EXECUTOR.read_text().splitlines() if "import" in line)
    assert len(EXECUTOR.read_text().splitlines()) <= 150
    command = [sys.executable, "-I", EXECUTOR, "plan.dependencies.json", "--seed", "3", "--tracks", "tracks.csv"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
    arriving = np.count_nonzero(plan.arrived)
    assert done.stdout.count("arrives after") == arriving
    assert done.stdout.endswith(f"{arriving} of {plan.arrived.size} robots arrive\n")
    tracks = read_waypoints(tmp_path / "tracks.csv")
    assert closest(list(tracks.values()))[0] >= 2 * plan.scenario.area.frame.robot_radius - 1e-5


@pytest.mark.parametrize(
    "text", [None, "no JSON", "{}", "[]", '{"format": "trihex plan with dependencies", "version": 2}']
)
def test_the_executor_refuses_other_files(tmp_path, text):
    if text is not None:
        (tmp_path / "it").write_text(text)
    done = subprocess.run([sys.executable, EXECUTOR, "it"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 2 and "must be a plan with dependencies" in done.stderr and "Trace" not in done.stderr


def test_a_ring_needs_a_clock(tmp_path):
    plan = ring_plan()
    th.write_dependencies(plan, tmp_path / "ring.dependencies.json")
    document = json.loads((tmp_path / "ring.dependencies.json").read_text())
    check(document, "dependencies.schema.json")
    assert document["rings"] == [[[0, 1], [1, 1], [2, 1], [3, 1]]]
    command = [sys.executable, EXECUTOR, "ring.dependencies.json"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 1 and "robot 0 may not leave for waypoint 1: robot 1 does not reach its 1" in done.stdout
    with pytest.raises(FormatError, match=r"orders know no common clock, and robots 0, 1, 2, 3 all move at once"):
        th.write_dependencies(plan, tmp_path / "ring.vda5050.json")


class Vehicle:
    """A vehicle as VDA 5050 has it: it takes orders and updates, drives along its base, and tells how far it is."""

    def __init__(self):
        self.order_id, self.update, self.nodes, self.edges, self.at = None, -1, {}, {}, -1

    def take(self, order):
        nodes = {node["sequenceId"]: node for node in order["nodes"]}
        edges = {edge["sequenceId"]: edge for edge in order["edges"]}
        numbers = sorted([*nodes, *edges])
        assert numbers == list(range(min(nodes), max(nodes) + 1))  # nodes and edges by turns, a node at either end
        for number, edge in edges.items():
            assert (
                edge["startNodeId"] == nodes[number - 1]["nodeId"] and edge["endNodeId"] == nodes[number + 1]["nodeId"]
            )
        released = [(nodes | edges)[number]["released"] for number in numbers]
        assert released == sorted(released, reverse=True) and released[0]  # a base, then a horizon
        if self.order_id is None:
            assert order["orderUpdateId"] == 0 and numbers[0] == 0
            self.at = 0
        else:  # begins at the end of the base, and its ids are those of the horizon
            assert order["orderId"] == self.order_id and order["orderUpdateId"] == self.update + 1
            assert numbers[0] == max(number for number, node in self.nodes.items() if node["released"])
            shared = [n for n in nodes if n in self.nodes]
            assert all(nodes[n]["nodeId"] == self.nodes[n]["nodeId"] for n in shared)
        self.order_id, self.update = order["orderId"], order["orderUpdateId"]
        self.nodes = {n: node for n, node in self.nodes.items() if node["released"]} | nodes

    def may_drive(self):
        """Whether the base reaches beyond where it is."""
        return self.nodes.get(self.at + 2, {"released": False})["released"]


@pytest.mark.parametrize("shape", SHAPES)
def test_orders_of_vda5050_are_valid_and_lead_all_vehicles_home(tmp_path, shape):
    for seed in range(swept(20, 3)):
        plan = crowded_plan(shape, seed)
        th.write_dependencies(plan, tmp_path / "plan.vda5050.json", speed=0.5)
        messages = json.loads((tmp_path / "plan.vda5050.json").read_text())["messages"]
        for message in messages:
            check(message["order"], "vda5050_order.schema.json")
        document = written(plan)
        rng = np.random.default_rng(seed)
        queues = {robot: [m for m in messages if m["robot"] == robot] for robot in {m["robot"] for m in messages}}
        vehicles = {robot: Vehicle() for robot in queues}
        needed = {}
        for robot, waypoint, other, reached in document["dependencies"]:
            needed.setdefault((robot, waypoint), []).append((other, reached))
        while True:
            moved = False
            for robot in rng.permutation(list(vehicles)).tolist():
                queue, vehicle = queues[robot], vehicles[robot]
                if queue and all(vehicles[one["robot"]].at >= one["lastNodeSequenceId"] for one in queue[0]["after"]):
                    vehicle.take(queue.pop(0)["order"])
                    moved = True
                moved |= vehicle.may_drive()
                if vehicle.may_drive() and rng.random() < 0.7:
                    vehicle.at += 2
                    for other, reached in needed.get((robot, vehicle.at // 2), ()):
                        assert vehicles[other].at >= 2 * reached
            if not moved and all(not queue for queue in queues.values()):
                break
        for robot, vehicle in vehicles.items():
            points = document["robots"][robot]["waypoints"]
            assert vehicle.at == 2 * (len(points) - 1)
            for number, node in vehicle.nodes.items():
                point = points[number // 2]
                assert node["nodeId"] == "cell_{}_{}".format(*point["cell"])
                assert (node["nodePosition"]["x"], node["nodePosition"]["y"]) == (point["x"], point["y"])
        assert {robot for robot, own in enumerate(document["robots"]) if len(own["waypoints"]) > 1} == set(vehicles)


def test_mistakes(tmp_path):
    scenario = th.Scenario(th.Area("square", [[0, 0, 0]]), [(2, 0)], [(0, 0), (1, 0)])
    plan = th.make_plan(scenario)
    with pytest.raises(AreaError, match="measured in cells, not in metres"):
        th.write_dependencies(plan, tmp_path / "plan.vda5050.json")
    with pytest.raises(FormatError, match=r"speed must be above 0 metres in a second, not 0"):
        th.write_dependencies(plan, tmp_path / "plan.dependencies.json", speed=0)
    with pytest.raises(FormatError, match=r"speed must be above 0 metres in a second, not -1"):
        th.write_dependencies(plan, tmp_path / "plan.dependencies.json", speed=-1)
    with pytest.raises(FormatError, match=r"the suffix of dependencies must be one of \.dependencies\.json, \.vda5050"):
        th.write_dependencies(plan, tmp_path / "plan.json")
    with pytest.raises(
        PlanError, match=r"dependencies need a safe plan; up to step 1 robots 1 and 0 are both in \(1, 0\)"
    ):
        th.write_dependencies(plan_from_lists(scenario, [[1], []]), tmp_path / "plan.dependencies.json")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["plan.dependencies.json", "plan.vda5050.json"])
def test_the_same_plan_gives_the_same_bytes(tmp_path, name):
    plan = crowded_plan(("triangular", "full"), 1)
    for folder in "ab":
        (tmp_path / folder).mkdir()
        th.write_dependencies(plan, tmp_path / folder / name)
    one, other = ((tmp_path / folder / name).read_bytes() for folder in "ab")
    assert one == other and one.count(b"\n") > 10
