from .earliest import (
    make_earliest_arrivals as make_earliest_arrivals,
)
from .naming import (
    planner_from as planner_from,
)
from .registry import (
    PLANNERS as PLANNERS,
    RECORDS as RECORDS,
    check_plannable as check_plannable,
    check_planner_options as check_planner_options,
    make_plan as make_plan,
    options_of as options_of,
    planner_named as planner_named,
    uses_of as uses_of,
)
from .straighten import (
    check_straightenable as check_straightenable,
    straighten as straighten,
)
