"""Data of an experiment, from pictures to a fitted joint."""
