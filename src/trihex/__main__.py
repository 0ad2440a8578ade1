"""Main: `python -m trihex` is `trihex`."""

from trihex.cli import main

if __name__ == "__main__":
    main(prog_name="trihex")
