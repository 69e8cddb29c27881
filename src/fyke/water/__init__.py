"""Currents: the velocity of the water at points and times."""
