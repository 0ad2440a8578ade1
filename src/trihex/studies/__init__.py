"""Studies: many plans, made by many workers, as one table."""
