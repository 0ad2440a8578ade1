from .area_picture import (
    picture_of_area as picture_of_area,
)
from .axes import (
    check_matplotlib as check_matplotlib,
)
from .charts import (
    draw_arrivals as draw_arrivals,
    draw_comparison as draw_comparison,
    draw_exits as draw_exits,
    draw_score as draw_score,
)
from .film import (
    MOVIE_SUFFIXES as MOVIE_SUFFIXES,
)
from .fits import (
    write_fits as write_fits,
)
from .generations import (
    draw_generations as draw_generations,
)
from .map_picture import (
    picture_of_density as picture_of_density,
    picture_of_lost as picture_of_lost,
    picture_of_waiting as picture_of_waiting,
)
from .movie import (
    write_animation as write_animation,
)
from .picture import (
    PICTURE_SUFFIXES as PICTURE_SUFFIXES,
    Picture as Picture,
)
from .plan_picture import (
    picture_of_plan as picture_of_plan,
)
from .plotting import (
    draw_area as draw_area,
    draw_d_scheme as draw_d_scheme,
    draw_generation as draw_generation,
    draw_n_scheme as draw_n_scheme,
    draw_plan as draw_plan,
    draw_prices as draw_prices,
)
from .preview import (
    preview_lines as preview_lines,
)
from .price_picture import (
    picture_of_prices as picture_of_prices,
)
from .run_movie import (
    write_run_animation as write_run_animation,
)
from .run_picture import (
    FOG as FOG,
    FOG_BARRIER as FOG_BARRIER,
    picture_of_run as picture_of_run,
)
from .scheme_picture import (
    picture_of_d_scheme as picture_of_d_scheme,
    picture_of_generation as picture_of_generation,
    picture_of_n_scheme as picture_of_n_scheme,
)
