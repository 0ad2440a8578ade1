"""Kernels of `trihex.areas`: see `trihex.kernels` for what they have in common."""
