"""Optimum: the flow that is the least plan.

`make_network` makes one layer of the graph of cells and steps. A `Flow` through all its layers is found by one of three
ways: robots one after another, slots exchanged, prices that rise (docs/optimum.md). `make_plan_of_flow` lets the robots
follow it. A *slot* is here an arrival at a destination in a step.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
