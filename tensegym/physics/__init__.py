"""The compiled substep and nothing else: arrays, laws, geometry, mobility, turning of rods, drives, terrain."""
