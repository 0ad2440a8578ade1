from .bounds import (
    LowerBound as LowerBound,
)
from .bounds import (
    cut_bound as cut_bound,
)
from .bounds import (
    distance_bound as distance_bound,
)
from .bounds import (
    make_lower_bound as make_lower_bound,
)
from .bounds import (
    slot_bound as slot_bound,
)
