"""Robots: those of a crowd who are under way, region by region."""

from typing import NamedTuple

from trihex.kernels.signatures import IN_I64, OUT_I32, OUT_I64, declared


class Robots(NamedTuple):
    """The robots of a `Crowd`."""

    first_of_region: IN_I64  # where in `listed` a region begins
    count_of_region: OUT_I64  # how many robots of a region have not arrived
    listed: OUT_I32  # these robots, region by region, in each those that started nearest first
    site: OUT_I32  # of a robot, 0 once it has arrived
    arrival: OUT_I64  # the step in which a robot arrives, 0 until then


ROBOTS = declared(Robots)
