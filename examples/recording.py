"""A recording for Foxglove and RViz, drawn from what stands in the file: map, costs, paths and robots at one time."""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from PIL import Image, ImageDraw

import trihex as th

AT, LARGER = 20, 3  # the step shown, pixels to a square of the grid
folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
rooms = th.make_rooms_area("hexagonal", 22, 30, room=8, seed=3)
area = th.Area("hexagonal", rooms.barriers, "rooms", th.Frame(0.5))
scenario = th.Scenario(area, (27, 18), th.random_robots(area, 40, seed=1, avoid=(27, 18)))

with TemporaryDirectory() as place:
    th.write_waypoints(th.make_plan(scenario), f"{place}/plan.mcap", speed=0.5)
    with open(f"{place}/plan.mcap", "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        messages = [(one[1].topic, one[3]) for one in reader.iter_decoded_messages()]
moments = [ros for topic, ros in messages if topic == "/robots"]
last = dict(messages)
print("topics:", *sorted({topic for topic, _ in messages if not topic.startswith("/robot_")}), "and a path a robot")
print(f"{len(moments)} moments, {len(moments[AT].markers) - 1} robots in the world in that of step {AT}")

grid = last["/n_scheme"]
values = np.array(grid.data).reshape(grid.info.height, grid.info.width)[::-1]  # row 0 of the file is in the south
share = np.clip(values, 0, 98)[..., None] / 98
shades = (1 - share) * (250, 244, 220) + share * (70, 110, 160)
shades[values == 100], shades[values == -1] = (50, 50, 50), (255, 255, 255)
picture = Image.fromarray(shades.astype(np.uint8)).resize((values.shape[1] * LARGER, values.shape[0] * LARGER), 0)
pen, corner, scale = ImageDraw.Draw(picture), grid.info.origin.position, LARGER / grid.info.resolution


def pixel(point):
    return (point.x - corner.x) * scale, picture.height - (point.y - corner.y) * scale


def colour(marker):
    return tuple(int(255 * band) for band in (marker.color.r, marker.color.g, marker.color.b))


for line in last["/paths"].markers:
    pen.line([pixel(point) for point in line.points], fill=colour(line))
for disc in moments[AT].markers[1:]:  # the first wipes off those before
    pen.circle(pixel(disc.pose.position), disc.scale.x / 2 * scale, fill=colour(disc))
picture.save(folder / "recording.png")
