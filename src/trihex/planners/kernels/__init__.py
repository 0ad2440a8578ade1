"""Kernels of `trihex.planners`: see `trihex.kernels` for what they have in common."""
