"""The live page: a net in the browser that answers to sliders."""

from .server import AddressError, serve

__all__ = ["AddressError", "serve"]
