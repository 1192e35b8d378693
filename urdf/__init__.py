"""URDF files of the default robots, found with importlib.resources."""
