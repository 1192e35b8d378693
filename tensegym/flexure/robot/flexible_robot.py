"""FlexibleRobot: any URDF in PyBullet, with revolute joints replaced by fitted flexures."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from ...bullet import Articulated, World
from ...errors import FlexureError, SimulationError
from ..states import FloatArray
from . import contacts
from . import step_kernel as kernel
from .flexure_joint import FlexureJoint, Outside
from .springs import Springs, spring_table
from .tree import Tree, read_tree
from .tree_kernel import frames
from .urdf_rewrite import axis_of, base_link, parse, put_chain, revolute_joint, to_text

Scheme = Literal["trapezoid", "linear", "explicit"]
_SCHEMES = {"trapezoid": (kernel.TRAPEZOID, kernel.MOST_ITERATIONS), "linear": (kernel.TRAPEZOID, 1),
            "explicit": (kernel.EXPLICIT, 1)}  # fmt: skip
SPEED_BOUND = 1e5  # m/s or rad/s
IDENTITY = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Energies:
    """Mechanical energy [J]; the weight's is zero with every link's centre at the world's origin."""

    kinetic: float
    weight: float
    elastic: float

    @property
    def total(self) -> float:
        return self.kinetic + self.weight + self.elastic


@dataclass(frozen=True)
class Load:
    """A dead load on a link: it keeps its direction in the world until it is taken away."""

    link: str
    force: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """In world axes [N]."""
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Where the force acts, in the link's own frame [m]."""
    torque: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """In world axes [N m]."""


