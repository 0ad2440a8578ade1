from .draft import (
    Draft as Draft,
)
from .draft import (
    draft_of as draft_of,
)
from .field_npy import (
    write_field as write_field,
)
from .reading import (
    read_area as read_area,
)
from .reading import (
    read_draft as read_draft,
)
from .reading import (
    read_plan as read_plan,
)
from .reading import (
    read_scenario as read_scenario,
)
from .recognise import (
    NAME_OF_FORMAT as NAME_OF_FORMAT,
)
from .recognise import (
    format_of as format_of,
)
from .report_json import (
    report_text as report_text,
)
from .report_json import (
    write_report as write_report,
)
from .runs.events import (
    read_events as read_events,
)
from .runs.events import (
    write_events as write_events,
)
from .runs.npz import (
    read_run as read_run,
)
from .runs.npz import (
    write_run as write_run,
)
from .starts.csv import (
    write_starts as write_starts,
)
from .starts.starts import (
    read_starts as read_starts,
)
from .toml import (
    complaint as complaint,
)
from .toml import (
    parse_toml as parse_toml,
)
from .values_csv import (
    write_values as write_values,
)
from .writing import (
    AREA_SUFFIXES as AREA_SUFFIXES,
)
from .writing import (
    PLAN_SUFFIXES as PLAN_SUFFIXES,
)
from .writing import (
    SCENARIO_SUFFIXES as SCENARIO_SUFFIXES,
)
from .writing import (
    WAYPOINT_SUFFIXES as WAYPOINT_SUFFIXES,
)
from .writing import (
    write_area as write_area,
)
from .writing import (
    write_plan as write_plan,
)
from .writing import (
    write_scenario as write_scenario,
)
from .writing import (
    write_waypoints as write_waypoints,
)
