"""Child: the process that runs cases for a worker, ``python -m trihex.studies.child [BYTES]``.

It reads cases from its standard input and writes to its standard output, for each, what is known of its row and then
the row. It ends when its input does, so it never outlives the one that asks.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from multiprocessing.connection import Connection
from queue import SimpleQueue
from typing import Any


def main(arguments: list[str]) -> None:
    """Serve until nobody asks any more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the one that asks
    asked, told = Connection(os.dup(0), writable=False), Connection(os.dup(1), readable=False)
    os.dup2(2, 1)  # what libraries print must not get between the rows
    cases: SimpleQueue[Any] = SimpleQueue()
    threading.Thread(target=_read, args=(asked, cases), daemon=True).start()

    from trihex.studies.case import run_case, warm_up

    warm_up("greedy")
    if arguments:
        limit_memory(int(arguments[0]))
    told.send("ready")
    while True:
        case = cases.get()
        told.send(("row", run_case(case, lambda row: told.send(("begun", row)))))


def _read(asked: Connection, cases: SimpleQueue[Any]) -> None:
    """Pass on cases; end the process as soon as no more can come, even amid a case."""
    while True:
        try:
            cases.put(asked.recv())
        except (EOFError, OSError):
            os._exit(0)


def limit_memory(more: int) -> None:
    """Let this process take at most `more` bytes of address space beside what it has."""
    import resource

    with open("/proc/self/statm") as file:
        pages = int(file.read().split()[0])
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    wanted = pages * resource.getpagesize() + more
    resource.setrlimit(resource.RLIMIT_AS, (wanted if hard < 0 else min(wanted, hard), hard))


if __name__ == "__main__":
    main(sys.argv[1:])
