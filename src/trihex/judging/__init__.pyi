from .audit import (
    Audit as Audit,
)
from .audit import (
    Conflict as Conflict,
)
from .audit import (
    audit_plan as audit_plan,
)
from .audit import (
    is_reachable as is_reachable,
)
from .report import (
    Report as Report,
)
from .report import (
    make_report as make_report,
)
