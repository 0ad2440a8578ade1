from .audit import (
    RunAudit as RunAudit,
)
from .audit import (
    audit_run as audit_run,
)
from .events import (
    KINDS as KINDS,
)
from .events import (
    MOST_STEPS as MOST_STEPS,
)
from .events import (
    Event as Event,
)
from .events import (
    Occurrence as Occurrence,
)
from .execution import (
    Execution as Execution,
)
from .passing import (
    Follower as Follower,
)
from .passing import (
    PassingOrder as PassingOrder,
)
from .passing import (
    make_passing_order as make_passing_order,
)
from .report import (
    RunReport as RunReport,
)
from .report import (
    make_run_report as make_run_report,
)
from .run import (
    ARRIVED as ARRIVED,
)
from .run import (
    BROKEN as BROKEN,
)
from .run import (
    GOING as GOING,
)
from .run import (
    LEFT as LEFT,
)
from .run import (
    Run as Run,
)
from .sensing import (
    Sensor as Sensor,
)
from .trial import (
    Trial as Trial,
)
from .trial import (
    resume_trial as resume_trial,
)
