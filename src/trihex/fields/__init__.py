"""Fields: how far, and which way; the automaton, N- and D-scheme, repaired in place, larger than memory."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
