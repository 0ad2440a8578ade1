"""Run movie: robots on their way through a world that changes or clears up as they see it, frame by frame."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from trihex.errors import check_type
from trihex.kernels.codes import LATE, UNDERWAY, WAIT
from trihex.pictures import marks as make
from trihex.pictures.film import MOST_SIDE, Film, Groups, Progress, step_words, write_film
from trihex.pictures.legend import scale_bars
from trihex.pictures.palette import DESTINATION, MOVING, PAGE, SERIES, STRANDED, WAITING
from trihex.pictures.png import paint, paint_disc_marks, write_words
from trihex.pictures.run_picture import CLASS_COLOURS, class_keys, classes_of, run_title
from trihex.pictures.scene import Discs, Key, Mark, Scene, centres_of, scale_for
from trihex.pictures.ways import places_between
from trihex.running import BROKEN, GOING, Run

LATE_COLOUR = SERIES[1]
_SIDE = 640.0  # the longest side of a movie unless the caller names a width


def write_run_animation(
    run: Run,
    path: str | os.PathLike[str],
    *,
    width: int | None = None,
    title: str | None = None,
    frames_per_second: int = 20,
    max_frames: int = 240,
    progress: Progress | None = None,
) -> None:
    """Write a movie of a run: what is known, what is not, robots that move, wait, are late, cut off or broken.

    Parameters and errors are those of `trihex.write_animation`.
    """
    check_type("run", run, Run)
    film = RunFilm(run, max_frames, width, run_title(run) if title is None else title)
    write_film(film, path, frames_per_second, progress)


class _Ways:
    """Where robots of a run are from step to step: moves may last several.

    Parameters
    ----------
    run : Run
    """

    def __init__(self, run: Run) -> None:
        self.run, self.step = run, 0
        self.cells = self.later = run.last_cell_of_robot.copy()
        self.begun = np.zeros(run.robots.size, dtype=np.int64)
        self.lasts = np.ones(run.robots.size, dtype=np.int64)

    def go_to(self, step: int, cells: NDArray[np.int64]) -> None:
        """Go on to the next step, after which robots are in `cells`, and let them begin what they do then."""
        run, layout = self.run, self.run.scenario.area.layout
        self.step, self.cells = step, np.where(cells >= 0, cells, run.last_cell_of_robot)
        is_under_way = (self.begun + self.lasts > step) & (cells >= 0)
        self.later = np.where(is_under_way, self.later, self.cells)
        if step == run.steps:
            return
        action = run.actions[step]
        begins = np.flatnonzero((action < UNDERWAY) & (cells >= 0))
        site = layout.cell_to_site(cells[begins])
        target = site + layout.offset_of_direction[site & 1, action[begins]]
        self.later[begins], self.begun[begins] = layout.site_to_cell(target), step
        self.lasts[begins] = run.scenario.duration_of_direction[action[begins]]

    def places(self, share: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return where robots are, in edge steps, when a share of the next step has passed."""
        done = np.where(self.later == self.cells, 0.0, (self.step + share - self.begun) / self.lasts)
        return places_between(self.run.scenario.area, self.cells, self.later, done)


