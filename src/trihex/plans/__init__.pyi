from .arrivals import (
    Arrivals as Arrivals,
    make_arrivals as make_arrivals,
)
from .plan import (
    Plan as Plan,
    follow as follow,
    plan_from_lists as plan_from_lists,
)
from .playback import (
    make_playback as make_playback,
)
