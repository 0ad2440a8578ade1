from .launch import (
    open_viewer as open_viewer,
)
from .page import (
    PAGE_SUFFIXES as PAGE_SUFFIXES,
    write_page as write_page,
    write_report_page as write_report_page,
)
from .site import (
    write_site as write_site,
)
from .widget import (
    make_widget as make_widget,
)
