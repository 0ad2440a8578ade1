"""Caching: compiled kernels are kept on disk, and are made anew when anything that they are made of has changed."""

import logging
from functools import cache
from pickle import UnpicklingError
from types import FunctionType
from typing import Any

from numba.core.caching import CompileResultCacheImpl, FunctionCache

from trihex.kernels.sources import stamp_of

_LOG = logging.getLogger(__name__)


class _Locator:
    """Where numba keeps a function, with a stamp of all sources in place of that of one file."""

    def __init__(self, own: Any, path: str) -> None:
        self._own, self._path = own, path

    def __getattr__(self, name: str) -> Any:
        return getattr(self._own, name)

    def get_source_stamp(self) -> Any:
        try:
            return stamp_of(self._path)
        except OSError:  # the source is not a file of its own, as in an archive
            return self._own.get_source_stamp()


class _Kept(CompileResultCacheImpl):
    def __init__(self, function: FunctionType) -> None:
        super().__init__(function)
        self._locator = _Locator(self._locator, function.__code__.co_filename)


class KernelCache(FunctionCache):
    """The cache of a kernel."""

    _impl_class = _Kept

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return what is on disk, or nothing where it was left by a version whose names are gone."""
        try:
            return super().load_overload(sig, target_context)
        except (AttributeError, ImportError, EOFError, UnpicklingError):
            self.flush()
            return None


@cache
def _tell_that_nothing_is_kept() -> None:
    _LOG.warning("compiled kernels cannot be kept, no folder can be written: set NUMBA_CACHE_DIR to one that can")


def keep(dispatcher: Any) -> None:
    """Let a kernel be found on disk, and kept there; where there is no place for it, say so once and go on without."""
    try:
        dispatcher._cache = KernelCache(dispatcher.py_func)
    except RuntimeError:  # neither the folder of the package nor that of the user can be written
        _tell_that_nothing_is_kept()
