"""Benchmarks from the command line: ``python -m benchmarks [NAME ...] [options of the one named]``."""

import sys
from importlib import import_module
from pathlib import Path

NAMES = sorted(path.stem for path in Path(__file__).parent.glob("[a-z]*.py") if path.stem not in ("literal", "measure"))


def main(arguments: list[str]) -> int:
    """Run the benchmarks named first in `arguments`, or all; the rest are options, for one benchmark only."""
    names = [name for name in arguments if name in NAMES]
    options = [word for word in arguments if word not in NAMES]
    if options and len(names) != 1:
        print(f"usage: python -m benchmarks [{' | '.join(NAMES)}] [options of the one named]", file=sys.stderr)
        return 2
    for name in names or (name for name in NAMES if name not in ("million", "optimum")):  # they take minutes
        import_module(f"benchmarks.{name}").main(options)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
