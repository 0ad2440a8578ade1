from .automaton import (
    CellularAutomaton as CellularAutomaton,
    LastGeneration as LastGeneration,
)
from .distance_automaton import (
    OBSTACLE as OBSTACLE,
    distance_generations as distance_generations,
    make_distance_automaton as make_distance_automaton,
    make_distance_configuration as make_distance_configuration,
)
from .living import (
    LivingField as LivingField,
    Repair as Repair,
)
from .priced import (
    PricedField as PricedField,
)
from .schemes import (
    DScheme as DScheme,
    NScheme as NScheme,
    make_d_scheme as make_d_scheme,
    make_n_scheme as make_n_scheme,
)
from .settling import (
    every_field_kernels as every_field_kernels,
    field_kernels as field_kernels,
)
from .steps import (
    steps_to_destination as steps_to_destination,
)
from .tiled import (
    TILE_SIDE as TILE_SIDE,
    TiledField as TiledField,
    make_tiled_field as make_tiled_field,
)
from .wave import (
    Wave as Wave,
    renew_directions as renew_directions,
)
