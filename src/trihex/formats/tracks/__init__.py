"""Tracks: where each robot is at which second, as files for others."""
