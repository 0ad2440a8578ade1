"""The pages of the studies and their pictures, from the tables of results: ``python -m examples.studies [FOLDER]``."""

import sys
from pathlib import Path

from examples.studies import planner, tessellations, time, unknown

PAGES = {"tessellations": tessellations, "planner": planner, "unknown": unknown, "time": time}


def main(docs: Path) -> None:
    """Write pages into ``docs/studies`` and pictures into ``docs/figures``."""
    for name, module in PAGES.items():
        for folder in ("studies", "figures"):
            (docs / folder).mkdir(parents=True, exist_ok=True)
        (docs / "studies" / f"{name}.md").write_text(module.page(), encoding="utf-8")
        module.draw(str(docs / "figures" / f"study_{name}.png"))
        print(docs / "studies" / f"{name}.md")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[2] / "docs")
