"""Film: frames of robots on their way over a scene that they share, and the file that holds them."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import ClassVar, TypeAlias

import numpy as np
from numpy.typing import NDArray

from trihex.areas import Scenario, seconds_per_step
from trihex.errors import PlanError
from trihex.files import new_file, suffix_of
from trihex.pictures.gif import GifWriter
from trihex.pictures.mp4 import Mp4Writer, import_av
from trihex.pictures.palette import Colour
from trihex.pictures.png import paint, paint_discs
from trihex.pictures.scene import Scene
from trihex.pictures.sheet import MARGIN, TEXT_SIZE, Sheet, Words, arrange, width_of

MOVIE_SUFFIXES = (".gif", ".mp4")
# The longest side of a movie of many cells, unless the caller names a width.
MOST_SIDE = 900.0
_HOLD = 1500  # milliseconds for which the last frame stays
_RADIUS, _LEAST_RADIUS = 0.4, 1.7  # of robots, in edge steps and in pixels

Progress: TypeAlias = Callable[[int, int], None]
# Robots by number, and the colour in which they are seen.
Groups: TypeAlias = list[tuple[NDArray[np.int64], Colour]]


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


class Film(ABC):
    """The frames of a movie; a subclass says what they show.

    Attributes
    ----------
    max_frames : int
    colours : tuple of Colour
        What moves over the background.
    """

    max_frames: int
    colours: ClassVar[tuple[Colour, ...]]

    @property
    @abstractmethod
    def most_substeps(self) -> int:
        """Frames a step at most."""

    @property
    @abstractmethod
    def steps(self) -> int:
        """Number of steps that the film tells."""

    @property
    @abstractmethod
    def scene(self) -> Scene:
        """What all frames have in common; its subtitle gives way to the clock."""

    @abstractmethod
    def frames(self) -> Iterator[NDArray[np.uint8]]:
        """Yield the frames, each of shape (height, width, 3)."""

    @cached_property
    def pace(self) -> Pace:
        """Which steps are shown."""
        return Pace(self.steps, self.max_frames, self.most_substeps)

    @cached_property
    def sheet(self) -> Sheet:
        """Where the parts of a frame lie: the place of the subtitle is left to the clock."""
        sheet = arrange(self.scene)
        return replace(sheet, words=tuple(line for line in sheet.words if (line.x, line.y) != sheet.subtitle_at))

    @cached_property
    def background(self) -> NDArray[np.uint8]:
        """The picture before the first step, without robots, shape (height, width, 3)."""
        return paint(self.scene, self.sheet)

    @property
    def sample(self) -> NDArray[np.uint8]:
        """An image with all colours of backgrounds."""
        return self.background

    def on_page(
        self, x: NDArray[np.float64], y: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return where places in edge steps lie in a frame, in pixels."""
        scale, (left, top) = self.scene.scale, self.sheet.body
        return x * scale + left, y * scale + top

    def paint_robots(
        self, frame: NDArray[np.uint8], x: NDArray[np.float64], y: NDArray[np.float64], colour: Colour
    ) -> None:
        """Paint a disc for each robot at (x, y) in pixels."""
        paint_discs(frame, x, y, max(_RADIUS * self.scene.scale, _LEAST_RADIUS), colour)

    def clock_words(self, text: str) -> Words:
        """Return what the clock says, as large as there is room."""
        room = self.sheet.width - 2 * MARGIN
        size = int(min(TEXT_SIZE, TEXT_SIZE * room / width_of(text, TEXT_SIZE)))
        return Words(*self.sheet.subtitle_at, text, size)


def step_words(scenario: Scenario, step: int, steps: int, speed: float) -> str:
    """Return which step (tick) is shown, and in a place in metres which second."""
    area, words = scenario.area, f"{scenario.step_word} {step} of {steps}"
    if area.frame is None:
        return words
    now, last = (number * seconds_per_step(area, speed) for number in (step, steps))
    return f"{words}, {now:.1f} of {last:.1f} s"


def write_film(film: Film, path: str | os.PathLike[str], frames_per_second: int, progress: Progress | None) -> None:
    """Write the frames of a film as the suffix of `path` says; memory does not grow with their number.

    Raises
    ------
    FormatError
        If the suffix is none of a movie.
    PlanError
        If `frames_per_second` or the `max_frames` of the film is out of range.
    MissingExtraError
        If an .mp4 is asked for without PyAV.
    """
    suffix = suffix_of(path, MOVIE_SUFFIXES, "a movie")
    _check_range("frames_per_second", frames_per_second, 1, 50)
    _check_range("max_frames", film.max_frames, 2, 100_000)
    if suffix == ".mp4":
        import_av()
    milliseconds = 10 * round(100 / frames_per_second)  # GIF counts in hundredths of a second
    with new_file(path) as part, closing(_writer_of(film, part, suffix, frames_per_second)) as writer:
        for done, frame in enumerate(film.frames(), 1):
            writer.add(frame, milliseconds if done < film.pace.frame_count else _HOLD)
            if progress:
                progress(done, film.pace.frame_count)


def _writer_of(film: Film, part: Path, suffix: str, frames_per_second: int) -> GifWriter | Mp4Writer:
    if suffix == ".mp4":
        return Mp4Writer(part, frames_per_second)
    return GifWriter(part, film.sample, list(film.colours))


def _check_range(parameter: str, value: object, least: int, most: int) -> None:
    """Raise PlanError unless `value` is a whole number from `least` to `most`."""
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or not least <= value <= most:
        raise PlanError(f"{parameter} must be a whole number from {least} to {most}, not {value!r}")
