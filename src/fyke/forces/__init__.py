"""What acts on the knots: tension, water, weight; values and tangents side by side."""
