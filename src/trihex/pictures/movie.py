"""Movie: the robots of a plan on their way, frame by frame."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from trihex.errors import PlanError
from trihex.files import new_file, suffix_of
from trihex.pictures.gif import GifWriter
from trihex.pictures.marks import LETTERS, LETTERS_FROM
from trihex.pictures.mp4 import Mp4Writer, import_av
from trihex.pictures.palette import FINAL, MOVING, STRANDED, WAITING, Colour
from trihex.pictures.picture import picture_of_area
from trihex.pictures.png import paint, paint_disc_marks, paint_discs, write_words
from trihex.pictures.scene import Key, Scene, centres_of, ink_on, scale_for
from trihex.pictures.sheet import MARGIN, TEXT_SIZE, Sheet, Words, arrange, width_of
from trihex.plans import Plan, follow

MOVIE_SUFFIXES = (".gif", ".mp4")
Progress: TypeAlias = Callable[[int, int], None]
# The longest side of a movie unless the caller names a width.
_SIDE, _MOST_SIDE = 600.0, 900.0
_MOST_SUBSTEPS = 8
_HOLD = 1500  # milliseconds for which the last frame stays
_RADIUS, _LEAST_RADIUS = 0.4, 1.7  # of robots, in edge steps and in pixels


def write_animation(
    plan: Plan,
    path: str | os.PathLike[str],
    *,
    width: int | None = None,
    title: str | None = None,
    clock: bool = True,
    legend: bool = True,
    frames_per_second: int = 20,
    max_frames: int = 240,
    progress: Progress | None = None,
) -> None:
    """Write a movie of the robots moving, coloured by their sets: moving (filled), waiting, arrived (final).

    In a short plan robots glide from cell to cell over up to 8 frames a step; of a long one every other, third, ...
    step is shown. Robots are discs, with letters if they are 26 at most; one that arrives is shown for a step on its
    destination. Memory does not grow with the number of frames.

    Parameters
    ----------
    plan : Plan
    path : path
        .gif, or .mp4 (needs the extra ``video``).
    width : int, optional
        Pixels across the cells. Default: what suits the area, 900 at most.
    title : str, optional
        Default: planner and area. An empty title is left out.
    clock : bool
        Whether to tell the step and how many robots have arrived.
    legend : bool
        Whether to explain the colours.
    frames_per_second : int
        1 to 50.
    max_frames : int
        Bounds the time it takes and the size of the file; at least 2.
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
    suffix = suffix_of(path, MOVIE_SUFFIXES, "a movie")
    check_range("frames_per_second", frames_per_second, 1, 50)
    check_range("max_frames", max_frames, 2, 100_000)
    if suffix == ".mp4":
        import_av()
    film = Film(plan, max_frames, _scene(plan, width, title, clock, legend), clock)
    # GIF counts in hundredths of a second.
    milliseconds = 10 * round(100 / frames_per_second)
    with new_file(path) as part:
        writer: GifWriter | Mp4Writer
        if suffix == ".gif":
            writer = GifWriter(part, film.background, [STRANDED, FINAL, WAITING, MOVING])
        else:
            writer = Mp4Writer(part, frames_per_second)
        with closing(writer):
            for done, frame in enumerate(film.frames(), 1):
                writer.add(frame, milliseconds if done < film.pace.frame_count else _HOLD)
                if progress:
                    progress(done, film.pace.frame_count)


def check_range(parameter: str, value: object, least: int, most: int) -> None:
    """Raise PlanError unless `value` is a whole number from `least` to `most`."""
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or not least <= value <= most:
        raise PlanError(f"{parameter} must be a whole number from {least} to {most}, not {value!r}")


def _scene(plan: Plan, width: int | None, title: str | None, clock: bool, legend: bool) -> Scene:
    """Return what all frames have in common."""
    area = plan.scenario.area
    across, _ = area.tessellation.extent(area.height, area.width)
    pixels = round(scale_for(area, width, _SIDE, _MOST_SIDE) * across)
    scene = picture_of_area(plan.scenario.with_robots(()), width=max(8, pixels)).scene
    keys = [Key("disc", MOVING, "moving"), Key("disc", WAITING, "waiting"), Key("disc", FINAL, "arrived")]
    if not plan.arrived.all():
        keys.append(Key("disc", STRANDED, "never arrives"))
    if title is None:
        title = " of ".join(part for part in (f"Plan ({plan.planner})" if plan.planner else "Plan", area.name) if part)
    return replace(
        scene,
        title=title,
        subtitle="clock" if clock else "",
        legend=(*keys, *scene.legend) if legend else (),
    )


