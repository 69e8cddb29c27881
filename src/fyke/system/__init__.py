"""System: the frozen arrays that the forces and solvers work on."""
