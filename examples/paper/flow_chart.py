"""Figure 5: the flow chart of the planner, as SVG drawn by hand."""

from dataclasses import dataclass
from html import escape
from itertools import pairwise

from examples.drawing import folder_from_arguments, save

LINE, HALF_WIDTH, INK = 18, 150, "#202124"
FILL = {"action": "#e8f0fe", "question": "#ffecaa", "end": "#c7e9b4"}


@dataclass(frozen=True)
class Box:
    """A box of the chart, centred on (x, y): what is done, what is asked, or where it begins and ends."""

    x: int
    y: int
    words: str
    kind: str = "action"

    @property
    def lines(self) -> list[str]:
        """What is written, line by line."""
        return self.words.split("\n")

    @property
    def half_height(self) -> int:
        """Half of the height, in pixels."""
        return len(self.lines) * LINE // 2 + (18 if self.kind == "question" else 9)

    def to_svg(self) -> str:
        """Return the shape with its words."""
        x, y, w, h = self.x, self.y, HALF_WIDTH, self.half_height
        look = f'fill="{FILL[self.kind]}" stroke="{INK}"'
        if self.kind == "question":
            inset = 26
            corners = [(x - w, y), (x - w + inset, y - h), (x + w - inset, y - h), (x + w, y)]
            corners += [(x + w - inset, y + h), (x - w + inset, y + h)]
            shape = f'<polygon points="{" ".join(f"{px},{py}" for px, py in corners)}" {look}/>'
        else:
            round_by = h if self.kind == "end" else 4
            shape = f'<rect x="{x - w}" y="{y - h}" width="{2 * w}" height="{2 * h}" rx="{round_by}" {look}/>'
        first = y - (len(self.lines) - 1) * LINE / 2 + 5
        words = "".join(
            f'<text x="{x}" y="{first + i * LINE:g}">{escape(line)}</text>' for i, line in enumerate(self.lines)
        )
        return shape + words


BEGIN = Box(170, 30, "area, destinations, robots", "end")
N_SCHEME = Box(170, 95, "run the automaton until nothing\nchanges: the N-scheme")
D_SCHEME = Box(170, 165, "keep the directions of least cost\nof each cell: the D-scheme")
ALL_BEGIN = Box(170, 235, "put every robot that can arrive\ninto begin; step = 0")
EMPTY = Box(170, 315, "is begin empty?", "question")
END = Box(530, 315, "all are in final:\nreport F_t", "end")
NEXT = Box(170, 395, "step + 1; take the robots of begin\none after the other")
COST = Box(170, 470, "Fcost(d) = v(d) + V(d) + w_t c(d)\nfor each direction d")
FREE = Box(170, 560, "is a worthwhile direction free\nof collisions in this step?", "question")
WAIT = Box(530, 560, "waiting: stay, w_r grows by w_t")
MOVE = Box(170, 650, "filled: move in the cheapest one,\nd_r grows by v(d)")
ARRIVED = Box(170, 735, "is the new cell a destination?", "question")
FINAL = Box(170, 815, "move the robot from begin to final")
LAST = Box(530, 815, "was it the last robot\nof this step?", "question")
BOXES = [BEGIN, N_SCHEME, D_SCHEME, ALL_BEGIN, EMPTY, END, NEXT, COST, FREE, WAIT, MOVE, ARRIVED, FINAL, LAST]


def arrow(*points: tuple[int, int], label: str = "") -> str:
    """Return an arrow along `points`, with a label beside its first bend."""
    line = f'<polyline points="{" ".join(f"{x},{y}" for x, y in points)}" marker-end="url(#tip)"/>'
    if not label:
        return line
    (x, y), (x1, _) = points[:2]
    place = (x + 8, y + 16, "start") if x == x1 else (x + (8 if x1 > x else -8), y - 6, "start" if x1 > x else "end")
    return (
        line + f'<text x="{place[0]}" y="{place[1]}" text-anchor="{place[2]}" fill="{INK}" stroke="none">{label}</text>'
    )


def down(upper: Box, lower: Box, label: str = "") -> str:
    return arrow((upper.x, upper.y + upper.half_height), (lower.x, lower.y - lower.half_height), label=label)


def across(left: Box, right: Box, label: str = "") -> str:
    return arrow((left.x + HALF_WIDTH, left.y), (right.x - HALF_WIDTH, right.y), label=label)


def figures() -> dict[str, str]:
    """Return the figure by the name of its file."""
    column = [BEGIN, N_SCHEME, D_SCHEME, ALL_BEGIN, EMPTY, NEXT, COST, FREE, MOVE, ARRIVED, FINAL]
    labels = {EMPTY: "no", FREE: "yes", ARRIVED: "yes"}
    right, left = 530 + HALF_WIDTH, 170 - HALF_WIDTH
    arrows = [down(upper, lower, labels.get(upper, "")) for upper, lower in pairwise(column)]
    arrows += [across(EMPTY, END, "yes"), across(FREE, WAIT, "no"), across(FINAL, LAST), down(WAIT, LAST)]
    arrows.append(arrow((170 + HALF_WIDTH, ARRIVED.y), (505, ARRIVED.y), (505, LAST.y - LAST.half_height), label="no"))
    arrows.append(
        arrow((right, LAST.y), (right + 30, LAST.y), (right + 30, COST.y), (170 + HALF_WIDTH, COST.y), label="no")
    )
    bottom = LAST.y + LAST.half_height + 25
    arrows.append(
        arrow(
            (530, LAST.y + LAST.half_height),
            (530, bottom),
            (left - 20, bottom),
            (left - 20, EMPTY.y),
            (left, EMPTY.y),
            label="yes",
        )
    )
    width, height = right + 60, bottom + 15
    return {
        "figure_05.svg": f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'viewBox="-20 0 {width} {height}" font-family="sans-serif" font-size="15">\n'
        "<title>The planner of the paper</title>\n"
        f'<rect x="-20" width="100%" height="100%" fill="#ffffff"/>\n'
        '<marker id="tip" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="7" markerHeight="7" orient="auto">'
        f'<path d="M0 0L10 5L0 10z" fill="{INK}"/></marker>\n'
        f'<g fill="none" stroke="{INK}" stroke-width="1.4">\n' + "\n".join(arrows) + "\n</g>\n"
        f'<g text-anchor="middle" fill="{INK}">\n' + "\n".join(box.to_svg() for box in BOXES) + "\n</g>\n</svg>\n"
    }


if __name__ == "__main__":
    print(*save(folder_from_arguments(), figures()), sep="\n")
