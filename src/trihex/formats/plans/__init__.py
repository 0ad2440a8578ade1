"""Plans: a module for each format of plans."""
