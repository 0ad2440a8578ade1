"""Areas: a module for each format in which areas are read or written."""
