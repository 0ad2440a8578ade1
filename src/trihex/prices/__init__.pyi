from .making import (
    make_prices as make_prices,
)
from .prices import (
    KINDS as KINDS,
    Prices as Prices,
)
