"""Runs: files of runs and of events."""
