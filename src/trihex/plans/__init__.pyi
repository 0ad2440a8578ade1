from .arrivals import (
    Arrivals as Arrivals,
)
from .arrivals import (
    make_arrivals as make_arrivals,
)
from .plan import (
    Plan as Plan,
)
from .plan import (
    follow as follow,
)
from .plan import (
    plan_from_lists as plan_from_lists,
)
from .playback import (
    make_playback as make_playback,
)
