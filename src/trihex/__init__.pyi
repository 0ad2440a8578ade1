from .areas import (
    GENERATORS as GENERATORS,
    Area as Area,
    Frame as Frame,
    Scenario as Scenario,
    Tessellation as Tessellation,
    Zone as Zone,
    make_caves_area as make_caves_area,
    make_maze_area as make_maze_area,
    make_random_area as make_random_area,
    make_rooms_area as make_rooms_area,
    make_warehouse_area as make_warehouse_area,
    random_robots as random_robots,
)
from .bounds import (
    LowerBound as LowerBound,
    cut_bound as cut_bound,
    distance_bound as distance_bound,
    make_lower_bound as make_lower_bound,
    slot_bound as slot_bound,
)
from .errors import (
    AreaError as AreaError,
    ArgumentError as ArgumentError,
    AutomatonError as AutomatonError,
    ExecutionError as ExecutionError,
    FormatError as FormatError,
    MissingExtraError as MissingExtraError,
    PlanError as PlanError,
    ScenarioError as ScenarioError,
    StudyError as StudyError,
    TessellationError as TessellationError,
    TooLargeError as TooLargeError,
    TrihexError as TrihexError,
)
from .fields import (
    CellularAutomaton as CellularAutomaton,
    DScheme as DScheme,
    LastGeneration as LastGeneration,
    LivingField as LivingField,
    NScheme as NScheme,
    TiledField as TiledField,
    distance_generations as distance_generations,
    make_d_scheme as make_d_scheme,
    make_distance_automaton as make_distance_automaton,
    make_distance_configuration as make_distance_configuration,
    make_n_scheme as make_n_scheme,
    make_tiled_field as make_tiled_field,
)
from .formats import (
    read_area as read_area,
    read_events as read_events,
    read_plan as read_plan,
    read_run as read_run,
    read_scenario as read_scenario,
    read_starts as read_starts,
    write_area as write_area,
    write_events as write_events,
    write_plan as write_plan,
    write_report as write_report,
    write_run as write_run,
    write_scenario as write_scenario,
    write_starts as write_starts,
    write_tiled as write_tiled,
    write_waypoints as write_waypoints,
)
from .judging import (
    Audit as Audit,
    Conflict as Conflict,
    Report as Report,
    audit_plan as audit_plan,
    make_report as make_report,
)
from .pictures import (
    Picture as Picture,
    draw_area as draw_area,
    draw_arrivals as draw_arrivals,
    draw_comparison as draw_comparison,
    draw_d_scheme as draw_d_scheme,
    draw_generation as draw_generation,
    draw_generations as draw_generations,
    draw_n_scheme as draw_n_scheme,
    draw_plan as draw_plan,
    picture_of_area as picture_of_area,
    picture_of_d_scheme as picture_of_d_scheme,
    picture_of_generation as picture_of_generation,
    picture_of_n_scheme as picture_of_n_scheme,
    picture_of_plan as picture_of_plan,
    picture_of_run as picture_of_run,
    write_animation as write_animation,
    write_run_animation as write_run_animation,
)
from .planners import (
    make_plan as make_plan,
)
from .plans import (
    Arrivals as Arrivals,
    Plan as Plan,
    make_arrivals as make_arrivals,
)
from .running import (
    Event as Event,
    Execution as Execution,
    Follower as Follower,
    Occurrence as Occurrence,
    PassingOrder as PassingOrder,
    Run as Run,
    RunAudit as RunAudit,
    RunReport as RunReport,
    Sensor as Sensor,
    Trial as Trial,
    audit_run as audit_run,
    make_passing_order as make_passing_order,
    make_run_report as make_run_report,
    resume_trial as resume_trial,
)
from .studies import (
    Comparison as Comparison,
    Study as Study,
    make_comparison as make_comparison,
    read_results as read_results,
    read_study as read_study,
    run_study as run_study,
    write_study as write_study,
)
from .viewer import (
    make_widget as make_widget,
    open_viewer as open_viewer,
    write_page as write_page,
    write_site as write_site,
)

__all__: list[str]
__version__: str
