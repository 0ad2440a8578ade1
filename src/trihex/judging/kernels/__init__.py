"""Kernels of `trihex.judging`: see `trihex.kernels` for what they have in common."""
