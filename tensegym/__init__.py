"""Tensegrity robots and flexible joints on PyBullet.

``import tensegym`` registers the Gymnasium environments and nothing more: torch, stable-baselines3 and
matplotlib are imported only by the commands that need them.
"""

from importlib.metadata import version

from tensegym import envs as envs

__version__ = version("tensegym")
