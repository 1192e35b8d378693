"""FlexibleUrdf: a URDF's text, and the revolute joints in it that flexures have taken the place of."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path

from tensegym.arrays import FloatArray
from tensegym.bullet import Articulated, World
from tensegym.errors import FlexureError

from .urdf_rewrite import Chain, axis_of, base_link, parse, put_chain, revolute_joint, to_text

ORIGIN = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


class FlexibleUrdf:
    """The file stays as it is.

    Raises FileNotFoundError for a path that is not there, FlexureError for a file that is no URDF or has a revolute
    joint without a limit.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        if not self.path.is_file():
            raise FileNotFoundError(f"no URDF {path}")
        self._root = parse(self.path.read_text(), self.path.name)
        for joint in self._root.findall("joint"):
            if joint.get("type") == "revolute":
                revolute_joint(self._root, str(joint.get("name")), self.path.name)
        self.chains: dict[str, list[str | None]] = {}
        """By the flexure's name, its joints x, y, theta, z, turn about y, turn about x; None where it has none."""

    def put(self, name: str, chain_about: Callable[[FloatArray], Chain]) -> None:
        """Replace the revolute joint ``name`` by the chain for its unit axis (3,); unchanged on a FlexureError."""
        if name in self.chains:
            raise FlexureError(f"joint {name!r} is a flexure already")
        joint = revolute_joint(self._root, name, self.path.name)
        chain = chain_about(axis_of(joint))
        put_chain(self._root, joint, chain)
        self.chains[name] = chain.names(name)

    def load(self, world: World, friction: float, fixed_base: bool) -> Articulated:
        """Load it at the origin, where the engine's link frames lose least."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / self.path.name
            path.write_text(to_text(self._root, self.path.parent))
            return Articulated(world, path, ORIGIN, friction, fixed_base)

    def link_rows(self, body: Articulated) -> dict[str, int]:
        """Row of every link by name: the base, then the engine's order."""
        return {base_link(self._root): 0} | {info[12].decode(): i + 1 for i, info in enumerate(body.joint_info)}
