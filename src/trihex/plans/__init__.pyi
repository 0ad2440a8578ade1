from .arrivals import (
    Arrivals as Arrivals,
    make_arrivals as make_arrivals,
)
from .dependencies import (
    Dependencies as Dependencies,
    make_dependencies as make_dependencies,
)
from .plan import (
    Plan as Plan,
    actions_of as actions_of,
    plan_from_lists as plan_from_lists,
)
from .playback import (
    make_playback as make_playback,
)
from .walk import (
    Walk as Walk,
    cells_of_rows as cells_of_rows,
    count_marked_moves as count_marked_moves,
    place_of_action as place_of_action,
    steps_of_actions as steps_of_actions,
    visits_of as visits_of,
    waits_by_step as waits_by_step,
)
