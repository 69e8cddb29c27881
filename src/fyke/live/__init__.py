"""The live page: a net in the browser that answers to sliders."""

from .server import AddressError, Live, serve
from .study import RefusedError

__all__ = ["AddressError", "Live", "RefusedError", "serve"]
