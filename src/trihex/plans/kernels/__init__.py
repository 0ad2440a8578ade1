"""Kernels of `trihex.plans`: see `trihex.kernels` for what they have in common."""
