from .cluster import (
    connected as connected,
)
from .comparison import (
    Comparison as Comparison,
    make_comparison as make_comparison,
    on_tessellations as on_tessellations,
)
from .dispatch import (
    run_study as run_study,
    write_study as write_study,
)
from .journal import (
    journal_of as journal_of,
)
from .results import (
    check_results as check_results,
    read_results as read_results,
)
from .study import (
    Study as Study,
    read_study as read_study,
)
