import builtins
import sys

import numpy as np
import pytest
from PIL import Image

import trihex as th
from trihex.areas import TESSELLATIONS, Area, Frame, Scenario, random_robots
from trihex.errors import FormatError, MissingExtraError, PlanError
from trihex.kernels.codes import JUMP, WAIT
from trihex.pictures import palette, picture_of_area, write_animation
from trihex.pictures.movie import PlanFilm
from trihex.pictures.run_movie import RunFilm
from trihex.pictures.scene import Bar
from trihex.plans import Plan, plan_from_lists

BARE = {"title": "", "clock": False, "legend": False}


def frames_of(path) -> list[np.ndarray]:
    with Image.open(path) as image:
        frames = []
        for number in range(image.n_frames):
            image.seek(number)
            frames.append(np.array(image.convert("RGB")))
        return frames


def wandering_plan(name: str, robots: int = 40, steps: int = 6) -> Plan:
    """Robots that wander at random, some of them waiting, none of them arriving; they may collide."""
    area = Area(name, np.zeros((12, 13)), "field")
    scenario = Scenario(area, [(12, 11)], random_robots(area, robots, seed=1, avoid=[(12, 11)]))
    rng = np.random.default_rng(2)
    actions = []
    for cell in scenario.robots.tolist():
        own = []
        x, y = cell % 13, cell // 13
        for _ in range(steps):
            k = int(rng.integers(area.tessellation.direction_count))
            orientation = int(area.tessellation.orientation_of_cell(x, y))
            dx, dy = area.tessellation.step_of_direction[orientation, k].tolist()
            is_inside = 0 <= x + dx < 13 and 0 <= y + dy < 12 and (x + dx, y + dy) != (12, 11)
            own.append(k if is_inside and rng.random() < 0.7 else WAIT)
            x, y = (x + dx, y + dy) if own[-1] != WAIT else (x, y)
        actions.append(own)
    return plan_from_lists(scenario, actions)


def corridor_plan() -> Plan:
    """Robot 0 arrives in step 2, robot 1 waits and arrives in step 5, robot 2 is walled in."""
    barriers = np.zeros((1, 9), dtype=bool)
    barriers[0, 7] = True
    area = Area("square", barriers, "corridor")
    scenario = Scenario(area, [(0, 0)], [(2, 0), (4, 0), (8, 0)])
    west = area.tessellation.direction_names[0].index("W")
    return plan_from_lists(scenario, [[west, west], [WAIT, west, west, west, west], []], planner="hand")


def colours_of_corridor(frame: np.ndarray) -> str:
    """The colour at the upper edge of the robots of each of the 9 cells of 40 pixels, as a letter."""
    letters = {
        palette.FREE: ".",
        palette.BARRIER: "B",
        palette.DESTINATION: "D",
        palette.MOVING: "m",
        palette.WAITING: "w",
        palette.FINAL: "f",
        palette.STRANDED: "s",
    }
    return "".join(letters[tuple(frame[8, 20 + 40 * x].tolist())] for x in range(9))


def test_robots_are_coloured_by_their_sets(tmp_path):
    write_animation(corridor_plan(), tmp_path / "a.gif", width=360, max_frames=6, **BARE)
    assert [colours_of_corridor(frame) for frame in frames_of(tmp_path / "a.gif")] == [
        "D.m.w..Bs",
        "Dm..m..Bs",
        "f..m...Bs",
        "D.m....Bs",
        "Dm.....Bs",
        "f......Bs",
    ]


def test_short_plans_glide_and_long_ones_skip(tmp_path):
    plan = corridor_plan()
    progress: list[tuple[int, int]] = []
    write_animation(plan, tmp_path / "a.gif", width=360, **BARE, progress=lambda done, of: progress.append((done, of)))
    frames = frames_of(tmp_path / "a.gif")
    assert len(frames) == 5 * 8 + 1
    assert progress == [(number + 1, 41) for number in range(41)]
    # Robot 0 leaves cell 2 and enters cell 1: the middle of its disc is half-way after four of eight frames.
    blue = np.flatnonzero((frames[4][8, :160] == palette.MOVING).all(axis=1))
    assert abs(blue.mean() - 79.5) < 1.5
    write_animation(plan, tmp_path / "b.gif", width=360, max_frames=3, **BARE)
    assert [colours_of_corridor(frame) for frame in frames_of(tmp_path / "b.gif")] == [
        "D.m.w..Bs",
        "f.m....Bs",  # whoever arrived since the frame before is shown
        "f......Bs",
    ]


