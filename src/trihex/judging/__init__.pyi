from .audit import (
    Audit as Audit,
    audit_plan as audit_plan,
)
from .conflict import (
    Conflict as Conflict,
)
from .corners import (
    count_corner_moves as count_corner_moves,
)
from .reach import (
    is_reachable as is_reachable,
)
from .report import (
    Report as Report,
    make_report as make_report,
)
from .score import (
    Score as Score,
    make_score as make_score,
)
