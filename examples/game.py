"""The loop of a game, with numpy alone: two teams that want to each other's base, units in the way, gates that shut."""

import sys
from pathlib import Path
from time import process_time  # a busy machine would be measured, too, by its clock

import numpy as np
from PIL import Image, ImageDraw

import trihex as th

FRAMES, UNITS = 600, 100
BASES = [(4, 30), (76, 30)]
COLOURS = [(200, 60, 50), (50, 90, 190)]
STRIKE = 0.05  # how likely a unit strikes who stands in its way
FAR = np.iinfo(np.int32).max  # what a field holds where nobody comes from


def make_ground():
    """Return rocks, a wall from north to south, and the six gates in it."""
    barriers = th.make_random_area("hexagonal", 60, 81, density=0.2, seed=5).barriers.copy()
    barriers[24:36, :16] = barriers[:, 30:50] = False  # room for the bases and in the middle
    barriers[:, 41:] = barriers[:, 39::-1]  # as fair as a mirror
    barriers[:, 40] = True
    gates = [[(40, y + dy) for dy in range(3)] for y in range(4, 60, 10)]
    for gate in gates:
        for x, y in gate:
            barriers[y, x] = False
    return th.Area("hexagonal", barriers), gates


def make_neighbours(area):
    """Return the cell in each direction of each cell, itself where there is none; shape (cells, directions)."""
    x, y = area.cell_to_xy(np.arange(area.cell_count))
    step = area.tessellation.step_of_direction[area.tessellation.orientation_of_cell(x, y)]
    there_x, there_y = x[:, None] + step[..., 0], y[:, None] + step[..., 1]
    is_inside = (there_x >= 0) & (there_x < area.width) & (there_y >= 0) & (there_y < area.height)
    return np.where(is_inside, there_y * area.width + there_x, np.arange(area.cell_count)[:, None])


class Team:
    """Units on their way to a base, and the field that leads there."""

    def __init__(self, area, goal, home):
        self.goal = goal
        self.field = th.LivingField(th.Scenario(area, destinations=goal))
        away = th.make_n_scheme(th.Scenario(area, destinations=home)).distance.reshape(-1)
        self.cells = np.argsort(away, kind="stable")[1 : UNITS + 1]  # around their own base
        self.home = self.cells.copy()
        self.facing = np.zeros(UNITS, dtype=np.int64)
        self.score = 0


class Game:
    """All that a frame changes."""

    def __init__(self):
        self.area, self.gates = make_ground()
        self.neighbours = make_neighbours(self.area)
        self.teams = [Team(self.area, goal, home) for goal, home in (BASES[::-1], BASES)]
        self.is_taken = np.zeros(self.area.cell_count, dtype=bool)
        for team in self.teams:
            self.is_taken[team.cells] = True
        self.is_shut = [False] * len(self.gates)
        self.random = np.random.default_rng(1)

    def frame(self, number):
        """Let both teams move, and now and then a gate turn."""
        if number % 10 == 0:
            self.turn_gate(int(self.random.integers(len(self.gates))))
        for team in self.teams if number % 2 else self.teams[::-1]:  # so that nobody is always first
            self.move(team)
            self.strike(team)

    def turn_gate(self, gate):
        """Open a gate, or shut it where nobody stands in it; the fields of both teams follow."""
        cells = self.area.xy_to_cell(*np.transpose(self.gates[gate]))
        if self.is_shut[gate] or not self.is_taken[cells].any():
            change = {"freed" if self.is_shut[gate] else "blocked": cells}
            self.is_shut[gate] = not self.is_shut[gate]
            for team in self.teams:
                team.field.change(**change)

    def move(self, team):
        """Let each unit take the free neighbour that is nearest to the goal, if that is no farther than where it is."""
        distance = team.field.distance.reshape(-1)
        around = self.neighbours[team.cells]
        price = np.where(self.is_taken[around], FAR, distance[around])
        best = np.argmin(price, axis=1)
        rows = np.arange(UNITS)
        target, price = around[rows, best], price[rows, best]
        wants = np.flatnonzero((price <= distance[team.cells]) & (price < FAR))
        # Of those who want the same cell the first in a drawn order gets it.
        wants = self.random.permutation(wants)
        goes = wants[np.unique(target[wants], return_index=True)[1]]
        self.is_taken[team.cells[goes]] = False
        team.cells[goes], team.facing[goes] = target[goes], best[goes]
        self.is_taken[team.cells[goes]] = True
        arrived = goes[distance[team.cells[goes]] == 0]
        team.score += arrived.size
        self.send_home(team, arrived)

    def strike(self, team):
        """Send some of the enemies home who stand on the best way of a unit, or two crowds would never pass."""
        other = self.teams[1 - self.teams.index(team)]
        ahead = team.field.next_cell(team.cells)
        ahead = ahead[self.is_taken[ahead] & (self.random.random(UNITS) < STRIKE)]
        self.send_home(other, np.flatnonzero(np.isin(other.cells, ahead)))

    def send_home(self, team, units):
        """Let each unit begin anew where there is room."""
        room = team.home[~self.is_taken[team.home]][: units.size]
        units = units[: room.size]
        self.is_taken[team.cells[units]] = False
        team.cells[units] = room
        self.is_taken[room] = True


def draw(game, scale=5):
    """Return a picture of the game; of a unit, a disc with a stroke to where it faces."""
    tessellation, area = game.area.tessellation, game.area
    wide, high = (int(length * scale) for length in tessellation.extent(area.height, area.width))
    picture = Image.new("RGB", (wide, high), (246, 243, 235))
    pen = ImageDraw.Draw(picture)
    walls = np.argwhere(game.teams[0].field.barriers)
    for corners in tessellation.polygon_of_cell(walls[:, 1], walls[:, 0]) * scale:
        pen.polygon([tuple(corner) for corner in corners.tolist()], fill=(70, 70, 70))
    for team, colour in zip(game.teams, COLOURS, strict=True):
        x, y = area.cell_to_xy(team.cells)
        px, py = (scale * part for part in tessellation.centre_of_cell(x, y))
        ahead = scale * tessellation.unit_vector_of_direction[tessellation.orientation_of_cell(x, y), team.facing]
        for left, top, (east, south) in zip(px.tolist(), py.tolist(), ahead.tolist(), strict=True):
            pen.circle((left, top), 0.42 * scale, fill=colour)
            pen.line((left, top, left + 0.7 * east, top + 0.7 * south), fill=colour)
    return picture


def main():
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    game, took, pictures = Game(), [], []
    game.frame(0)  # what is compiled is compiled now
    for number in range(1, FRAMES + 1):
        begin = process_time()
        game.frame(number)
        took.append(1000 * (process_time() - begin))
        if number % 10 == 0:
            pictures.append(draw(game).quantize(32))
        cells = np.concatenate([team.cells for team in game.teams])
        assert np.unique(cells).size == 2 * UNITS, "two units in one cell"
    print(f"{2 * UNITS} units, {game.area.width} x {game.area.height} cells, {FRAMES} frames:", end=" ")
    print(f"median {np.median(took):.2f} ms a frame, the longest {max(took):.2f} ms, of CPU")
    print("score:", " : ".join(str(team.score) for team in game.teams))
    pictures[0].save(folder / "game.gif", save_all=True, append_images=pictures[1:], duration=120, loop=0)


if __name__ == "__main__":
    main()
