"""Worker: a process that compiles the modules of kernels named on its standard input; see `preparing`."""

import signal
import sys
from importlib import import_module

from trihex.kernels import loading
from trihex.kernels.marks import mark


def main() -> None:
    """Compile each module, mark it, and answer each line with one: an empty one, or what went wrong."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for who started it
    loading.is_alone = True
    for line in sys.stdin:
        name = line.strip()
        try:
            module = import_module(name)
            caches = [thing._cache for thing in vars(module).values() if hasattr(thing, "_cache")]
            mark(name, [one._cache_file._index_path for one in caches if hasattr(one, "_cache_file")])
        except Exception as error:
            print(f"{type(error).__name__}: {error}".replace("\n", " "), flush=True)
        else:
            print(flush=True)


if __name__ == "__main__":
    main()
