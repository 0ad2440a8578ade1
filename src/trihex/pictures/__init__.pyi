from .movie import (
    MOVIE_SUFFIXES as MOVIE_SUFFIXES,
)
from .movie import (
    write_animation as write_animation,
)
from .picture import (
    PICTURE_SUFFIXES as PICTURE_SUFFIXES,
)
from .picture import (
    Picture as Picture,
)
from .picture import (
    picture_of_area as picture_of_area,
)
from .picture import (
    picture_of_d_scheme as picture_of_d_scheme,
)
from .picture import (
    picture_of_generation as picture_of_generation,
)
from .picture import (
    picture_of_n_scheme as picture_of_n_scheme,
)
from .picture import (
    picture_of_plan as picture_of_plan,
)
from .plotting import (
    draw_area as draw_area,
)
from .plotting import (
    draw_arrivals as draw_arrivals,
)
from .plotting import (
    draw_comparison as draw_comparison,
)
from .plotting import (
    draw_d_scheme as draw_d_scheme,
)
from .plotting import (
    draw_n_scheme as draw_n_scheme,
)
from .plotting import (
    draw_plan as draw_plan,
)
from .preview import (
    preview_lines as preview_lines,
)
from .run_movie import (
    write_run_animation as write_run_animation,
)
from .run_picture import (
    FOG as FOG,
)
from .run_picture import (
    FOG_BARRIER as FOG_BARRIER,
)
from .run_picture import (
    picture_of_run as picture_of_run,
)