class FlexibleRobot:
    """A URDF's robot in a world of its own. Its joints are free of motors; flexures and ``torques`` move them.

    pose: of the URDF's base link, position [m] and quaternion xyzw. ``scheme``: trapezoid (step_kernel.py), linear (its
    first Newton iteration) or explicit (forces of the state as it is, stable for dt < 2 / the fastest frequency).
    A context manager. Raises FlexureError for a URDF that is none, FileNotFoundError for a path that is not there.
    """

    def __init__(
        self, urdf: str | Path, *, dt: float = 1e-3, gravity: Sequence[float] = (0.0, 0.0, -9.81),
        pose: Sequence[float] = IDENTITY, fixed_base: bool = False, ground: bool = False, friction: float = 0.8,
        scheme: Scheme = "trapezoid", gui: bool = False,
    ) -> None:  # fmt: skip
        self.path = Path(urdf)
        if not self.path.is_file():
            raise FileNotFoundError(f"no URDF {urdf}")
        if not (np.isfinite(dt) and dt > 0):
            raise FlexureError(f"dt = {dt!r} s; give a time step above 0")
        if scheme not in _SCHEMES:
            raise FlexureError(f"scheme = {scheme!r}; one of {', '.join(_SCHEMES)}")
        self._root = parse(self.path.read_text(), self.path.name)
        for joint in self._root.findall("joint"):
            if joint.get("type") == "revolute":
                revolute_joint(self._root, str(joint.get("name")), self.path.name)  # refuses one without a limit
        self.dt, self.scheme, self.fixed_base, self.friction = dt, scheme, fixed_base, friction
        self.gravity, self.base_pose = np.array(gravity, dtype=float), np.array(pose, dtype=float)
        self.flexures: dict[str, FlexureJoint] = {}
        self._chains: dict[str, list[str | None]] = {}
        self.loads: list[Load] = []
        self.time = 0.0
        self.world = World(dt, 0.0, gui)
        self.world.set_gravity(self.gravity.tolist())
        if ground:
            self.world.add_ground(friction)
        self.body: Articulated | None = None
        self._load()

    def close(self) -> None:
        self.world.close()

    def __enter__(self) -> FlexibleRobot:
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    # -- build ----------------------------------------------------------------------------------------------------

    def put(self, flexure: FlexureJoint) -> None:
        """Replace the revolute joint a flexure names and load the robot again, at rest. FlexureJoint calls it."""
        if flexure.name in self.flexures:
            raise FlexureError(f"joint {flexure.name!r} is a flexure already")
        joint = revolute_joint(self._root, flexure.name, self.path.name)
        chain = flexure.chain(axis_of(joint))
        put_chain(self._root, joint, chain)
        self._chains[flexure.name] = chain.names(flexure.name)
        self.flexures[flexure.name] = flexure
        self._load()

    def _load(self) -> None:
        if self.body is not None:
            self.body.remove()
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / self.path.name
            path.write_text(to_text(self._root, self.path.parent))
            # at the origin, where the engine's link frames lose least
            body = self.body = Articulated(self.world, path, IDENTITY, self.friction, self.fixed_base)
        self.tree: Tree = read_tree(body, self.fixed_base)
        self.joints = {body.joint_info[i][1].decode(): column for column, i in enumerate(body.moving)}
        self.links = {base_link(self._root): 0}
        self.links |= {info[12].decode(): i + 1 for i, info in enumerate(body.joint_info)}
        flexures = list(self.flexures.values())
        for row, flexure in enumerate(flexures):
            flexure.row = row
        columns = [[-1 if name is None else self.joints[name] for name in self._chains[f.name]] for f in flexures]
        self.springs: Springs = spring_table(
            [f.spring for f in flexures], columns, [f.across or (0.0, 0.0, 0.0) for f in flexures],
            [f.loss_time for f in flexures], [f.box for f in flexures],
        )  # fmt: skip
        count = len(self.joints)
        self._drag = np.array([body.joint_info[i][6] for i in body.moving], dtype=float)
        self.positions, self.torques = np.zeros(count), np.zeros(count)
        self._base, self._speeds = np.empty(7), np.zeros(self.tree.first + count)
        self._acceleration, self._force = np.zeros_like(self._speeds), np.zeros_like(self._speeds)
        self._margins = np.ones(len(flexures))
        self.place()

    # -- state ----------------------------------------------------------------------------------------------------

    def place(
        self, joints: Mapping[str, float] | None = None, rates: Mapping[str, float] | None = None,
        pose: Sequence[float] | None = None, twist: Sequence[float] = (0.0,) * 6,
    ) -> None:  # fmt: skip
        """Start anew: joint positions and rates by name (zero where not named), pose (7,) of the base link and velocity
        (6,) of the base's centre, linear and angular in the world. A flexure's tip is placed with ``place_tip``.
        """
        where = self.base_pose if pose is None else np.array(pose, dtype=float)
        turn, tree = Rotation.from_quat(where[3:]), self.tree
        self._base[:3] = where[:3] + turn.apply(tree.centre[0])
        self._base[3:] = (turn * Rotation.from_matrix(tree.turn[0]).inv()).as_quat()
        self.positions[:], self._speeds[:] = 0.0, 0.0
        for name, value in (joints or {}).items():
            self.positions[self._column(name)] = value
        for name, value in (rates or {}).items():
            self._speeds[tree.first + self._column(name)] = value
        if tree.first:
            self._speeds[:6] = twist
        self.time, self._acceleration[:] = 0.0, 0.0
        for flexure in self.flexures.values():
            flexure.outside = Outside(0, 1.0, 0.0)
        self._stagger()

    def _stagger(self) -> None:
        """Set the engine's velocities half a step back, as its leapfrog and the trapezoidal step count them."""
        asked, first = self._speeds.copy(), self.tree.first
        assert self.body is not None
        # placed before it is solved for: contacts are looked for where the engine has the body
        self.body.place(self._base.tolist(), (0.0,) * 6, self.positions, np.zeros(len(self.positions)))
        if self.scheme != "explicit":
            for _ in range(3):  # the springs' own share cancels: it converges at once but for the velocity terms
                self._solve()
                self._speeds[:] = asked - 0.5 * self.dt * self._acceleration
        twist = self._speeds[:6] if first else np.zeros(6)
        self.body.place(self._base.tolist(), twist.tolist(), self.positions, self._speeds[first:])

    def place_tip(self, name: str, pose: ArrayLike) -> dict[str, float]:
        """Joint positions, for ``place``, that put a flexure's tip at (x, y, theta) [m, rad] in its base axes."""
        flexure, (x, y, theta) = self._flexure(name), np.array(pose, dtype=float)
        names = self._chains[name]
        if names[0] is None or names[1] is None:  # a pin
            return {name: float(theta)}
        return {names[0]: float(x - flexure.spring.length), names[1]: float(y), name: float(theta)}

    @property
    def rates(self) -> FloatArray:
        """(j,) joint rates as the engine has them, half a step before the positions."""
        return self._speeds[self.tree.first :]

    @property
    def velocities(self) -> FloatArray:
        """(n,) base velocity (6, floating only) and joint rates at the time of the positions."""
        if self.scheme == "explicit":
            return self._speeds.copy()
        kept = self._acceleration.copy()
        self._solve()
        now = self._speeds + 0.5 * self.dt * self._acceleration
        self._acceleration[:] = kept
        return now

    def energies(self) -> Energies:
        """Now, velocities taken at the time of the positions."""
        speeds = self.velocities
        kinetic, weight = kernel.kinetic_and_weight(self.tree, self._base, self.positions, speeds, self.gravity)
        return Energies(kinetic, weight, sum(flexure.energy for flexure in self.flexures.values()))

    def momentum(self) -> FloatArray:
        """(6,) linear momentum [N s] and angular momentum about the world's origin [N m s], now."""
        return kernel.momentum(self.tree, self._base, self.positions, self.velocities)

    def link_pose(self, link: str) -> tuple[FloatArray, FloatArray]:
        """Position (3,) and rotation matrix (3, 3) of a link's URDF frame in the world."""
        size, row = len(self.tree.parent), self._link(link)
        turns, origins, spare = np.empty((size, 3, 3)), np.empty((size, 3)), np.empty((2, size, 3))
        frames(self.tree, self._base, self.positions, turns, origins, spare[0], spare[1])
        return origins[row], turns[row]

    # -- step -----------------------------------------------------------------------------------------------------

    def step(self, count: int = 1) -> None:
        """Advance ``count`` time steps under ``torques`` (j,) on the joints and the ``loads`` on the links.

        Raises SimulationError when the forces of a step cannot be found or the state is no longer finite.
        """
        body = self.body
        assert body is not None
        first = self.tree.first
        for _ in range(count):
            pushes = self._solve()
            for link, force, place, torque in pushes:
                body.push_link(link - 1, force, place, torque)
            if first:
                own = self._force[:6].tolist()
                body.push_link(-1, own[:3], self._base[:3].tolist(), own[3:])
            body.push_joints((self._force[first:] + self.torques).tolist())
            self.world.advance()
            self.time += self.dt
            body.read_joints(self.positions, self._speeds[first:])
            if first:
                body.read_base(self._base, self._speeds[:6])
            if not np.isfinite(self._speeds).all() or np.abs(self._speeds).max() > SPEED_BOUND:
                raise SimulationError(f"the motion diverged at t = {self.time:.4g} s; take a shorter time step")
            for flexure, margin in zip(self.flexures.values(), self._margins.tolist(), strict=True):
                flexure.note(margin, self.time - self.dt)

    def _solve(self) -> list[tuple[int, list[float], list[float], list[float]]]:
        """Find the forces and the acceleration of the next step; returns the loads as the engine takes them."""
        first = self.tree.first
        known = np.zeros(len(self._speeds))
        known[first:] = self.torques
        pushes = []
        for load in self.loads:
            row, force, torque = self._link(load.link), np.array(load.force, float), np.array(load.torque, float)
            place = kernel.add_load(self.tree, self._base, self.positions, row, force, np.array(load.point, float),
                                    torque, known)  # fmt: skip
            pushes.append((row, force.tolist(), place.tolist(), torque.tolist()))
        assert self.body is not None
        points = [] if self.world.ground is None else contacts.candidates(
            self.body, self.world.ground, self.tree, self._base, self.positions, len(known)
        )  # fmt: skip
        weight = contacts.WEIGHT * float(self.tree.mass.sum())
        kind, most = _SCHEMES[self.scheme]
        for _ in range(contacts.PASSES):
            hold, stop = contacts.holds(points, self._speeds, self.dt, weight)
            done = kernel.step_forces(
                self.tree, self.springs, self._base, self.positions, self._speeds, known, self._drag, hold, stop,
                self.gravity, self.dt, kind, most, self._acceleration, self._force, self._margins,
            )  # fmt: skip
            if done < 0 or not contacts.revise(
                points, self._speeds, self._acceleration, self.dt, weight, self.friction
            ):  # fmt: skip
                break
        if done < 0:
            raise SimulationError(f"no forces found for the step at t = {self.time:.4g} s; take a shorter time step")
        return pushes

    # -- names ----------------------------------------------------------------------------------------------------

    def _column(self, name: str) -> int:
        if name not in self.joints:
            raise FlexureError(f"{self.path.name} has no moving joint {name!r}; it has {', '.join(self.joints)}")
        return self.joints[name]

    def _link(self, name: str) -> int:
        if name not in self.links:
            raise FlexureError(f"{self.path.name} has no link {name!r}; it has {', '.join(self.links)}")
        return self.links[name]

    def _flexure(self, name: str) -> FlexureJoint:
        if name not in self.flexures:
            raise FlexureError(f"no flexure {name!r} in this robot; it has {', '.join(self.flexures) or 'none'}")
        return self.flexures[name]
