"""Collision-free paths for many robots with a common goal on triangular, hexagonal and square tessellations.

All public names, each from the module that defines it. A module is imported when a name of it is first used, so that
``import trihex`` costs next to nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from trihex.area import Area as Area
    from trihex.arrivals import Arrivals as Arrivals
    from trihex.arrivals import make_arrivals as make_arrivals
    from trihex.audit import Audit as Audit
    from trihex.audit import Conflict as Conflict
    from trihex.audit import audit_plan as audit_plan
    from trihex.automaton import CellularAutomaton as CellularAutomaton
    from trihex.automaton import LastGeneration as LastGeneration
    from trihex.automaton import distance_generations as distance_generations
    from trihex.automaton import make_distance_automaton as make_distance_automaton
    from trihex.automaton import make_distance_configuration as make_distance_configuration
    from trihex.bounds import LowerBound as LowerBound
    from trihex.bounds import cut_bound as cut_bound
    from trihex.bounds import distance_bound as distance_bound
    from trihex.bounds import make_lower_bound as make_lower_bound
    from trihex.bounds import slot_bound as slot_bound
    from trihex.comparison import Comparison as Comparison
    from trihex.comparison import make_comparison as make_comparison
    from trihex.errors import AreaError as AreaError
    from trihex.errors import AutomatonError as AutomatonError
    from trihex.errors import ExecutionError as ExecutionError
    from trihex.errors import FormatError as FormatError
    from trihex.errors import MissingExtraError as MissingExtraError
    from trihex.errors import PlanError as PlanError
    from trihex.errors import ScenarioError as ScenarioError
    from trihex.errors import StudyError as StudyError
    from trihex.errors import TessellationError as TessellationError
    from trihex.errors import TooLargeError as TooLargeError
    from trihex.errors import TrihexError as TrihexError
    from trihex.events import Event as Event
    from trihex.events import Occurrence as Occurrence
    from trihex.execution import Execution as Execution
    from trihex.formats import read_area as read_area
    from trihex.formats import read_plan as read_plan
    from trihex.formats import read_scenario as read_scenario
    from trihex.formats import read_starts as read_starts
    from trihex.formats import write_area as write_area
    from trihex.formats import write_plan as write_plan
    from trihex.formats import write_scenario as write_scenario
    from trihex.formats import write_starts as write_starts
    from trihex.formats import write_waypoints as write_waypoints
    from trihex.formats.events import read_events as read_events
    from trihex.formats.events import write_events as write_events
    from trihex.formats.report_json import write_report as write_report
    from trihex.formats.run_npz import read_run as read_run
    from trihex.formats.run_npz import write_run as write_run
    from trihex.frame import Frame as Frame
    from trihex.generators import GENERATORS as GENERATORS
    from trihex.generators import make_caves_area as make_caves_area
    from trihex.generators import make_maze_area as make_maze_area
    from trihex.generators import make_random_area as make_random_area
    from trihex.generators import make_rooms_area as make_rooms_area
    from trihex.generators import make_warehouse_area as make_warehouse_area
    from trihex.living import LivingField as LivingField
    from trihex.movie import write_animation as write_animation
    from trihex.passing import Follower as Follower
    from trihex.passing import PassingOrder as PassingOrder
    from trihex.passing import make_passing_order as make_passing_order
    from trihex.picture import Picture as Picture
    from trihex.picture import picture_of_area as picture_of_area
    from trihex.picture import picture_of_d_scheme as picture_of_d_scheme
    from trihex.picture import picture_of_generation as picture_of_generation
    from trihex.picture import picture_of_n_scheme as picture_of_n_scheme
    from trihex.picture import picture_of_plan as picture_of_plan
    from trihex.plan import Plan as Plan
    from trihex.planners import make_plan as make_plan
    from trihex.plotting import draw_area as draw_area
    from trihex.plotting import draw_arrivals as draw_arrivals
    from trihex.plotting import draw_comparison as draw_comparison
    from trihex.plotting import draw_d_scheme as draw_d_scheme
    from trihex.plotting import draw_n_scheme as draw_n_scheme
    from trihex.plotting import draw_plan as draw_plan
    from trihex.report import Report as Report
    from trihex.report import make_report as make_report
    from trihex.run import Run as Run
    from trihex.run_audit import RunAudit as RunAudit
    from trihex.run_audit import audit_run as audit_run
    from trihex.run_movie import write_run_animation as write_run_animation
    from trihex.run_picture import picture_of_run as picture_of_run
    from trihex.run_report import RunReport as RunReport
    from trihex.run_report import make_run_report as make_run_report
    from trihex.scenario import Scenario as Scenario
    from trihex.scenario import random_robots as random_robots
    from trihex.schemes import DScheme as DScheme
    from trihex.schemes import NScheme as NScheme
    from trihex.schemes import make_d_scheme as make_d_scheme
    from trihex.schemes import make_n_scheme as make_n_scheme
    from trihex.sensing import Sensor as Sensor
    from trihex.studies.run import run_study as run_study
    from trihex.studies.run import write_study as write_study
    from trihex.studies.study import Study as Study
    from trihex.studies.study import read_study as read_study
    from trihex.tessellation import Tessellation as Tessellation
    from trihex.tiled import TiledField as TiledField
    from trihex.tiled import make_tiled_field as make_tiled_field
    from trihex.trial import Trial as Trial
    from trihex.trial import resume_trial as resume_trial
    from trihex.viewer.launch import open_viewer as open_viewer
    from trihex.viewer.page import write_page as write_page
    from trihex.viewer.widget import make_widget as make_widget

_MODULE_OF_NAME = {
    "Area": "area",
    "AreaError": "errors",
    "Arrivals": "arrivals",
    "Audit": "audit",
    "AutomatonError": "errors",
    "CellularAutomaton": "automaton",
    "Comparison": "comparison",
    "Conflict": "audit",
    "DScheme": "schemes",
    "Event": "events",
    "Execution": "execution",
    "ExecutionError": "errors",
    "Follower": "passing",
    "FormatError": "errors",
    "Frame": "frame",
    "GENERATORS": "generators",
    "LastGeneration": "automaton",
    "LivingField": "living",
    "LowerBound": "bounds",
    "MissingExtraError": "errors",
    "NScheme": "schemes",
    "Occurrence": "events",
    "PassingOrder": "passing",
    "Picture": "picture",
    "Plan": "plan",
    "PlanError": "errors",
    "Report": "report",
    "Run": "run",
    "RunAudit": "run_audit",
    "RunReport": "run_report",
    "Scenario": "scenario",
    "ScenarioError": "errors",
    "Sensor": "sensing",
    "Study": "studies.study",
    "StudyError": "errors",
    "Tessellation": "tessellation",
    "TessellationError": "errors",
    "TiledField": "tiled",
    "TooLargeError": "errors",
    "Trial": "trial",
    "TrihexError": "errors",
    "audit_plan": "audit",
    "audit_run": "run_audit",
    "cut_bound": "bounds",
    "distance_bound": "bounds",
    "distance_generations": "automaton",
    "draw_area": "plotting",
    "draw_arrivals": "plotting",
    "draw_comparison": "plotting",
    "draw_d_scheme": "plotting",
    "draw_n_scheme": "plotting",
    "draw_plan": "plotting",
    "make_arrivals": "arrivals",
    "make_caves_area": "generators",
    "make_comparison": "comparison",
    "make_d_scheme": "schemes",
    "make_distance_automaton": "automaton",
    "make_distance_configuration": "automaton",
    "make_lower_bound": "bounds",
    "make_maze_area": "generators",
    "make_n_scheme": "schemes",
    "make_passing_order": "passing",
    "make_plan": "planners",
    "make_random_area": "generators",
    "make_report": "report",
    "make_rooms_area": "generators",
    "make_run_report": "run_report",
    "make_tiled_field": "tiled",
    "make_warehouse_area": "generators",
    "make_widget": "viewer.widget",
    "open_viewer": "viewer.launch",
    "picture_of_area": "picture",
    "picture_of_d_scheme": "picture",
    "picture_of_generation": "picture",
    "picture_of_n_scheme": "picture",
    "picture_of_plan": "picture",
    "picture_of_run": "run_picture",
    "random_robots": "scenario",
    "read_area": "formats",
    "read_events": "formats.events",
    "read_plan": "formats",
    "read_run": "formats.run_npz",
    "read_scenario": "formats",
    "read_starts": "formats",
    "read_study": "studies.study",
    "resume_trial": "trial",
    "run_study": "studies.run",
    "slot_bound": "bounds",
    "write_animation": "movie",
    "write_area": "formats",
    "write_events": "formats.events",
    "write_page": "viewer.page",
    "write_plan": "formats",
    "write_report": "formats.report_json",
    "write_run": "formats.run_npz",
    "write_run_animation": "run_movie",
    "write_scenario": "formats",
    "write_starts": "formats",
    "write_study": "studies.run",
    "write_waypoints": "formats",
}
__all__ = sorted(_MODULE_OF_NAME)
__version__ = "0.1.0"


def __getattr__(name: str) -> object:
    if name in _MODULE_OF_NAME:
        return getattr(import_module(f"trihex.{_MODULE_OF_NAME[name]}"), name)
    raise AttributeError(f"module 'trihex' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
