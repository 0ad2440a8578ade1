"""Movie: the robots of a plan on their way, frame by frame."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from trihex.errors import check_type
from trihex.pictures.area_picture import picture_of_area
from trihex.pictures.film import MOST_SIDE, Film, Groups, Progress, step_words, write_film
from trihex.pictures.marks import LETTERS, LETTERS_FROM
from trihex.pictures.palette import FINAL, MOVING, STRANDED, WAITING
from trihex.pictures.png import paint_disc_marks, write_words
from trihex.pictures.run_movie import RunFilm
from trihex.pictures.run_picture import run_title
from trihex.pictures.scene import Key, Scene, centres_of, ink_on, scale_for
from trihex.pictures.sheet import Words
from trihex.pictures.ways import places_between
from trihex.plans import Motion, Plan, Walk
from trihex.running import Run

_FRAMES_A_MOVE = 8
_SIDE = 600.0  # the longest side of a movie unless the caller names a width


def write_animation(
    plan: Motion,
    path: str | os.PathLike[str],
    *,
    width: int | None = None,
    title: str | None = None,
    clock: bool = True,
    legend: bool = True,
    frames_per_second: int = 20,
    max_frames: int = 240,
    speed: float = 1.0,
    progress: Progress | None = None,
) -> None:
    """Write a movie of the robots moving, coloured by their sets: moving (filled), waiting, arrived (final).

    In a short plan robots glide from cell to cell over up to 8 frames a step; of a long one every other, third, ...
    step is shown. Robots are discs, with letters if they are 26 at most; one that arrives is shown for a step on its
    destination. Memory does not grow with the number of frames.

    Parameters
    ----------
    plan : Plan or Run
        Of a run, what happened, in the world as it was in each step; see `write_run_animation`.
    path : path
        .gif, or .mp4 (needs the extra ``video``).
    width : int, optional
        Pixels across the cells. Default: what suits the area, 900 at most.
    title : str, optional
        Default: planner and area. An empty title is left out.
    clock : bool
        Whether to tell the step, in a place in metres the second, and how many robots have arrived.
    legend : bool
        Whether to explain the colours.
    frames_per_second : int
        1 to 50.
    max_frames : int
        Bounds the time it takes and the size of the file; at least 2.
    speed : float
        Metres in a second, for the seconds of places in metres.
    progress : function of (frames done, frames in total), optional

    Raises
    ------
    FormatError
        If the suffix or the width is not one of those.
    PlanError
        If `frames_per_second` or `max_frames` is out of range.
    MissingExtraError
        If an .mp4 is asked for without PyAV.
    """
    check_type("plan", plan, Motion)
    film = film_of(plan, max_frames, width, title, clock=clock, legend=legend, speed=speed)
    write_film(film, path, frames_per_second, progress)


def film_of(
    motion: Motion, max_frames: int, width: int | None, title: str | None, *, clock: bool, legend: bool, speed: float
) -> Film:
    """Return the film of a plan or of a run; parameters as for `write_animation`."""
    if isinstance(motion, Run):
        return RunFilm(motion, max_frames, width, run_title(motion) if title is None else title, clock, legend, speed)
    return PlanFilm(motion, max_frames, width, title, clock, legend, speed)  # type: ignore[arg-type]  # no run: a plan


@dataclass(frozen=True)
class PlanFilm(Film):
    """The frames of a movie of a plan; the parameters are those of `write_animation`."""

    plan: Plan
    max_frames: int
    width: int | None
    title: str | None
    clock: bool
    legend: bool
    speed: float = 1.0

    colours = (STRANDED, FINAL, WAITING, MOVING)

    @property
    def most_substeps(self) -> int:
        """Frames a step at most; as many for a move across an edge, whatever it lasts."""
        return -(-_FRAMES_A_MOVE // self._edge)

    @property
    def _edge(self) -> int:
        """How many steps (ticks) a move across an edge lasts."""
        return int(self.plan.scenario.duration_of_direction[0])

    @property
    def steps(self) -> int:
        """Number of steps that the film tells."""
        return self.plan.steps

    @cached_property
    def scene(self) -> Scene:
        """What all frames have in common."""
        plan, area = self.plan, self.plan.scenario.area
        across, _ = area.tessellation.extent(area.height, area.width)
        pixels = round(scale_for(area, self.width, _SIDE, MOST_SIDE) * across)
        scene = picture_of_area(plan.scenario.with_robots(()), width=max(8, pixels)).scene
        keys = [Key("disc", MOVING, "moving"), Key("disc", WAITING, "waiting"), Key("disc", FINAL, "arrived")]
        if not plan.arrived.all():
            keys.append(Key("disc", STRANDED, "never arrives"))
        title = self.title
        if title is None:
            what = f"Plan ({plan.planner})" if plan.planner else "Plan"
            title = " of ".join(part for part in (what, area.name) if part)
        return replace(
            scene,
            title=title,
            subtitle="clock" if self.clock else "",
            legend=(*keys, *scene.legend) if self.legend else (),
        )

    def frames(self) -> Iterator[NDArray[np.uint8]]:
        """Yield the frames, each of shape (height, width, 3)."""
        groups: Groups = []
        last = -1
        for walk, x, y in self._places():
            if walk.step != last:
                groups, last = self._groups(walk), walk.step
            yield self._frame(last, x, y, groups)

    def _places(self) -> Iterator[tuple[Walk, NDArray[np.float64], NDArray[np.float64]]]:
        """Yield the walk at the step, and the place of each robot in edge steps, of each frame."""
        area, walk = self.plan.scenario.area, Walk(self.plan)
        for step in [*range(0, self.steps, self.pace.every), self.steps]:
            walk.go_to(step)
            cells = area.layout.site_to_cell(walk.site)
            substeps = self.pace.substeps if step < self.steps else 1
            if self.plan.has_steps:
                yield walk, *centres_of(area, cells)
                if substeps == 1:
                    continue
            later = area.layout.site_to_cell(walk.next_site())
            for part in range(int(self.plan.has_steps), substeps):
                yield walk, *places_between(area, cells, later, walk.done(part / substeps))

    def _groups(self, walk: Walk) -> Groups:
        """Return the robots to be seen after a step by colour: the sets of the step that follows."""
        step, arrival = walk.step, self.plan.arrival_step_of_robot
        groups: Groups = [(np.flatnonzero(arrival < 0), STRANDED)]
        if step < self.steps:
            sets = walk.sets()
            for robots, colour in ((sets.waiting, WAITING), (sets.filled, MOVING)):
                groups.append((robots[arrival[robots] >= 0], colour))
        shown = max(self.pace.every, self._edge)
        final = np.flatnonzero((arrival >= 0) & (arrival > step - shown) & (arrival <= step))
        return [*groups, (final, FINAL)]

    def _frame(self, step: int, x: NDArray[np.float64], y: NDArray[np.float64], groups: Groups) -> NDArray[np.uint8]:
        frame, scale = self.background.copy(), self.scene.scale
        x, y = self.on_page(x, y)
        for robots, colour in groups:
            if colour == FINAL:  # a crowd must not hide where it goes
                paint_disc_marks(frame, self.scene, self.sheet)
            self.paint_robots(frame, x[robots], y[robots], colour)
        words = []
        if self.plan.scenario.robot_count <= len(LETTERS) and scale >= LETTERS_FROM:
            for robots, colour in groups:
                for robot in robots.tolist():
                    words.append(Words(x[robot], y[robot], LETTERS[robot], round(0.46 * scale), ink_on(colour), True))
        if self.clock:
            arrival = self.plan.arrival_step_of_robot
            arrived = np.count_nonzero((arrival >= 0) & (arrival <= step))
            when = step_words(self.plan.scenario, step, self.plan.steps, self.speed)
            words.append(self.clock_words(f"{when}, arrived {arrived} of {arrival.size}"))
        return write_words(frame, words)
