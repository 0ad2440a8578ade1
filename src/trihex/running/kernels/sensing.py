"""Sensing: which cells robots see from where they stand."""

from numba import njit, types

from trihex.kernels.signatures import IN_BOOL, IN_I32, OUT_I32, TABLE_I32


@njit(
    types.int64(
        IN_I32, TABLE_I32, TABLE_I32, TABLE_I32, IN_I32, IN_I32, *[types.int64] * 4, IN_BOOL, types.int32, OUT_I32,
        OUT_I32,
    ),
    cache=True,
    nogil=True,
)  # fmt: skip
def look(site, seen_dx, seen_dy, first, ray_dx, ray_dy, origin, pitch, height, width, blocked, step, since, news):
    """Stamp `since` with `step` where robots at `site` see a cell for the first time; fill those in `news`; count them.

    From a site of orientation o, column i of `seen_dx` and `seen_dy` is seen if no cell from ``first[o, i]`` to
    ``first[o, i + 1]`` of the rays is blocked. `news` has room for all cells.
    """
    count = 0
    for robot in range(len(site)):
        y, x = divmod(site[robot] - origin, pitch)
        side = site[robot] & 1
        for i in range(seen_dx.shape[1]):
            to_x = x + seen_dx[side, i]
            to_y = y + seen_dy[side, i]
            if to_x < 0 or to_y < 0 or to_x >= width or to_y >= height:
                continue
            target = origin + to_y * pitch + to_x
            if since[target] >= 0:
                continue
            is_seen = True
            for j in range(first[side, i], first[side, i + 1]):
                between_x = x + ray_dx[j]
                between_y = y + ray_dy[j]
                if between_x < 0 or between_y < 0 or between_x >= width or between_y >= height:
                    continue
                if blocked[origin + between_y * pitch + between_x]:
                    is_seen = False
                    break
            if is_seen:
                since[target] = step
                news[count] = target
                count += 1
    return count
