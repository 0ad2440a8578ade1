"""Kernels of `trihex.bounds`: see `trihex.kernels` for what they have in common."""
