from .areas.dxf import (
    read_layers as read_layers,
)
from .areas.options import (
    AreaOptions as AreaOptions,
    NoRoomError as NoRoomError,
)
from .certificate_csv import (
    CERTIFICATE_SUFFIXES as CERTIFICATE_SUFFIXES,
    write_certificate as write_certificate,
)
from .draft import (
    Draft as Draft,
    draft_of as draft_of,
)
from .field_npy import (
    write_field as write_field,
)
from .prices_csv import (
    PRICES_SUFFIXES as PRICES_SUFFIXES,
    write_prices as write_prices,
)
from .prices_journal import (
    PricesJournal as PricesJournal,
)
from .reading import (
    likeness_of as likeness_of,
    read_area as read_area,
    read_draft as read_draft,
    read_plan as read_plan,
    read_scenario as read_scenario,
)
from .recognise import (
    format_of as format_of,
)
from .registry import (
    FORMATS as FORMATS,
    WRITERS as WRITERS,
)
from .report_json import (
    report_text as report_text,
    write_report as write_report,
)
from .runs.events import (
    read_events as read_events,
    write_events as write_events,
)
from .runs.npz import (
    is_run as is_run,
    read_run as read_run,
    write_run as write_run,
)
from .starts.csv import (
    write_starts as write_starts,
)
from .starts.starts import (
    read_slowness as read_slowness,
    read_start_times as read_start_times,
    read_starts as read_starts,
)
from .text import (
    check_text as check_text,
    read_text as read_text,
)
from .tiled_layers import (
    write_tiled as write_tiled,
)
from .toml import (
    complaint as complaint,
    read_toml as read_toml,
)
from .tracks.trajectories import (
    read_trajectories as read_trajectories,
)
from .values_csv import (
    write_values as write_values,
)
from .writing import (
    AREA_SUFFIXES as AREA_SUFFIXES,
    DEPENDENCY_SUFFIXES as DEPENDENCY_SUFFIXES,
    LAYER_SUFFIXES as LAYER_SUFFIXES,
    PLAN_SUFFIXES as PLAN_SUFFIXES,
    SCENARIO_SUFFIXES as SCENARIO_SUFFIXES,
    WAYPOINT_SUFFIXES as WAYPOINT_SUFFIXES,
    write_area as write_area,
    write_dependencies as write_dependencies,
    write_plan as write_plan,
    write_scenario as write_scenario,
    write_waypoints as write_waypoints,
)
