"""Cluster: the workers of a Dask scheduler as an executor."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from trihex.errors import MissingExtraError, StudyError
from trihex.studies.row import versions

_SECONDS = 10


class Cluster:
    """A Dask client that takes every call for a new one.

    Dask by itself takes calls of one function with equal arguments for one, and keeps what came of them.
    """

    def __init__(self, client: Any) -> None:
        self.client = client

    @property
    def _max_workers(self) -> int:
        """How many threads work, by the name that executors of Python give it."""
        return max(1, int(sum(self.client.nthreads().values())))

    def submit(self, function: Callable[..., Any], /, *arguments: Any) -> Any:
        """Return a future of `function` called with `arguments` by some worker."""
        return self.client.submit(function, *arguments, pure=False)


@contextmanager
def connected(address: str, seconds: float = _SECONDS) -> Iterator[Cluster]:
    """Yield the workers of the scheduler at `address`, such as ``tcp://10.0.0.1:8786``.

    Raises
    ------
    MissingExtraError
        If `distributed` is not installed.
    StudyError
        If no scheduler answers within `seconds`, it has no workers, or one of them has another trihex or none.
    """
    try:
        import distributed
    except ImportError:
        raise MissingExtraError("a Dask scheduler needs distributed: pip install 'trihex[scale]'") from None
    for name in ("distributed", "distributed.client", "tornado"):  # what they log is told by one error
        logging.getLogger(name).setLevel(logging.CRITICAL)
    client = _connect(distributed, address, seconds)
    try:
        _check_workers(client, address, seconds, versions()["trihex"])
        yield Cluster(client)
    finally:
        client.close(timeout=1)


def _connect(distributed: Any, address: str, seconds: float) -> Any:
    """Return a client of the scheduler at `address`."""

    async def shake_hands() -> None:
        async with asyncio.timeout(seconds):
            comm = await distributed.comm.connect(address, timeout=seconds)
            await comm.close()

    try:
        # Asked first, because a client that cannot connect may wait for ever, and complains when it is thrown away.
        asyncio.run(shake_hands())
    except ValueError as error:
        raise StudyError(
            f"scheduler must be an address such as tcp://10.0.0.1:8786, not {address!r:.80}: {error}"
        ) from None
    except OSError:
        raise StudyError(f"{address}: no Dask scheduler answers there within {seconds:g} s") from None
    return distributed.Client(address, timeout=seconds, set_as_default=False)


def _check_workers(client: Any, address: str, seconds: float, own: str) -> None:
    """Raise StudyError unless there is a worker, and all have this trihex."""
    try:
        client.wait_for_workers(1, timeout=seconds)
    except TimeoutError:
        raise StudyError(f"{address}: the scheduler has no workers; start some with: dask worker {address}") from None
    found = client.run(versions, on_error="return")
    for worker, answer in sorted(found.items()):
        if not isinstance(answer, dict):
            raise StudyError(f"{worker}: the worker has no trihex: {type(answer).__name__}: {answer!s:.200}")
        if answer["trihex"] != own:
            raise StudyError(f"{worker}: the worker has trihex {answer['trihex']}, this is {own}")
