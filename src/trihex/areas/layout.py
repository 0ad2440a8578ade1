"""Layout: how the cells of an area lie in the padded flat arrays of the kernels."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from trihex.record import Record, read_only

if TYPE_CHECKING:
    from trihex.areas.tessellation import Tessellation  # which makes layouts


@dataclass(frozen=True, eq=False)
class Layout(Record):
    """How the cells of an area lie in the padded flat arrays of the kernels.

    Cell (x, y) is *site* ``origin + y * pitch + x``. The padding counts as barrier, so kernels need no bounds: rows
    share a margin of two sites, which the widest step of a triangle (two columns) never crosses. The pitch is odd for
    triangles, even for hexagons and the origin always even, so that ``site & 1`` is the orientation of the cell.
    (Squares have but one orientation; their tables hold it twice.)

    A lattice vertex bears the number of one of the cells around it: on triangles the north-pointing cell whose apex it
    is, on squares the cell to its south-east. These cells may lie in the padding, and no two vertices share one.
    """

    tessellation: Tessellation
    height: int
    width: int

    @cached_property
    def pitch(self) -> int:
        """Sites from one row to the next."""
        pitch = self.width + 2
        if pitch > 500 and (pitch + 8) % 512 < 16:
            pitch += 16  # rows 4 KiB apart keep throwing each other out of the cache: fields were 1.3 times slower
        wrong = {"triangular": pitch % 2 == 0, "hexagonal": pitch % 2 == 1, "square": False}
        return pitch + wrong[self.tessellation.name]

    @cached_property
    def origin(self) -> int:
        """Site of cell (0, 0)."""
        return (self.pitch + 3) // 2 * 2

    @cached_property
    def size(self) -> int:
        """Number of sites, padding included."""
        return self.origin + (self.height + 1) * self.pitch + 2

    def _offsets(self, steps: NDArray[np.int32]) -> NDArray[np.int32]:
        return read_only(np.ascontiguousarray(steps[..., 1] * self.pitch + steps[..., 0], dtype=np.int32))

    @cached_property
    def offset_of_direction(self) -> NDArray[np.int32]:
        """What to add to a site to get its neighbour, shape (2 orientations, directions)."""
        return self._offsets(self.tessellation.step_of_direction)

    @cached_property
    def back_of_direction(self) -> NDArray[np.int32]:
        """Which direction leads back from the neighbour, shape (2, directions)."""
        offset = self.offset_of_direction
        there = (np.arange(2)[:, None] + offset) & 1
        return read_only(np.argmax(offset[there] == -offset[:, :, None], axis=2).astype(np.int32))

    @cached_property
    def vertex_of_direction(self) -> NDArray[np.int32]:
        """What to add to a site to get the lattice vertex passed, shape (2, directions); 0 on edge moves."""
        return self._offsets(self.tessellation.vertex_step_of_direction)

    @cached_property
    def ring_of_vertex(self) -> NDArray[np.int32]:
        """What to add to the number of a lattice vertex to get the sites around it, clockwise, shape (6, 4 or 0,)."""
        return self._offsets(self.tessellation.steps_around_vertex)

    @cached_property
    def via_of_ring(self) -> NDArray[np.uint16]:
        """Bits of the directions that pass a lattice vertex from each of the sites around it, see `ring_of_vertex`."""
        via = np.zeros(self.ring_of_vertex.size, dtype=np.uint16)
        for i, offset in enumerate(self.ring_of_vertex):
            # The numbers of vertices are even on triangles, where alone the orientation matters.
            for k in range(self.tessellation.edge_count, self.tessellation.direction_count):
                if self.vertex_of_direction[offset & 1, k] == -offset:
                    via[i] |= 1 << k
        return read_only(via)

    def cell_to_site(self, cell: NDArray[np.int64]) -> NDArray[np.int32]:
        """Return the sites of cells given by number (y * width + x)."""
        y, x = np.divmod(cell, self.width)
        return (self.origin + y * self.pitch + x).astype(np.int32)

    def site_to_cell(self, site: NDArray[np.int32]) -> NDArray[np.int64]:
        """Return the numbers of the cells at sites; the inverse of `cell_to_site`."""
        cell = site.astype(np.int64)
        cell -= self.origin
        row = cell // self.pitch
        row *= self.pitch - self.width
        cell -= row  # all in place: with new arrays it takes five times as long
        return np.asarray(cell)

    def view_of(self, sites: NDArray[Any]) -> NDArray[Any]:
        """Return the part of a padded array that belongs to cells, as a (height, width) view to write to."""
        return self._rows_of(sites)[:, : self.width]

    def margin_of(self, sites: NDArray[Any]) -> NDArray[Any]:
        """Return the part of a padded array that lies between one row of cells and the next, as a view to write to."""
        return self._rows_of(sites)[:, self.width :]

    def cells_of(self, sites: NDArray[np.generic]) -> NDArray[np.generic]:
        """Return the part of a padded array that belongs to cells, as a read-only (height, width) view."""
        return read_only(self.view_of(sites))

    def _rows_of(self, sites: NDArray[Any]) -> NDArray[Any]:
        return sites[self.origin : self.origin + self.height * self.pitch].reshape(self.height, self.pitch)
