from .alignment import (
    ALIGNS as ALIGNS,
    cover_aligned as cover_aligned,
)
from .area import (
    MAX_CELLS as MAX_CELLS,
    Area as Area,
)
from .claim import (
    Claim as Claim,
    check_possible as check_possible,
    claimed as claimed,
)
from .clearance import (
    least_cell_size as least_cell_size,
    least_distance as least_distance,
    usual_following as usual_following,
)
from .coverage import (
    cover as cover,
    cover_polygons as cover_polygons,
    cover_raster as cover_raster,
)
from .door import (
    Door as Door,
    is_door_of_zone as is_door_of_zone,
    make_doors as make_doors,
)
from .entries import (
    entries_per_step as entries_per_step,
    ways_into_destinations as ways_into_destinations,
)
from .fit import (
    Fit as Fit,
    kinds_to_fit as kinds_to_fit,
    make_fits as make_fits,
    round_up_size as round_up_size,
)
from .flow import (
    check_flow as check_flow,
    flow_from as flow_from,
    flow_in_words as flow_in_words,
    plain_flow as plain_flow,
)
from .frame import (
    Frame as Frame,
)
from .generators import (
    GENERATORS as GENERATORS,
    make_caves_area as make_caves_area,
    make_maze_area as make_maze_area,
    make_random_area as make_random_area,
    make_rooms_area as make_rooms_area,
    make_warehouse_area as make_warehouse_area,
)
from .grid import (
    Covering as Covering,
)
from .ground import (
    DrawnGround as DrawnGround,
    Ground as Ground,
    RasterGround as RasterGround,
    import_shapely as import_shapely,
)
from .hexagons import (
    axial_to_xy as axial_to_xy,
    xy_to_axial as xy_to_axial,
)
from .layout import (
    Layout as Layout,
)
from .nearest import (
    nearest_free_cell as nearest_free_cell,
)
from .places import (
    cells_from as cells_from,
    numbers_from as numbers_from,
)
from .reaching import (
    least_advance as least_advance,
)
from .regions import (
    make_regions as make_regions,
)
from .scenario import (
    CORNERS as CORNERS,
    CROSSINGS as CROSSINGS,
    FOLLOWINGS as FOLLOWINGS,
    Scenario as Scenario,
)
from .schedule import (
    Schedule as Schedule,
)
from .seconds import (
    seconds_per_step as seconds_per_step,
)
from .slowness import (
    check_as_fast as check_as_fast,
    slowness_of as slowness_of,
)
from .standing import (
    random_robots as random_robots,
)
from .start_times import (
    check_distribution as check_distribution,
    random_start_times as random_start_times,
    start_times_of as start_times_of,
)
from .tessellation import (
    CLOCKS as CLOCKS,
    COSTS as COSTS,
    NEIGHBOURHOODS as NEIGHBOURHOODS,
    TESSELLATIONS as TESSELLATIONS,
    Tessellation as Tessellation,
    tessellation_from as tessellation_from,
)
from .touching import (
    shape_from as shape_from,
)
from .world import (
    World as World,
)
from .zone import (
    Zone as Zone,
    count_by_zone as count_by_zone,
)
