"""Registry: every format, how its files look, and what reads and writes them.

A new format is a module and a line here: in `FORMATS` if it is read, in `WRITERS` if it is written. Functions stand by
their path below `trihex.formats`, so that a module loads when a file of its kind is there.
"""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from typing import Any, Literal

from trihex.files import MAX_BYTES, ORDER_SUFFIXES, suffix_of
from trihex.formats.text import check_text

PLAN_HEADER = "robot,step,x,y,action,time"
STARTS_HEADER = "x,y"
STARTS_HEADER_IN_METRES = "x_metres,y_metres"
START_COLUMN = "start"
SLOWNESS_COLUMN, SPEED_COLUMN = "slowness", "speed"
# tomllib and json take some 30 times as much while they read.
MAX_TOML = MAX_JSON = 2**26
MAX_WKT = 2**28


@dataclass(frozen=True)
class Format:
    """A format that trihex reads.

    Parameters
    ----------
    name : str
        As `format_of` returns it.
    words : str
        As messages call it.
    holds : {"area", "scenario", "plan", "starts"}
        Decides what its parser takes after the content and the path, and what it returns:
        area: options and progress, a draft; scenario: what reads the draft of an area, a draft;
        plan: a scenario or None and progress, a plan; starts: an area, cells.
    parser : str
        Path of the function below `trihex.formats`.
    pattern : bytes
        What is found in the first 4096 bytes of such a file; ``^`` and ``$`` match at lines.
    suffixes : tuple of str
        Names that tell where the content does not.
    is_text : bool
        Whether the parser takes `Text`.
    most_bytes : int
        Of a file of text.
    brings_scenario : bool
        Whether a plan needs none to be named.
    brings_shape : bool
        Whether it says what shape the cells of an area have.
    is_of_letters : bool
        Whether one character of an area is one cell, of whatever shape.
    """

    name: str
    words: str
    holds: Literal["area", "scenario", "plan", "starts"]
    parser: str
    pattern: bytes
    suffixes: tuple[str, ...] = ()
    is_text: bool = True
    most_bytes: int = MAX_BYTES
    brings_scenario: bool = False
    brings_shape: bool = False
    is_of_letters: bool = False

    @cached_property
    def _compiled(self) -> re.Pattern[bytes]:
        return re.compile(self.pattern, re.MULTILINE)

    def is_format_of(self, head: bytes) -> bool:
        """Tell whether a file that begins so has this format."""
        return self._compiled.search(head) is not None

    def parse(self, content: bytes, path: str | os.PathLike[str], *others: Any) -> Any:
        """Return what a file holds; text is checked here, once."""
        checked = check_text(content, path, self.most_bytes) if self.is_text else content
        return function_at(self.parser)(checked, path, *others)


def _first_line(pattern: str) -> bytes:
    return rf"\A[^\S\n]*(?:{pattern})[^\S\n]*(?:\n|\Z)".encode()


