"""Figures 10 and 11: the names of the directions on triangles and on hexagons."""

from examples.drawing import folder_from_arguments, save
from examples.paper.neighbourhoods import draw


def figures() -> dict[str, str]:
    """Return the figures by the names of their files."""
    return draw(costs=False)


if __name__ == "__main__":
    print(*save(folder_from_arguments(), figures()), sep="\n")
