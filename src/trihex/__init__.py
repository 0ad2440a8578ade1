"""Collision-free paths for many robots with a common goal on triangular, hexagonal and square tessellations.

All public names, each from the module that defines it. A module is imported when a name of it is first used, so that
``import trihex`` costs next to nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from trihex.area import Area as Area
    from trihex.audit import Audit as Audit
    from trihex.audit import Conflict as Conflict
    from trihex.audit import audit_plan as audit_plan
    from trihex.errors import AreaError as AreaError
    from trihex.errors import FormatError as FormatError
    from trihex.errors import MissingExtraError as MissingExtraError
    from trihex.errors import PlanError as PlanError
    from trihex.errors import ScenarioError as ScenarioError
    from trihex.errors import TessellationError as TessellationError
    from trihex.errors import TooLargeError as TooLargeError
    from trihex.errors import TrihexError as TrihexError
    from trihex.plan import Plan as Plan
    from trihex.scenario import Scenario as Scenario
    from trihex.scenario import random_robots as random_robots
    from trihex.tessellation import Tessellation as Tessellation

_MODULE_OF_NAME = {
    "Area": "area",
    "AreaError": "errors",
    "Audit": "audit",
    "Conflict": "audit",
    "FormatError": "errors",
    "MissingExtraError": "errors",
    "Plan": "plan",
    "PlanError": "errors",
    "Scenario": "scenario",
    "ScenarioError": "errors",
    "Tessellation": "tessellation",
    "TessellationError": "errors",
    "TooLargeError": "errors",
    "TrihexError": "errors",
    "audit_plan": "audit",
    "random_robots": "scenario",
}
__all__ = sorted(_MODULE_OF_NAME)
__version__ = "0.1.0"


def __getattr__(name: str) -> object:
    if name in _MODULE_OF_NAME:
        return getattr(import_module(f"trihex.{_MODULE_OF_NAME[name]}"), name)
    raise AttributeError(f"module 'trihex' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
