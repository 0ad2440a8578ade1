from .audit import (
    RunAudit as RunAudit,
    audit_run as audit_run,
)
from .events import (
    KINDS as KINDS,
    MOST_STEPS as MOST_STEPS,
    OF_SHAPES as OF_SHAPES,
    OF_ZONES as OF_ZONES,
    Event as Event,
    Occurrence as Occurrence,
)
from .execution import (
    Execution as Execution,
)
from .follower import Follower as Follower
from .orders import Orders as Orders
from .passing import (
    PassingOrder as PassingOrder,
    make_passing_order as make_passing_order,
)
from .replanning import check_followable as check_followable
from .report import (
    RunReport as RunReport,
    make_run_report as make_run_report,
)
from .run import (
    ARRIVED as ARRIVED,
    BROKEN as BROKEN,
    GOING as GOING,
    LEFT as LEFT,
    Run as Run,
)
from .sensing import (
    Sensor as Sensor,
)
from .trial import (
    Trial as Trial,
    resume_trial as resume_trial,
)
