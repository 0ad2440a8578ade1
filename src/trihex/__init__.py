"""Collision-free paths for many robots with a common goal on triangular, hexagonal and square tessellations.

The public names, each from the package that tells of it, are listed once, in ``__init__.pyi``. A module is imported
when a name of it is first used, so that ``import trihex`` costs next to nothing.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
__version__ = "0.1.0"
