"""Many solves for one answer: how far a result can be trusted, and what it depends on."""

from .claims import Found

__all__ = ["Found"]
