from .cluster import (
    connected as connected,
)
from .comparison import (
    Comparison as Comparison,
)
from .comparison import (
    make_comparison as make_comparison,
)
from .comparison import (
    on_tessellations as on_tessellations,
)
from .dispatch import (
    run_study as run_study,
)
from .dispatch import (
    write_study as write_study,
)
from .journal import (
    journal_of as journal_of,
)
from .results import (
    check_results as check_results,
)
from .study import (
    Study as Study,
)
from .study import (
    read_study as read_study,
)
