"""Study: which runs there are, in which order, under which limits."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from inspect import signature
from pathlib import Path
from typing import Any

from trihex.areas import Scenario
from trihex.errors import FormatError, PlanError, StudyError, TrihexError, check_type
from trihex.files import read_bytes
from trihex.formats import complaint, read_toml
from trihex.formats.schema import check_document
from trihex.planners import planner_from
from trihex.record import Record, counted
from trihex.studies.case import least_rules, read_area_of, try_planner
from trihex.studies.grid import Grid, variants_of
from trihex.studies.row import hash_of_scenario, versions
from trihex.studies.schema import AreaAxis, PlannerAxis, StudyTable, bytes_of

# What the key of a run is called, and that of its axis in a file; the last changes fastest, so that the runs of one
# scenario follow each other.
AXES = {
    "area": "areas",
    "tessellation": "tessellations",
    "rules": "rules",
    "destinations": "destinations",
    "robots": "robots",
    "seed": "seeds",
    "planner": "planners",
}
_ANY_GENERATOR = ("generator", "name", "size", "seed")
_METRES = ("cell_size", "cell_area", "robot_radius", "unknown", "threshold", "invert", "resolution")


@dataclass(frozen=True, eq=False)
class Study(Record):
    """Many runs, each of one planner on one scenario.

    Parameters
    ----------
    trials : sequence of dict
        What each run is to do, plain values by the keys of `AXES`; or a `Scenario` in place of all but the planner.
    key : str
        Hash of all that the results depend on: the file, the files it names, and the version of trihex.
    seconds : float, optional
        How long a run may take.
    memory : int, optional
        How many bytes a run may take, beside what trihex takes idle.
    name : str
    """

    trials: Sequence[dict[str, Any]]
    key: str
    seconds: float | None = None
    memory: int | None = None
    name: str = ""

    def in_words(self) -> str:
        """Return the name and how many runs there are."""
        return f"{self.name!r}, {counted(len(self), 'run')}"

    def __len__(self) -> int:
        return len(self.trials)


def read_study(path: str | os.PathLike[str]) -> Study:
    """Return the study that a TOML file describes; files that it names lie relative to it.

    Raises
    ------
    FormatError
        With a line for each mistake: path of the key, rule, value, near name.
    OSError
        If the file cannot be read.
    """
    document = read_toml(path)
    study, mistakes = _study_of(document, _Check(Path(path).parent))
    if study is None:
        raise complaint(path, mistakes)
    return study


def make_study(runs: Iterable[Mapping[str, Any]], folder: str | os.PathLike[str] = ".") -> Study:
    """Return the study of the runs given one by one.

    Parameters
    ----------
    runs : iterable of mapping
        With the keys `area`, `tessellation`, `rules`, `destinations`, `robots`, `seed` and `planner`, each as an entry
        of the axis in a study file; or with `scenario`, a `Scenario`, and `planner`.
    folder : path
        Where the files that they name lie.

    Raises
    ------
    StudyError
        With a line for each mistake.

    Examples
    --------
    >>> area = {"generator": "random", "size": [8, 6]}
    >>> study = make_study([{"area": area, "robots": 3, "planner": name} for name in ("greedy", "fcost")])
    >>> len(study), study.trials[1]["planner"]["name"]
    (2, 'fcost')
    """
    cases, mistakes, digest = [], [], hashlib.sha256(versions()["trihex"].encode())
    check = _Check(Path(folder))
    for i, run in enumerate(runs):
        check_type(f"run {i}", run, Mapping, error=StudyError)
        wanted = {name: value for name, value in run.items() if name != "scenario"}
        given = run.get("scenario")
        document = {AXES.get(name, name): value if name == "bound" else [value] for name, value in wanted.items()}
        if given is not None:
            document |= {"areas": [{"generator": "random", "size": [1, 1]}], "robots": [0]}
        study, found = _study_of(document, check)
        if study is None or len(study) != 1 or not isinstance(given, Scenario | None):
            found = found or ["scenario must be a Scenario" if given is not None else "a run must not vary anything"]
            mistakes += [f"run {i}: {mistake}" for mistake in found]
            continue
        case = study.trials[0]
        if given is not None:
            case = {"scenario": given, "planner": case["planner"], "bound": case["bound"]}
            digest.update(hash_of_scenario(given).encode())
            digest.update(json.dumps(case["planner"], sort_keys=True).encode())
        digest.update(study.key.encode())
        cases.append(case)
    if mistakes:
        raise StudyError("\n".join(mistakes[:50]))
    return Study(cases, digest.hexdigest())


def _study_of(document: dict[str, Any], check: _Check) -> tuple[Study | None, list[str]]:
    table, mistakes = check_document(StudyTable, document)
    if table is None or mistakes:
        return None, mistakes
    check.mistakes = mistakes
    planners = [entry for i, planner in enumerate(table.planners) for entry in _planners_of(f"planners.{i}", planner)]
    axes: dict[str, Sequence[Any]] = {"bound": [table.bound], "folder": [str(check.folder.resolve())]}
    axes |= {name: _entries(getattr(table, axis)) for name, axis in AXES.items() if name not in ("seed", "planner")}
    axes |= {"seed": table.seeds, "planner": [planner for _, planner in planners]}
    for i, area in enumerate(table.areas):
        check.area(f"areas.{i}", area, axes["tessellation"][0], least_rules(axes["rules"][0]))
    for i, robots in enumerate(table.robots):
        for file in robots.file or []:
            check.file(f"robots.{i}.file", file)
    for key, planner in planners:
        check.planner(key, planner)
    if mistakes:
        return None, mistakes
    try:
        grid = Grid(axes, table.sample, table.sample_seed)
    except StudyError as error:
        return None, [str(error)]
    content = json.dumps([versions()["trihex"], table.model_dump(exclude={"name"}), check.digests], sort_keys=True)
    memory = bytes_of(table.limits.memory) if table.limits.memory else None
    key = hashlib.sha256(content.encode()).hexdigest()
    return Study(grid, key, table.limits.seconds, memory, table.name), []


def _planners_of(key: str, planner: PlannerAxis) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the entries of an axis of planners, each with its key; a name may hold options: ``fcost:rule=paper``."""
    for text in planner.name:
        try:
            name, own = planner_from(text)
        except PlanError:
            name, own = text, {}  # the check of all planners will tell
        for options in variants_of({**own, **planner.options}):
            for run in _runs_of(planner):
                yield key, {"name": name, "options": options, **run}


