"""The version of fyke."""

__version__ = "0.1.0"
