"""Scenarios: files that hold all that is planned."""
