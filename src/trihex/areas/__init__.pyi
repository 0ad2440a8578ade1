from .area import (
    MAX_CELLS as MAX_CELLS,
)
from .area import (
    Area as Area,
)
from .area import (
    cells_from as cells_from,
)
from .coverage import (
    Covering as Covering,
)
from .coverage import (
    cover_polygons as cover_polygons,
)
from .coverage import (
    cover_raster as cover_raster,
)
from .coverage import (
    import_shapely as import_shapely,
)
from .frame import (
    Frame as Frame,
)
from .generators import (
    GENERATORS as GENERATORS,
)
from .generators import (
    make_caves_area as make_caves_area,
)
from .generators import (
    make_maze_area as make_maze_area,
)
from .generators import (
    make_random_area as make_random_area,
)
from .generators import (
    make_rooms_area as make_rooms_area,
)
from .generators import (
    make_warehouse_area as make_warehouse_area,
)
from .ground import (
    Ground as Ground,
)
from .regions import (
    make_regions as make_regions,
)
from .scenario import (
    CORNERS as CORNERS,
)
from .scenario import (
    CROSSINGS as CROSSINGS,
)
from .scenario import (
    Scenario as Scenario,
)
from .scenario import (
    random_robots as random_robots,
)
from .tessellation import (
    COSTS as COSTS,
)
from .tessellation import (
    NEIGHBOURHOODS as NEIGHBOURHOODS,
)
from .tessellation import (
    TESSELLATIONS as TESSELLATIONS,
)
from .tessellation import (
    Layout as Layout,
)
from .tessellation import (
    Tessellation as Tessellation,
)
