from .registry import (
    PLANNERS as PLANNERS,
)
from .registry import (
    RECORDS as RECORDS,
)
from .registry import (
    make_plan as make_plan,
)
from .registry import (
    options_of as options_of,
)
from .registry import (
    planner_named as planner_named,
)
