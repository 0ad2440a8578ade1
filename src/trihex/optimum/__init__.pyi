from .certificate import (
    Certificate as Certificate,
    check_certifiable as check_certifiable,
    check_equal_steps as check_equal_steps,
    make_certificate as make_certificate,
)
from .earliest import (
    make_earliest_flow as make_earliest_flow,
)
from .flow import (
    Flow as Flow,
    make_flow_singly as make_flow_singly,
)
from .network import (
    OBJECTIVES as OBJECTIVES,
    Network as Network,
    make_network as make_network,
)
from .paths import (
    make_plan_of_flow as make_plan_of_flow,
)
from .priced import (
    make_flow_at_prices as make_flow_at_prices,
)
from .variations import (
    Variations as Variations,
)