# As YAML has it, or JSON.
_ROS_KEY = rb"\s*[\"']?(?:image|resolution|origin|negate|occupied_thresh|free_thresh|mode)[\"']?\s*:"
# What is recognised first stands first.
_FORMATS = (
    Format(
        "npz", "a plan (.npz)", "plan", "plans.npz.parse_plan_npz", rb"\APK\x03\x04",
        is_text=False, brings_scenario=True,
    ),
    Format("parquet", "a plan (.parquet)", "plan", "plans.parquet.parse_plan_parquet", rb"\APAR1", is_text=False),
    Format(
        "image", "an image", "area", "areas.image.parse_image",
        rb"\A(?:\x89PNG|\xff\xd8\xff|GIF8|(?s:BM.{4}\0\0\0\0)|P[1-6Ff]\s)", is_text=False,
    ),
    Format(
        "dxf", "DXF", "area", "areas.dxf.parse_dxf",
        rb"\A(?:AutoCAD Binary DXF|\s*(?:999[^\S\n]*\n.*\n\s*)*0[^\S\n]*\n\s*SECTION)", (".dxf",), is_text=False,
    ),
    Format("plan", "a plan (.csv)", "plan", "plans.csv.parse_plan_csv", _first_line(PLAN_HEADER)),
    Format(
        "starts", "starts (.csv)", "starts", "starts.csv.parse_starts",
        _first_line(f"(?:{STARTS_HEADER}|{STARTS_HEADER_IN_METRES})(?:,{START_COLUMN})?(?:,{SLOWNESS_COLUMN}|,{SPEED_COLUMN})?"),
    ),
    Format(
        "movingai", "a MovingAI map", "area", "areas.movingai.parse_movingai",
        rb"\A(?:.*\n){0,3}(?:(?:type|height|width)\s|map\s*$)", (".map",), is_of_letters=True,
    ),
    Format(
        "tiled", "a map of Tiled", "area", "areas.tiled.parse_tiled",
        rb"(?s)\A\s*(?:(?:<\?xml.{0,200}?\?>|<!--.{0,2000}?-->|<!DOCTYPE[^>]*>)\s*)*<map\b|\A\s*\{\s*\"(?:compressionlevel|height|"
        rb"hexsidelength|infinite|layers|nextlayerid|orientation|renderorder|staggeraxis|tiledversion|tilesets|tilewidth)\"\s*:",
        (".tmj", ".tmx"), most_bytes=MAX_JSON, brings_shape=True,
    ),
    Format("scen", "starts (.scen)", "starts", "starts.scen.parse_scen", rb"\A[^\S\n]*version(?:\s|\Z)", (".scen",)),
    Format(
        "geojson", "GeoJSON", "area", "areas.geojson.parse_geojson", rb"\A\s*\{(?!%s)" % _ROS_KEY,
        (".geojson", ".json"), most_bytes=MAX_JSON,
    ),
    Format(
        "wkt", "WKT", "area", "areas.wkt.parse_wkt",
        rb"(?i)\A\s*(?:SRID\s*=\s*\d+\s*;\s*)?(?:(?:MULTI)?(?:POINT|LINESTRING|POLYGON)|GEOMETRYCOLLECTION)\b",
        (".wkt",), most_bytes=MAX_WKT,
    ),
    Format(
        "ros", "a ROS map", "area", "areas.ros.parse_ros",
        rb"(?:^|\A\s*\{)%s" % _ROS_KEY, (".yaml", ".yml"),
    ),
    Format(
        "scenario", "a scenario (.toml)", "scenario", "scenarios.toml.parse_scenario_toml",
        rb"^\s*(?:\[\[?[\w.\"' -]+\]\]?\s*(?:#.*)?$|[\w.\"'-]+\s*=)", (".toml",),
        most_bytes=MAX_TOML, brings_scenario=True,
    ),
    Format("letters", "letters", "area", "areas.letters.parse_letters", rb"(?!)", is_of_letters=True),  # what is left
)  # fmt: skip
FORMATS = {form.name: form for form in _FORMATS}

# By what is written and by suffix. They take a record and a path; that of a plan progress, too, that of a scenario
# planner, its options and outputs.
WRITERS = {
    "an area": {
        ".map": "areas.movingai.write_movingai",
        ".txt": "areas.letters.write_letters",
        ".toml": "scenarios.toml.write_area_toml",
        ".png": "areas.image.write_image",
        ".pgm": "areas.image.write_image",
        ".bmp": "areas.image.write_image",
    },
    "a scenario": {
        ".toml": "scenarios.toml.write_scenario_toml",
        ".txt": "areas.letters.write_scenario_letters",
    },
    "a plan": {
        ".csv": "plans.csv.write_plan_csv",
        ".npz": "plans.npz.write_plan_npz",
        ".parquet": "plans.parquet.write_plan_parquet",
        ".txt": "plans.mapf.write_mapf",
    },
    "waypoints": {
        ".csv": "tracks.csv.write_waypoints_csv",
        ".yaml": "tracks.nav_path.write_nav_path_yaml",
        ".json": "tracks.nav_path.write_nav_path_json",
        ".geojson": "tracks.geojson.write_geojson",
        ".sqlite": "tracks.jupedsim.write_jupedsim",
        ".mcap": "tracks.mcap.write_mcap",
    },
    "layers": {
        ".tmj": "tiled_layers.write_tiled",
    },
    "dependencies": {
        ORDER_SUFFIXES[0]: "orders.dependencies.write_dependencies_json",
        ORDER_SUFFIXES[1]: "orders.vda5050.write_vda5050",
    },
}


def function_at(place: str) -> Any:
    """Return a function by its path below `trihex.formats`."""
    module, _, name = place.rpartition(".")
    return getattr(import_module(f"trihex.formats.{module}"), name)


def writer_of(what: str, path: str | os.PathLike[str]) -> Any:
    """Return the function that writes `what` as the suffix of `path` says, else raise FormatError."""
    return function_at(WRITERS[what][suffix_of(path, WRITERS[what], what)])
