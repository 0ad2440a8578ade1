from .automaton import (
    OBSTACLE as OBSTACLE,
)
from .automaton import (
    CellularAutomaton as CellularAutomaton,
)
from .automaton import (
    LastGeneration as LastGeneration,
)
from .automaton import (
    distance_generations as distance_generations,
)
from .automaton import (
    make_distance_automaton as make_distance_automaton,
)
from .automaton import (
    make_distance_configuration as make_distance_configuration,
)
from .living import (
    LivingField as LivingField,
)
from .living import (
    Repair as Repair,
)
from .schemes import (
    DScheme as DScheme,
)
from .schemes import (
    NScheme as NScheme,
)
from .schemes import (
    make_d_scheme as make_d_scheme,
)
from .schemes import (
    make_n_scheme as make_n_scheme,
)
from .tiled import (
    TILE_SIDE as TILE_SIDE,
)
from .tiled import (
    TiledField as TiledField,
)
from .tiled import (
    make_tiled_field as make_tiled_field,
)
from .wave import (
    Wave as Wave,
)
from .wave import (
    renew_directions as renew_directions,
)
