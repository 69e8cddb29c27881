"""Statics and dynamics."""
