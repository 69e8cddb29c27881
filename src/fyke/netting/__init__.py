"""Geometry of netting: twine, mesh lattices, panels, lines. Numpy only."""
