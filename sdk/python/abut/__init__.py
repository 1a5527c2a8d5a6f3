"""A body of your own in a scene of abut: subclass Body and hand it to serve().

    from abut import Body, Point, serve

docs/SOLVER.md goes through it, and abut/body.py tells what a body is asked and in which order.
"""

from abut.body import Body, Energy
from abut.errors import InputError, NotConverged
from abut.server import serve
from abut.surface import Point, Surface

__all__ = ["Body", "Energy", "InputError", "NotConverged", "Point", "Surface", "serve"]
