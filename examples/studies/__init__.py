"""Studies whose results answer a question: a grid, its table and the page made from it."""
