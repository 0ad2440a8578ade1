"""Kernels of `trihex.running`: see `trihex.kernels` for what they have in common."""
