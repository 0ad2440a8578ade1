"""Starts: files of the cells in which robots start."""
