from .arrivals import (
    Arrivals as Arrivals,
    make_arrivals as make_arrivals,
)
from .dependencies import (
    Dependencies as Dependencies,
    check_orderable as check_orderable,
    make_dependencies as make_dependencies,
)
from .exits import (
    Exits as Exits,
    exits_among as exits_among,
    make_exits as make_exits,
)
from .maps import (
    make_density_map as make_density_map,
    make_waiting_map as make_waiting_map,
)
from .motion import (
    Motion as Motion,
    seconds_of_arrivals as seconds_of_arrivals,
)
from .plan import (
    Plan as Plan,
    actions_of as actions_of,
    plan_from_lists as plan_from_lists,
)
from .playback import (
    make_playback as make_playback,
)
from .rows import (
    cells_of_rows as cells_of_rows,
    rows_of_actions as rows_of_actions,
    rows_of_motion as rows_of_motion,
    steps_of_actions as steps_of_actions,
)
from .trajectories import (
    Trajectories as Trajectories,
)
from .turning import (
    turning_of_robot as turning_of_robot,
)
from .turns import (
    in_turn as in_turn,
)
from .walk import (
    Walk as Walk,
    count_marked_moves as count_marked_moves,
    place_of_action as place_of_action,
    visits_of as visits_of,
    waits_by_step as waits_by_step,
)
