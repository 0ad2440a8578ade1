"""Pixel = cell: what is drawn at a point is the cell in whose polygon the point lies, and so is what is hit."""

import numpy as np
import pytest

import trihex as th
from tests.sweeps import swept
from tests.viewer.pages import is_near
from trihex.pictures import palette

HEIGHT, WIDTH, POINTS = 26, 33, 1000
HIT = """(points) => {
  const app = document.querySelector('#trihex').app, canvas = app.panes[0].canvas, box = canvas.getBoundingClientRect();
  return points.map(([x, y]) => {
    const place = { clientX: x + box.left, clientY: y + box.top, pointerId: 1 };
    canvas.dispatchEvent(new PointerEvent('pointermove', place));
    return Number(document.querySelector('.readout').dataset.cell ?? -1);
  });
}"""


def cells_of_points(tessellation, points):
    """Return the cell of each point by the polygons of all cells, -1 for none, and its distance from their edges."""
    y, x = np.divmod(np.arange(HEIGHT * WIDTH), WIDTH)
    corners = tessellation.polygon_of_cell(x, y)
    edges = np.roll(corners, -1, axis=1) - corners
    from_corner = points[:, None, None, :] - corners
    cross = edges[..., 0] * from_corner[..., 1] - edges[..., 1] * from_corner[..., 0]
    depth = (cross / np.linalg.norm(edges, axis=-1)).min(axis=-1)  # negative outside
    nearest = depth.argmax(axis=1)
    away = np.abs(depth).min(axis=1)
    return np.where(depth.max(axis=1) > 0, nearest, -1), away


@pytest.mark.parametrize("name", ["triangular", "hexagonal", "square"][: swept(3)])
def test_points_hit_the_cell_that_is_drawn_there(open_viewer, name):
    rng = np.random.default_rng(7)
    tessellation = th.Tessellation(name)
    area = th.Area(tessellation, rng.random((HEIGHT, WIDTH)) < 0.5)
    # Where robots may squeeze between walls that touch, gaps are drawn over their corners.
    shown = open_viewer(th.Scenario(area, np.flatnonzero(~area.barriers)[:1], corners="no-squeeze"))
    box = shown.page.locator("canvas").first.bounding_box()
    corner = np.array([box["x"], box["y"]])
    middle = box["x"] + box["width"] / 3, box["y"] + box["height"] / 3
    for factor in (1, 0.45, 1.9, 2.3, 3.1):  # from one look to the next
        if factor != 1:
            shown.page.mouse.move(*middle)
            for _ in range(round(abs(np.log(factor)) / 0.25)):
                shown.page.mouse.wheel(0, -100 * np.sign(np.log(factor)))
        shown.wait("!app.stage.isWaiting && !app.panes[0].isRough")
        scale, left, top = shown.view()
        pixels = np.floor(rng.random((POINTS, 2)) * [box["width"], box["height"]]) + 0.5
        points = (pixels + corner - (left, top)) / scale
        cells, away = cells_of_points(tessellation, points)
        hit = np.array(shown.page.evaluate(HIT, pixels.tolist()))
        is_clear = away > 1e-9  # a point on an edge belongs to either cell
        np.testing.assert_array_equal(hit[is_clear], cells[is_clear])
        assert np.count_nonzero(cells >= 0) > 100
        x, y = (pixels + corner).astype(int).T
        is_dark = is_near(shown.pixels()[y, x], palette.BARRIER)
        is_plain = (away * scale > 1.5) & (cells >= 0)  # neither an edge nor an outline
        np.testing.assert_array_equal(is_dark[is_plain], area.barriers.flat[cells[is_plain]])
    assert shown.faults == []


def test_a_click_paints_the_cell_under_the_pointer(open_viewer):
    shown = open_viewer(th.Scenario(th.Area("hexagonal", np.zeros((9, 11))), [(0, 0)]))
    for cell in ((4, 3), (5, 3), (10, 8)):
        shown.press("Wall")
        shown.click(*cell)
        assert is_near(shown.colours(), palette.BARRIER)[cell[1], cell[0]]
        shown.press("Erase")
        shown.click(*cell)
        assert not is_near(shown.colours(), palette.BARRIER).any()
