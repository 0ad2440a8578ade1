"""Needs: which modules of kernels each use of trihex imports, so that they can be compiled beforehand."""

_FIELD = ("areas.moves", "fields.buckets")
_DIRECTIONS = (*_FIELD, "fields.directions")
_GREEDY = (*_DIRECTIONS, "planners.greedy", "planners.rows", "plans.replay")
_FCOST = (*_GREEDY, "planners.fcost", "planners.slots", "planners.lanes", "planners.laying", "fields.repair")