@dataclass(frozen=True)
class Pace:
    """How the steps of a plan or run become at most `max_frames` frames, up to `most_substeps` of them a step."""

    steps: int
    max_frames: int
    most_substeps: int

    @property
    def every(self) -> int:
        """Steps from one that is shown to the next."""
        return max(1, -(-self.steps // (self.max_frames - 1)))

    @property
    def substeps(self) -> int:
        """Frames from one step that is shown to the next."""
        return max(1, min(self.most_substeps, (self.max_frames - 1) // max(1, self.steps)))

    @property
    def frame_count(self) -> int:
        """Number of frames."""
        return -(-self.steps // self.every) * self.substeps + 1


def arrange_frame(scene: Scene) -> Sheet:
    """Return where the parts of a frame lie: the place of the subtitle is left to the clock."""
    sheet = arrange(scene)
    return replace(sheet, words=tuple(line for line in sheet.words if (line.x, line.y) != sheet.subtitle_at))


@dataclass(frozen=True)
class Film:
    """The frames of a movie.

    Parameters
    ----------
    plan : Plan
    max_frames : int
    scene : Scene
        What all frames have in common; its subtitle gives way to the clock.
    clock : bool
    """

    plan: Plan
    max_frames: int
    scene: Scene
    clock: bool

    @cached_property
    def pace(self) -> Pace:
        """Which steps are shown."""
        return Pace(self.plan.steps, self.max_frames, _MOST_SUBSTEPS)

    @cached_property
    def sheet(self) -> Sheet:
        """Where the parts of a frame lie."""
        return arrange_frame(self.scene)

    @cached_property
    def background(self) -> NDArray[np.uint8]:
        """The picture without robots, shape (height, width, 3)."""
        return paint(self.scene, self.sheet)

    def frames(self) -> Iterator[NDArray[np.uint8]]:
        """Yield the frames, each of shape (height, width, 3)."""
        groups: list[tuple[NDArray[np.int64], Colour]] = []
        last = -1
        for step, x, y in self._places():
            if step != last:
                groups, last = self._groups(step), step
            yield self._frame(step, x, y, groups)

    def _places(self) -> Iterator[tuple[int, NDArray[np.float64], NDArray[np.float64]]]:
        """Yield the step, and the place of each robot in edge steps, of each frame."""
        plan, area = self.plan, self.plan.scenario.area
        site = area.layout.cell_to_site(plan.scenario.robots)
        step = 0
        while step < plan.steps:
            x, y = centres_of(area, area.layout.site_to_cell(site))
            yield step, x, y
            next_step = min(step + self.pace.every, plan.steps)
            follow(plan, step, next_step, site)
            if self.pace.substeps > 1:
                to_x, to_y = centres_of(area, area.layout.site_to_cell(site))
                for share in (np.arange(1, self.pace.substeps) / self.pace.substeps).tolist():
                    yield step, x + share * (to_x - x), y + share * (to_y - y)
            step = next_step
        yield step, *centres_of(area, area.layout.site_to_cell(site))

    def _groups(self, step: int) -> list[tuple[NDArray[np.int64], Colour]]:
        """Return the robots to be seen after `step` by colour: the sets of the step that follows."""
        plan, arrival = self.plan, self.plan.arrival_step_of_robot
        groups = [(np.flatnonzero(arrival < 0), STRANDED)]
        if step < plan.steps:
            sets = plan.sets_at(step + 1)
            for robots, colour in ((sets.waiting, WAITING), (sets.filled, MOVING)):
                groups.append((robots[arrival[robots] >= 0], colour))
        final = np.flatnonzero((arrival >= 0) & (arrival > step - self.pace.every) & (arrival <= step))
        return [*groups, (final, FINAL)]

    def _frame(
        self,
        step: int,
        x: NDArray[np.float64],
        y: NDArray[np.float64],
        groups: list[tuple[NDArray[np.int64], Colour]],
    ) -> NDArray[np.uint8]:
        frame, scale = self.background.copy(), self.scene.scale
        x, y = x * scale + self.sheet.body[0], y * scale + self.sheet.body[1]
        for robots, colour in groups:
            if colour == FINAL:  # a crowd must not hide where it goes
                paint_disc_marks(frame, self.scene, self.sheet)
            paint_discs(frame, x[robots], y[robots], max(_RADIUS * scale, _LEAST_RADIUS), colour)
        words = []
        if self.plan.scenario.robot_count <= len(LETTERS) and scale >= LETTERS_FROM:
            for robots, colour in groups:
                for robot in robots.tolist():
                    words.append(Words(x[robot], y[robot], LETTERS[robot], round(0.46 * scale), ink_on(colour), True))
        if self.clock:
            arrival = self.plan.arrival_step_of_robot
            arrived = np.count_nonzero((arrival >= 0) & (arrival <= step))
            text = f"step {step} of {self.plan.steps}, arrived {arrived} of {arrival.size}"
            room = self.sheet.width - 2 * MARGIN
            size = int(min(TEXT_SIZE, TEXT_SIZE * room / width_of(text, TEXT_SIZE)))
            words.append(Words(*self.sheet.subtitle_at, text, size))
        return write_words(frame, words)
