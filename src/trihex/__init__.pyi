from .areas import (
    GENERATORS as GENERATORS,
)
from .areas import (
    Area as Area,
)
from .areas import (
    Frame as Frame,
)
from .areas import (
    Scenario as Scenario,
)
from .areas import (
    Tessellation as Tessellation,
)
from .areas import (
    make_caves_area as make_caves_area,
)
from .areas import (
    make_maze_area as make_maze_area,
)
from .areas import (
    make_random_area as make_random_area,
)
from .areas import (
    make_rooms_area as make_rooms_area,
)
from .areas import (
    make_warehouse_area as make_warehouse_area,
)
from .areas import (
    random_robots as random_robots,
)
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
from .errors import (
    AreaError as AreaError,
)
from .errors import (
    AutomatonError as AutomatonError,
)
from .errors import (
    ExecutionError as ExecutionError,
)
from .errors import (
    FormatError as FormatError,
)
from .errors import (
    MissingExtraError as MissingExtraError,
)
from .errors import (
    PlanError as PlanError,
)
from .errors import (
    ScenarioError as ScenarioError,
)
from .errors import (
    StudyError as StudyError,
)
from .errors import (
    TessellationError as TessellationError,
)
from .errors import (
    TooLargeError as TooLargeError,
)
from .errors import (
    TrihexError as TrihexError,
)
from .fields import (
    CellularAutomaton as CellularAutomaton,
)
from .fields import (
    DScheme as DScheme,
)
from .fields import (
    LastGeneration as LastGeneration,
)
from .fields import (
    LivingField as LivingField,
)
from .fields import (
    NScheme as NScheme,
)
from .fields import (
    TiledField as TiledField,
)
from .fields import (
    distance_generations as distance_generations,
)
from .fields import (
    make_d_scheme as make_d_scheme,
)
from .fields import (
    make_distance_automaton as make_distance_automaton,
)
from .fields import (
    make_distance_configuration as make_distance_configuration,
)
from .fields import (
    make_n_scheme as make_n_scheme,
)
from .fields import (
    make_tiled_field as make_tiled_field,
)
from .formats import (
    read_area as read_area,
)
from .formats import (
    read_events as read_events,
)
from .formats import (
    read_plan as read_plan,
)
from .formats import (
    read_run as read_run,
)
from .formats import (
    read_scenario as read_scenario,
)
from .formats import (
    read_starts as read_starts,
)
from .formats import (
    write_area as write_area,
)
from .formats import (
    write_events as write_events,
)
from .formats import (
    write_plan as write_plan,
)
from .formats import (
    write_report as write_report,
)
from .formats import (
    write_run as write_run,
)
from .formats import (
    write_scenario as write_scenario,
)
from .formats import (
    write_starts as write_starts,
)
from .formats import (
    write_waypoints as write_waypoints,
)
from .judging import (
    Audit as Audit,
)
from .judging import (
    Conflict as Conflict,
)
from .judging import (
    Report as Report,
)
from .judging import (
    audit_plan as audit_plan,
)
from .judging import (
    make_report as make_report,
)
from .pictures import (
    Picture as Picture,
)
from .pictures import (
    draw_area as draw_area,
)
from .pictures import (
    draw_arrivals as draw_arrivals,
)
from .pictures import (
    draw_comparison as draw_comparison,
)
from .pictures import (
    draw_d_scheme as draw_d_scheme,
)
from .pictures import (
    draw_n_scheme as draw_n_scheme,
)
from .pictures import (
    draw_plan as draw_plan,
)
from .pictures import (
    picture_of_area as picture_of_area,
)
from .pictures import (
    picture_of_d_scheme as picture_of_d_scheme,
)
from .pictures import (
    picture_of_generation as picture_of_generation,
)
from .pictures import (
    picture_of_n_scheme as picture_of_n_scheme,
)
from .pictures import (
    picture_of_plan as picture_of_plan,
)
from .pictures import (
    picture_of_run as picture_of_run,
)
from .pictures import (
    write_animation as write_animation,
)
from .pictures import (
    write_run_animation as write_run_animation,
)
from .planners import (
    make_plan as make_plan,
)
from .plans import (
    Arrivals as Arrivals,
)
from .plans import (
    Plan as Plan,
)
from .plans import (
    make_arrivals as make_arrivals,
)
from .running import (
    Event as Event,
)
from .running import (
    Execution as Execution,
)
from .running import (
    Follower as Follower,
)
from .running import (
    Occurrence as Occurrence,
)
from .running import (
    PassingOrder as PassingOrder,
)
from .running import (
    Run as Run,
)
from .running import (
    RunAudit as RunAudit,
)
from .running import (
    RunReport as RunReport,
)
from .running import (
    Sensor as Sensor,
)
from .running import (
    Trial as Trial,
)
from .running import (
    audit_run as audit_run,
)
from .running import (
    make_passing_order as make_passing_order,
)
from .running import (
    make_run_report as make_run_report,
)
from .running import (
    resume_trial as resume_trial,
)
from .studies import (
    Comparison as Comparison,
)
from .studies import (
    Study as Study,
)
from .studies import (
    make_comparison as make_comparison,
)
from .studies import (
    read_study as read_study,
)
from .studies import (
    run_study as run_study,
)
from .studies import (
    write_study as write_study,
)
from .viewer import (
    make_widget as make_widget,
)
from .viewer import (
    open_viewer as open_viewer,
)
from .viewer import (
    write_page as write_page,
)

__all__: list[str]
__version__: str
