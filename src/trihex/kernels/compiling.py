"""Compiling: of numba's passes those that kernels need, and machine code for kernels alone.

By default numba goes over each function with two dozen passes, most of them for what kernels do not hold (closures,
literals, parallel loops), optimises each helper in a library of its own, makes machine code of it that nobody calls,
and then optimises it once more within each caller. All of that takes as long again as the rest, see
docs/laboratory/performance.md. What numba does not document is asked for before it is used: without it numba's own
compiler takes over, which is only slower.
"""

from functools import cache
from typing import Any

from numba import _dynfunc  # type: ignore[attr-defined]
from numba.core import typed_passes, untyped_passes
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase
from numba.core.compiler_machinery import PassManager, register_pass

_FRONT = (
    untyped_passes.TranslateByteCode,
    untyped_passes.FixupArgs,
    untyped_passes.IRProcessing,
    untyped_passes.GenericRewrites,  # indices of tuples become constants
    untyped_passes.ReconstructSSA,
    typed_passes.NopythonTypeInference,
    typed_passes.PreLowerStripPhis,
)


class _KernelLibrary(JITCodeLibrary):
    """The code of a kernel: optimised once, when all that it calls has become part of it."""

    def _optimize_functions(self, module: Any) -> None:
        module.data_layout = self._codegen._data_layout

    def _optimize_final_module(self) -> None:
        if not hasattr(self._codegen, "_module_pass_manager"):
            super()._optimize_final_module()
            return
        passes = self._codegen._module_pass_manager()
        manager, *others = passes if isinstance(passes, tuple) else (passes,)
        manager.run(self._final_module, *others)


class _HelperLibrary(_KernelLibrary):
    """The code of a helper: left as it is, for whoever takes it in; no machine code is made of it."""

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalized = True


@register_pass(mutates_CFG=True, analysis_only=False)
class _KernelLowering(typed_passes.NativeLowering):
    """From numba's to LLVM's language."""

    _name = "trihex_kernel_lowering"

    def run_pass(self, state: Any) -> bool:
        state.library = _KernelLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return bool(super().run_pass(state))


@register_pass(mutates_CFG=True, analysis_only=False)
class _HelperLowering(typed_passes.NativeLowering):
    """The same for a helper, which is told to its callers as what it is."""

    _name = "trihex_helper_lowering"

    def run_pass(self, state: Any) -> bool:
        state.library = _HelperLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        state.flags.no_compile = True
        super().run_pass(state)
        lowered = state.cr
        name = lowered.fndesc.qualname.split(".")[-1]
        known_as = _dynfunc.make_function(lowered.fndesc.lookup_module(), name, "", 0, lowered.env, (state.library,))
        state.targetctx.insert_user_function(known_as, lowered.fndesc, [state.library])
        state.cr = lowered._replace(cfunc=known_as)
        return True


@cache
def _passes(lowering: Any) -> Any:
    manager = PassManager("trihex")
    for step in (*_FRONT, lowering, typed_passes.NoPythonBackend):
        manager.add_pass(step, step.__name__)
    manager.finalize()
    return manager


class KernelCompiler(CompilerBase):
    """The way of a kernel from Python to machine code."""

    def define_pipelines(self) -> list[Any]:
        """Return the one way that there is."""
        return [_passes(_KernelLowering)]


class HelperCompiler(CompilerBase):
    """The way of a helper from Python to what kernels take in."""

    def define_pipelines(self) -> list[Any]:
        """Return the one way that there is."""
        return [_passes(_HelperLowering)]
