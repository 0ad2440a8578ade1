"""Worker: a process that compiles what is named on its standard input, a line of JSON for each; see `preparing`."""

import json
import signal
import sys

from trihex.kernels import loading
from trihex.kernels.haste import hasten
from trihex.kernels.marks import mark
from trihex.kernels.needs import Kernels


def main() -> None:
    """Compile and mark what each line names, and answer it with a line: an empty one, or what went wrong."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for who started it
    loading.is_alone = True
    hasten()
    for line in sys.stdin:
        kernels = Kernels(*json.loads(line))
        try:
            files = [getattr(made._cache, "_cache_file", None) for made in kernels.load()]
            if kept := [file._index_path for file in files if file is not None]:
                mark(kernels, kept)
        except Exception as error:
            print(f"{type(error).__name__}: {error}".replace("\n", " "), flush=True)
        else:
            print(flush=True)


if __name__ == "__main__":
    main()
