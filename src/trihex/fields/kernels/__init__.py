"""Kernels of `trihex.fields`: see `trihex.kernels` for what they have in common."""
