from .audit import (
    Audit as Audit,
    Conflict as Conflict,
    audit_plan as audit_plan,
    is_reachable as is_reachable,
)
from .report import (
    Report as Report,
    make_report as make_report,
)
