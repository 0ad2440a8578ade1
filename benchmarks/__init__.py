"""Benchmarks: how fast trihex is beside other libraries, measured in one process."""