@dataclass(frozen=True)
class RunFilm(Film):
    """The frames of a movie of a run."""

    run: Run
    max_frames: int
    width: int | None
    title: str
    clock: bool = True
    legend: bool = True
    speed: float = 1.0

    colours = (STRANDED, LATE_COLOUR, WAITING, MOVING)
    most_substeps = 6

    @property
    def steps(self) -> int:
        """Number of steps that the film tells."""
        return self.run.steps

    @cached_property
    def scene(self) -> Scene:
        """What all frames have in common."""
        area, run = self.run.scenario.area, self.run
        across, _ = area.tessellation.extent(area.height, area.width)
        pixels = max(8, round(scale_for(area, self.width, _SIDE, MOST_SIDE) * across))
        scale = scale_for(area, pixels)
        keys = [Key("disc", MOVING, "moving"), Key("disc", WAITING, "waiting")]
        keys += [Key("disc", LATE_COLOUR, "late")] if (run.actions == LATE).any() else []
        keys += [Key("disc", STRANDED, "cut off or broken")] if (run.state_of_robot != 1).any() else []
        return Scene(
            area,
            classes_of(run, 0, area.barriers, run.scenario.destinations),
            CLASS_COLOURS,
            scale,
            (1, 3, 4),
            (),
            (*keys, *class_keys(run), *scale_bars(area, scale)) if self.legend else (),
            self.title,
            "clock" if self.clock else "",
        )

    @property
    def sample(self) -> NDArray[np.uint8]:
        """All colours of backgrounds: that before the first step, and in every other row one in which all is known."""
        run, sample = self.run, self.background.copy()
        known = replace(run, known_since=np.zeros_like(run.known_since))
        classes = classes_of(known, 0, run.scenario.area.barriers, run.scenario.destinations)
        sample[::2] = paint(replace(self.scene, colour_of_cell=classes), self.sheet)[::2]
        return sample

    def frames(self) -> Iterator[NDArray[np.uint8]]:
        """Yield the frames, each of shape (height, width, 3)."""
        run = self.run
        cells, worlds = list(run.cells_by_step()), run.worlds()
        world = (run.scenario.area.barriers.copy(), run.scenario.destinations)
        shown, background, ways = self.scene, self.background, _Ways(run)
        for step in range(run.steps + 1):
            if step:
                barriers, destinations = next(worlds)
                world = (barriers, destinations)
            ways.go_to(step, cells[step])
            if step % self.pace.every and step != run.steps:
                continue
            classes = classes_of(run, step, *world)
            if not np.array_equal(classes, shown.colour_of_cell):
                shown = replace(self.scene, colour_of_cell=classes)
                background = paint(shown, self.sheet)
            for part in range(self.pace.substeps if step < run.steps else 1):
                places = ways.places(part / self.pace.substeps)
                yield self._frame(background, step, cells[step], places, world[1])

    def _groups(self, step: int, cells: NDArray[np.int64]) -> Groups:
        """Return the robots to be seen after `step` by colour."""
        run, there = self.run, cells >= 0
        action = run.actions[step] if step < run.steps else np.full(there.size, WAIT, dtype=np.uint8)
        cut_off = (run.cut_off_since >= 0) & (run.cut_off_since <= step) & (run.state_of_robot == GOING)
        broken = (run.state_of_robot == BROKEN) & (run.ended <= step) & (run.ended >= 0)
        goes = there & ~cut_off
        return [
            (np.flatnonzero(broken | (there & cut_off)), STRANDED),
            (np.flatnonzero(goes & (action == WAIT)), WAITING),
            (np.flatnonzero(goes & (action == LATE)), LATE_COLOUR),
            (np.flatnonzero(goes & (action < LATE)), MOVING),
        ]

    def _frame(
        self,
        background: NDArray[np.uint8],
        step: int,
        cells: NDArray[np.int64],
        places: tuple[NDArray[np.float64], NDArray[np.float64]],
        destinations: NDArray[np.int64],
    ) -> NDArray[np.uint8]:
        run, area, scale = self.run, self.run.scenario.area, self.scene.scale
        frame = background.copy()
        marks: tuple[Mark, ...] = ()
        if scale < make.LETTERS_FROM and destinations.size:  # cells are too small to be found by their colour alone
            ends = centres_of(area, destinations)
            marks = (Discs(*ends, 0.65, PAGE, 5.0), Discs(*ends, 0.5, DESTINATION, 3.5))
        paint_disc_marks(frame, replace(self.scene, marks=marks), self.sheet)
        x, y = self.on_page(*places)
        for robots, colour in self._groups(step, cells):
            self.paint_robots(frame, x[robots], y[robots], colour)
        if not self.clock:
            return frame
        arrived = np.count_nonzero(run.arrived & (run.ended <= step))
        known = float(np.mean((run.known_since >= 0) & (run.known_since <= step)))
        text = f"{step_words(run.scenario, step, run.steps, self.speed)}, arrived {arrived} of {run.robots.size}"
        text += f", known {100 * known:.0f} %" if run.sensor is not None else ""
        return write_words(frame, [self.clock_words(text)])
