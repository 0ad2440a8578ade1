"""Kernels of `trihex.formats`: see `trihex.kernels` for what they have in common."""
