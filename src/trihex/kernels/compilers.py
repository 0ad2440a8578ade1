"""Compilers: which of numba's or of ours make kernels, as this numba allows."""

from typing import Any


def compilers() -> tuple[dict[str, Any], dict[str, Any]]:
    """Return options of `numba.njit` for kernels and for helpers; none where numba is not as `compiling` expects it."""
    try:
        from trihex.kernels.compiling import HelperCompiler, KernelCompiler
    except (ImportError, AttributeError):
        return {}, {}
    return {"pipeline_class": KernelCompiler}, {"pipeline_class": HelperCompiler}
