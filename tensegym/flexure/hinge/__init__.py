"""Hinges: geometry, presets, files, and states of equilibrium."""
