"""The engines by name. A robot, and all above it, asks here and knows none of them."""

from __future__ import annotations

from importlib.util import find_spec

from tensegym.bullet import BulletWorld
from tensegym.bullet.camera import Camera
from tensegym.engine import Scene, World
from tensegym.errors import DesignError, SimulationError
from tensegym.tables import as_text, show

TITLES = {"pybullet": "PyBullet", "mujoco": "MuJoCo"}
ENGINES = tuple(TITLES)


def open_world(engine: str, scene: Scene, gui: bool = False, compiled: bool | None = None) -> World:
    """The scene in an engine.

    Args:
        engine: one of ENGINES.
        scene: what stands in it.
        gui: show it in a window, which is PyBullet's.
        compiled: whether substeps go past Python; by default where they can. Either way gives the same bits.

    Raises:
        DesignError: there is no such engine, or it has no window.
        SimulationError: it is not installed, has no display, or has no compiled substeps and is asked for them.
    """
    check_engine(engine)
    if engine == "pybullet":
        return BulletWorld(scene, gui, compiled)
    if gui:
        raise DesignError(f"engine {engine!r} has no window: take engine='pybullet', or render to rgb_array instead")
    from tensegym.mujoco.world import MujocoWorld

    return MujocoWorld(scene, compiled)


def check_engine(engine: str) -> None:
    """Raises DesignError for an engine there is not, SimulationError for one that is not installed."""
    if as_text(engine, "engine", DesignError) not in ENGINES:
        raise DesignError(f"engine = {show(engine)} is not one of {', '.join(ENGINES)}")
    if engine != "pybullet" and not _installed(engine):
        raise SimulationError(f"engine {engine!r} is not installed; it comes with the extra {engine}: "
                              f"pip install '.[{engine}]' in tensegym's sources")  # fmt: skip


def _installed(library: str) -> bool:
    try:
        return find_spec(library) is not None
    except ValueError:  # of a module that is kept from being imported
        return False


def window_of(world: World) -> Camera:
    """What draws into its window. Raises SimulationError for an engine that has none."""
    if not isinstance(world, BulletWorld):
        raise SimulationError("only PyBullet has a window: make the robot with gui=True, or take pictures of it")
    return world.camera
