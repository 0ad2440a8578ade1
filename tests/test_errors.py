"""Checks that all packages share: a whole number within its bounds."""

import numpy as np
import pytest

from trihex.errors import AreaError, ScenarioError, check_whole


@pytest.mark.parametrize("value", [2, 7, np.int32(2), np.uint8(7)])
def test_a_whole_number_within_its_bounds_passes(value):
    check_whole("room", value, 2, 7, AreaError)
    check_whole("room", value, 2, None, AreaError)


@pytest.mark.parametrize("value", [1, 8, -3, True, np.True_, 2.0, "2", None, np.array([2])])
def test_anything_else_is_refused_with_its_bounds(value):
    with pytest.raises(ScenarioError, match="room must be a whole number from 2 to 7, not"):
        check_whole("room", value, 2, 7, ScenarioError)


def test_where_there_is_no_end_none_is_named():
    with pytest.raises(AreaError, match=r"^seed must be a whole number from 0, not -1$"):
        check_whole("seed", -1, 0, None, AreaError)
    check_whole("seed", 10**30, 0, None, AreaError)
