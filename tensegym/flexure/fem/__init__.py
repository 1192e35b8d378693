"""A planar beam FEM of a hinge."""