@pytest.mark.parametrize(("max_frames", "ticks"), [(60, [tick / 2 for tick in range(55)]), (8, [*range(0, 27, 4), 27])])
def test_robots_are_between_centres_while_a_move_lasts(tmp_path, max_frames, ticks):
    """Robot 0 moves from tick 0 to 5 and 5 to 10, robot 1 waits till 2 and moves from 2 to 7, 7 to 12 and on."""
    area = Area("square", np.zeros((1, 9)), "corridor")
    scenario = Scenario(area, [(0, 0)], [(2, 0), (5, 0)], clock="costs")
    plan = plan_from_lists(scenario, [[3, 3], [WAIT, WAIT, 3, 3, 3, 3, 3]])
    write_animation(plan, tmp_path / "a.gif", width=360, max_frames=max_frames, **BARE)
    frames = frames_of(tmp_path / "a.gif")
    assert len(frames) == len(ticks)
    for tick, frame in zip(ticks, frames, strict=True):
        blue = np.flatnonzero((frame[8] == palette.MOVING).all(axis=1))
        for start, begin, end in ((2, 0, 10), (5, 2, 27)):
            if begin <= tick < end:
                assert np.abs(blue - 40 * (start - (tick - begin) / 5) - 19.5).min() < 1.5, (tick, start)
    waits = (frames[0][8] == palette.WAITING).all(axis=1)
    assert abs(np.flatnonzero(waits).mean() - (5.5 * 40 - 0.5)) < 1.5


def test_robots_of_a_run_are_between_centres_too():
    """The robot begins a move each five ticks; one frame a tick, and three for each."""
    scenario = Scenario(Area("square", np.zeros((1, 9))), [(0, 0)], [(6, 0)], clock="costs")
    run = th.Trial(scenario).run()
    assert run.steps == 30
    for most, substeps in ((31, 1), (91, 3)):
        film = RunFilm(run, most, 360, "", clock=False, legend=False)
        frames = list(film.frames())
        assert len(frames) == 30 * substeps + 1
        for number, frame in enumerate(frames[:-1]):
            blue = np.flatnonzero((frame[8] == palette.MOVING).all(axis=1))
            assert abs(blue.mean() - 40 * (6 - number / substeps / 5) - 19.5) < 1.5, number


