"""The command line, `fyke`."""

from .app import main

__all__ = ["main"]
