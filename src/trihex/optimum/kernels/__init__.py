"""Kernels of `trihex.optimum`: see `trihex.kernels` for what they have in common."""