@pytest.mark.parametrize("name", TESSELLATIONS)
def test_robots_stand_where_the_plan_says(tmp_path, name):
    plan = wandering_plan(name)
    write_animation(plan, tmp_path / "a.gif", max_frames=plan.steps + 1, **BARE)
    frames = frames_of(tmp_path / "a.gif")
    assert len(frames) == plan.steps + 1
    area = plan.scenario.area
    across, _ = area.tessellation.extent(area.height, area.width)
    scale = frames[0].shape[1] / across
    for cells, frame in zip(plan.cells_by_step(), frames, strict=True):
        occupied = set(cells.tolist())
        for cell in range(area.cell_count - 1):
            x, y = area.tessellation.centre_of_cell(cell % 13, cell // 13)
            colour = tuple(frame[int(float(y) * scale), int(float(x) * scale)].tolist())
            assert colour == (palette.STRANDED if cell in occupied else palette.FREE)


def test_colours_survive_the_palette(tmp_path):
    """A picture with more colours than a GIF may have keeps the main ones, and the others nearly."""
    barriers = np.random.default_rng(0).random((40, 50)) < 0.3
    barriers[0, 0] = False
    plan = plan_from_lists(Scenario(Area("triangular", barriers, "random"), [(0, 0)], []), [])
    write_animation(plan, tmp_path / "a.gif", width=400, title="", clock=False, legend=True)
    (frame,) = frames_of(tmp_path / "a.gif")
    for colour in (palette.PAGE, palette.FREE, palette.BARRIER, palette.MOVING, palette.WAITING, palette.FINAL):
        assert (frame == colour).all(axis=-1).sum() > 20
    still = picture_of_area(plan.scenario, width=400, title="", legend=False).to_array().astype(int)
    body = frame[14 : 14 + still.shape[0], 14 : 14 + still.shape[1]]
    assert np.quantile(np.abs(body - still), 0.99) < 10


def test_clock_and_title_change_only_their_place(tmp_path):
    plan = corridor_plan()
    write_animation(plan, tmp_path / "a.gif", max_frames=6)
    frames = frames_of(tmp_path / "a.gif")
    changed = np.flatnonzero((frames[0][:60] != frames[2][:60]).any(axis=(1, 2)))
    assert changed.size
    assert changed.min() > 35  # below the title
    bare = tmp_path / "b.gif"
    write_animation(plan, bare, max_frames=6, **BARE)
    assert frames[0].shape[0] > frames_of(bare)[0].shape[0] + 60


@pytest.mark.parametrize("make", [lambda plan: PlanFilm(plan, 9, 300, None, True, True), lambda plan: run_film(plan)])
def test_movies_of_places_in_the_world_have_a_scale(make):
    plan = corridor_plan()
    area = Area("square", plan.scenario.area.barriers, "corridor", Frame(2.0))
    scenario = Scenario(area, plan.scenario.destinations, plan.scenario.robots)
    film = make(Plan(scenario, plan.actions, plan.first_action))
    assert [(entry.words, entry.length) for entry in film.scene.legend if isinstance(entry, Bar)] == [("5 m", 2.5)]
    (x, y, long), frame = film.sheet.bars[0], next(film.frames())
    assert long == round(2.5 * film.scene.scale)
    assert (frame[round(y), round(x) : round(x) + long] == palette.INK).all()


def run_film(plan: Plan) -> RunFilm:
    return RunFilm(th.Trial(plan.scenario).run(), 9, 300, "")


def test_files_are_the_same_again(tmp_path):
    plan = wandering_plan("triangular")
    for name in ("a.gif", "b.gif"):
        write_animation(plan, tmp_path / name, width=200)
    assert (tmp_path / "a.gif").read_bytes() == (tmp_path / "b.gif").read_bytes()


def test_unchanged_pixels_are_not_stored_again(tmp_path):
    area = Area("square", np.zeros((100, 100)))
    scenario = Scenario(area, [(99, 99)], [(0, 0)])
    east = area.tessellation.direction_names[0].index("E")
    write_animation(plan_from_lists(scenario, [[east] * 30]), tmp_path / "a.gif", **BARE)
    write_animation(plan_from_lists(scenario, [[]]), tmp_path / "b.gif", **BARE)
    grown = (tmp_path / "a.gif").stat().st_size - (tmp_path / "b.gif").stat().st_size
    assert grown < 30 * 7 * 250


def test_jumps_of_files_are_shown(tmp_path):
    scenario = Scenario(Area("square", np.zeros((1, 9))), [(0, 0)], [(8, 0)])
    actions = np.array([JUMP, WAIT], dtype=np.uint8)
    plan = Plan(scenario, actions, np.array([0, 2]), jumps=np.array([[0, 3]]))
    write_animation(plan, tmp_path / "a.gif", width=360, max_frames=3, **BARE)
    assert colours_of_corridor(frames_of(tmp_path / "a.gif")[1]) == "D..s....."


def test_bad_input_leaves_no_file(tmp_path):
    plan = corridor_plan()
    with pytest.raises(FormatError, match=r"must be one of \.gif, \.mp4, not '\.gfi'; did you mean '\.gif'"):
        write_animation(plan, tmp_path / "a.gfi")
    with pytest.raises(PlanError, match="frames_per_second must be a whole number from 1 to 50, not 0"):
        write_animation(plan, tmp_path / "a.gif", frames_per_second=0)
    with pytest.raises(PlanError, match="max_frames must be a whole number from 2"):
        write_animation(plan, tmp_path / "a.gif", max_frames=1)
    with pytest.raises(FormatError, match="width"):
        write_animation(plan, tmp_path / "a.gif", width=3)

    def interrupt(done, total):
        if done == 3:
            raise KeyboardInterrupt

    for name in ("a.gif", "a.mp4"):
        with pytest.raises(KeyboardInterrupt):
            write_animation(plan, tmp_path / name, progress=interrupt)
    assert not list(tmp_path.iterdir())


def test_mp4_holds_all_frames(tmp_path):
    import av

    write_animation(corridor_plan(), tmp_path / "a.mp4", width=361, frames_per_second=20, **BARE)
    with av.open(str(tmp_path / "a.mp4")) as container:
        frames = [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]
    assert len(frames) == 40 + 30  # the last one stays for 1.5 s
    assert frames[0].shape == (40, 362, 3)
    assert np.abs(frames[0][20, 300].astype(int) - palette.BARRIER).max() < 12


def test_mp4_without_pyav_says_what_to_install(tmp_path, monkeypatch):
    real = builtins.__import__

    def missing(name, *rest, **more):
        if name == "av":
            raise ImportError(name)
        return real(name, *rest, **more)

    monkeypatch.delitem(sys.modules, "av", raising=False)
    monkeypatch.setattr(builtins, "__import__", missing)
    with pytest.raises(MissingExtraError, match=r"trihex\[video\]"):
        write_animation(corridor_plan(), tmp_path / "a.mp4")
    assert not list(tmp_path.iterdir())
