"""Fuzzing: damaged files for every reader; ``python -m fuzz --help``."""
