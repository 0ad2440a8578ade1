"""Kernels of `trihex.pictures`: see `trihex.kernels` for what they have in common."""
