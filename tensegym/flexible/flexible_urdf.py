"""FlexibleUrdf: a URDF's text, and the revolute joints in it that flexures have taken the place of."""

from __future__ import annotations

import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path

from tensegym.arrays import FloatArray
from tensegym.bullet import Articulated, Client
from tensegym.errors import FlexureError

from .urdf_audit import audit
from .urdf_rewrite import Chain, put_chain, revolute_joint
from .urdf_xml import axis_of, base_link, numbers, parse, to_text

ORIGIN = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


class FlexibleUrdf:
    """A URDF, audited, in which joints are replaced; the file stays as it is.

    Args:
        path: of the file.
        fixed_base: whether its base link will be held.

    Raises:
        FileNotFoundError: for a path that is not there.
        FlexureError: for a file that is no URDF or cannot mean what it says; see urdf_audit.py.
    """

    def __init__(self, path: str | Path, fixed_base: bool) -> None:
        self.path = Path(path)
        if not self.path.is_file():
            raise FileNotFoundError(f"no URDF {path}")
        self.fixed_base = fixed_base
        self._root = parse(self.path.read_bytes(), self.path.name)
        self.notes = audit(self._root, self.path.parent, self.path.name, fixed_base)
        """A line for everything in the file that is not simulated."""
        self.chains: dict[str, list[str | None]] = {}
        """By the flexure's name, its joints x, y, theta, z, turn about y, turn about x; None where it has none."""

    def put(self, name: str, chain_about: Callable[[FloatArray], Chain]) -> None:
        """Replace the revolute joint ``name`` by the chain for its unit axis (3,); unchanged on a FlexureError."""
        if name in self.chains:
            raise FlexureError(f"joint {name!r} is a flexure already")
        joint = revolute_joint(self._root, name, self.path.name)
        chain = chain_about(axis_of(joint))
        dynamics = joint.find("dynamics")
        if dynamics is not None and numbers(joint, dynamics, "damping", "0", 1)[0]:
            warnings.warn(f"{self.path.name}: joint {name!r}: its damping = {dynamics.get('damping')} goes with it; a "
                          "flexure's is loss_time", UserWarning, stacklevel=4)  # fmt: skip
        put_chain(self._root, joint, chain)
        self.chains[name] = chain.names(name)

    def load(self, world: Client, friction: float) -> Articulated:
        """Load it at the origin, where the engine's link frames lose least."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / self.path.name
            path.write_text(to_text(self._root), encoding="utf-8")
            return Articulated(world, path, ORIGIN, friction, self.fixed_base)

    def link_rows(self, body: Articulated) -> dict[str, int]:
        """Row of every link by name: the base, then the engine's order."""
        return {base_link(self._root): 0} | {info[12].decode(): i + 1 for i, info in enumerate(body.joint_info)}