def _runs_of(planner: PlannerAxis) -> list[dict[str, Any]]:
    if planner.run is None:
        return [{}]
    return [{"run": run} for run in variants_of(planner.run.model_dump(exclude_none=True))]


def _entries(tables: list[Any]) -> list[dict[str, Any]]:
    fixed = ("cells", "metres")
    return [entry for table in tables for entry in variants_of(table.model_dump(exclude_none=True), fixed)]


class _Check:
    """What the schema cannot tell: whether files can be read, and whether options belong together."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.mistakes: list[str] = []
        self.digests: dict[str, str] = {}
        self._seen: set[str] = set()  # what was found right, not to look again in each of many runs

    def _attempt(self, key: str, subject: object, work: Callable[[], object]) -> None:
        """Add to the mistakes what `work` raises."""
        name = json.dumps(subject, sort_keys=True, default=str)
        if name in self._seen:
            return
        try:
            work()
            self._seen.add(name)
        except (TrihexError, OSError, TypeError) as error:
            text = f"{error.strerror}: {error.filename!s:.200}" if isinstance(error, OSError) else str(error)
            self.mistakes.append(f"{key}: {text}")

    def file(self, key: str, file: str) -> None:
        """Check that a file can be read, and remember what is in it."""

        def read() -> None:
            self.digests[file] = hashlib.sha256(read_bytes(self.folder / file)).hexdigest()

        self._attempt(key, ["file", file], read)

    def planner(self, key: str, planner: dict[str, Any]) -> None:
        """Check that a planner exists and takes its options, on one robot: any planner tells at once."""
        self._attempt(key, planner, lambda: try_planner(planner))

    def area(self, key: str, area: AreaAxis, tessellation: dict[str, Any], least: dict[str, str]) -> None:
        """Check one entry of the areas."""
        given = area.model_dump(exclude_none=True)
        if area.generator is not None:
            self._attempt(key, given, lambda: _check_generator(area.generator or "", given))
            return
        for name in given:
            if name not in ("path", "name", "capacity", *_METRES):
                self.mistakes.append(f"{key}.{name}: belongs to a generator, not to a file")
        if "cell_size" in given and "cell_area" in given:
            self.mistakes.append(f"{key}: must have only one of cell_size, cell_area, not both")
        for file in area.path or []:
            self.file(f"{key}.path", file)
        if not self.mistakes:
            for entry in variants_of(given):
                self._attempt(key, entry, lambda e=entry: read_area_of(e, tessellation, 0, self.folder, least))  # type: ignore[misc]


def _check_generator(generator: str, given: dict[str, Any]) -> None:
    from trihex.areas import GENERATORS

    known = {name: set(signature(maker).parameters) for name, maker in GENERATORS.items()}
    if "size" not in given:
        raise FormatError("size: is missing, such as size = [64, 48], width and height in cells")
    for name in given:
        if name in _ANY_GENERATOR or name in known[generator]:
            continue
        owners = [other for other, names in known.items() if name in names]
        raise FormatError(f"{name}: belongs to {' and '.join(owners) or 'a file'}, not to {generator}")
