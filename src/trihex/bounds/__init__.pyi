from .arrivals import (
    EarliestArrivals as EarliestArrivals,
    arrivals_bound as arrivals_bound,
)
from .bound import LowerBound as LowerBound
from .bounds import (
    cut_bound as cut_bound,
    distance_bound as distance_bound,
    make_lower_bound as make_lower_bound,
    slot_bound as slot_bound,
)
from .chokes import (
    choke_cells as choke_cells,
)
from .spreading import queue_bound as queue_bound
