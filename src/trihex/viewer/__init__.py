"""Viewer: plans seen in a browser, in a notebook or in one HTML file; all three run the same ES module.

`bundle` and `document` are the language between page and Python, `desk` answers what a page asks for, `playback` holds
the curves of a plan; `server`, `widget` and `page` are the three hosts.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
