"""FlexibleRobot: any URDF in PyBullet, with revolute joints replaced by fitted flexures."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import cast

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.bullet import Articulated, Client
from tensegym.engine import Closed, Uncopied
from tensegym.errors import FlexureError
from tensegym.flexure.hinge.ranges import check_choice, check_not_negative, check_positive, finite_array
from tensegym.physics.readings import Energies

from . import step_kernel
from .flexible_urdf import ORIGIN, FlexibleUrdf
from .flexure_joint import FlexureJoint, Outside
from .load import Load
from .springs import Springs, spring_table
from .stepper import SCHEMES, Scheme, Stepper
from .tree import read_tree
from .tree_kernel import frames


class FlexibleRobot(Uncopied):
    """A URDF's robot in a world of its own. Its joints are free of motors; flexures and ``torques`` move them.

    A context manager. Build flexures in with ``FlexureJoint(robot, "knee", joint)``.

    Args:
        urdf: path of the file; it stays as it is.
        dt: time step [s].
        gravity: (3,) in the world [m/s^2].
        pose: (7,) of the URDF's base link in the world, position [m] and quaternion xyzw.
        fixed_base: the base link does not move.
        ground: add the plane z = 0.
        friction: Coulomb coefficient between robot and ground.
        scheme: trapezoid (step_kernel.py), linear (its first Newton iteration) or explicit (forces of the state as it
            is, stable for dt < 2 / the fastest frequency).
        gui: open PyBullet's window.

    Attributes:
        joints: column of every moving joint by name.
        links: row of every link by name.
        flexures: the FlexureJoints by the joint they replaced.
        torques: (j,) force or torque on every moving joint [N, N m], to be set.
        loads: dead loads on links, to be set.

    Raises:
        FlexureError: for a URDF that is none or cannot mean what it says, or a value out of range.
        FileNotFoundError: for a path that is not there.
    """

    body: Articulated
    _stepper: Stepper

    def __init__(
        self, urdf: str | Path, *, dt: float = 1e-3, gravity: Sequence[float] = (0.0, 0.0, -9.81),
        pose: Sequence[float] = ORIGIN, fixed_base: bool = False, ground: bool = False, friction: float = 0.8,
        scheme: Scheme = "trapezoid", gui: bool = False,
    ) -> None:  # fmt: skip
        check_positive("dt", dt, "s")
        check_not_negative("friction", friction, "")
        check_choice("scheme", scheme, tuple(SCHEMES))
        fixed_base = bool(fixed_base)
        self.urdf = FlexibleUrdf(urdf, fixed_base)
        for note in self.urdf.notes:
            warnings.warn(f"{self.urdf.path.name}: {note}", UserWarning, stacklevel=2)
        self.dt, self.scheme, self.fixed_base, self.friction = dt, scheme, fixed_base, friction
        self.gravity, self.base_pose = finite_array(gravity, "gravity", 3), finite_array(pose, "pose", 7)
        self.flexures: dict[str, FlexureJoint] = {}
        self.loads: list[Load] = []
        self.world = Client(dt, 0.0, gui)
        self.world.set_gravity(self.gravity.tolist())
        if ground:
            self.world.add_ground(friction)
        self._load()

    def close(self) -> None:
        """Free the engine; what needs it raises SimulationError from now on."""
        self.world.close()
        self.body = self._stepper.body = cast(Articulated, Closed())

    def __enter__(self) -> FlexibleRobot:
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    # -- build ----------------------------------------------------------------------------------------------------

    def put(self, flexure: FlexureJoint) -> None:
        """Replace the revolute joint a flexure names and load the robot again, at rest. FlexureJoint calls it."""
        self.urdf.put(flexure.name, flexure.chain)
        flexure.row = len(self.flexures)
        self.flexures[flexure.name] = flexure
        self.body.remove()
        self._load()

    def _load(self) -> None:
        self.body = self.urdf.load(self.world, self.friction)
        if self.body.said:
            warnings.warn(f"{self.urdf.path.name}: PyBullet says: {self.body.said}", UserWarning, stacklevel=3)
        if self.fixed_base and not self.body.moving:
            self.world.close()
            raise FlexureError(f"{self.urdf.path.name} has no joint that moves, and nothing else does on a fixed base; "
                               "take fixed_base=False")  # fmt: skip
        self.joints = {self.body.joint_info[i][1].decode(): column for column, i in enumerate(self.body.moving)}
        self.links = self.urdf.link_rows(self.body)
        flexures = list(self.flexures.values())
        columns = [[-1 if name is None else self.joints[name] for name in self.urdf.chains[f.name]] for f in flexures]
        springs = spring_table(
            [f.spring for f in flexures], columns, [f.across or (0.0, 0.0, 0.0) for f in flexures],
            [f.loss_time for f in flexures], [f.box for f in flexures],
        )  # fmt: skip
        self._stepper = Stepper(self.body, self.world.ground, read_tree(self.body, self.fixed_base), springs,
                                self.gravity, self.friction, self.dt, self.scheme)  # fmt: skip
        self.torques = np.zeros(len(self.joints))
        self.place()

    # -- state ----------------------------------------------------------------------------------------------------

    def place(
        self, joints: Mapping[str, float] | None = None, rates: Mapping[str, float] | None = None,
        pose: Sequence[float] | None = None, twist: Sequence[float] = (0.0,) * 6,
    ) -> None:  # fmt: skip
        """Start anew. A flexure's tip is placed with ``place_tip``.

        Args:
            joints: positions by name [m, rad], zero where not named.
            rates: of the joints by name [m/s, rad/s], zero where not named.
            pose: (7,) of the base link in the world, default: the robot's own.
            twist: (6,) velocity of a floating base's centre, linear [m/s] and angular [rad/s] in the world.
        """
        where = self.base_pose if pose is None else finite_array(pose, "pose", 7)
        state, tree, turn = self._stepper, self._stepper.tree, Rotation.from_quat(where[3:])
        state.base[:3] = where[:3] + turn.apply(tree.centre[0])
        state.base[3:] = (turn * Rotation.from_matrix(tree.turn[0]).inv()).as_quat()
        state.positions[:], state.speeds[:] = 0.0, 0.0
        for name, value in (joints or {}).items():
            state.positions[self._column(name)] = finite_array([value], f"position of {name}", 1)[0]
        for name, value in (rates or {}).items():
            state.speeds[tree.first + self._column(name)] = finite_array([value], f"rate of {name}", 1)[0]
        if tree.first:
            state.speeds[:6] = finite_array(twist, "twist", 6)
        for flexure in self.flexures.values():
            flexure.outside = Outside(0, 1.0, 0.0)
        state.start(self.torques, self._loads())

    def place_tip(self, name: str, pose: ArrayLike) -> dict[str, float]:
        """Joint positions, for ``place``, that put a flexure's tip at (x, y, theta) [m, rad] in its base axes."""
        if name not in self.flexures:
            raise FlexureError(f"no flexure {name!r} in this robot; it has {', '.join(self.flexures) or 'none'}")
        x, y, theta = finite_array(pose, "pose", 3)
        along, across, *_ = self.urdf.chains[name]
        if along is None or across is None:  # a pin
            return {name: float(theta)}
        return {along: float(x - self.flexures[name].spring.length), across: float(y), name: float(theta)}

    @property
    def time(self) -> float:
        """Since the robot was placed [s]."""
        return self._stepper.time

    @property
    def springs(self) -> Springs:
        """The flexures' models as arrays."""
        return self._stepper.springs

    @property
    def positions(self) -> FloatArray:
        """(j,) of the moving joints, columns as ``joints`` names them."""
        return self._stepper.positions

    @property
    def rates(self) -> FloatArray:
        """(j,) joint rates as the engine has them, half a step before the positions."""
        return self._stepper.speeds[self._stepper.tree.first :]

    @property
    def velocities(self) -> FloatArray:
        """(n,) base velocity (6, floating only) and joint rates at the time of the positions."""
        return self._stepper.velocities(self.torques, self._loads())

    def energies(self) -> Energies:
        """Now [J], velocities taken at the time of the positions; gravity's is zero with every centre at the origin."""
        state = self._stepper
        kinetic, gravity = step_kernel.kinetic_and_gravity(state.tree, state.base, state.positions, self.velocities,
                                                    self.gravity)  # fmt: skip
        return Energies(kinetic, gravity, sum(flexure.energy for flexure in self.flexures.values()))

    def momentum(self) -> FloatArray:
        """(6,) linear momentum [N s] and angular momentum about the world's origin [N m s], now."""
        state = self._stepper
        return np.asarray(step_kernel.momentum(state.tree, state.base, state.positions, self.velocities))

    def link_pose(self, link: str) -> tuple[FloatArray, FloatArray]:
        """Position (3,) and rotation matrix (3, 3) of a link's URDF frame in the world."""
        row, state, size = self._link(link), self._stepper, len(self.links)
        turns, origins, spare = np.empty((size, 3, 3)), np.empty((size, 3)), np.empty((2, size, 3))
        frames(state.tree, state.base, state.positions, turns, origins, spare[0], spare[1])
        return origins[row], turns[row]

    # -- step -----------------------------------------------------------------------------------------------------

    def step(self, count: int = 1) -> None:
        """Advance ``count`` time steps under ``torques`` (j,) on the joints and the ``loads`` on the links.

        Raises SimulationError when the forces of a step cannot be found or the state is no longer finite.
        """
        loads, stepper = self._loads(), self._stepper
        for _ in range(count):
            began = stepper.time
            stepper.step(self.torques, loads)
            for flexure, margin in zip(self.flexures.values(), stepper.margins.tolist(), strict=True):
                flexure.note(margin, began)

    # -- names ----------------------------------------------------------------------------------------------------

    def _loads(self) -> list[tuple[int, Load]]:
        """The loads with their links' rows."""
        return [(self._link(load.link), load) for load in self.loads]

    def _column(self, name: str) -> int:
        if name not in self.joints:
            raise FlexureError(f"{self.urdf.path.name} has no moving joint {name!r}; it has {', '.join(self.joints)}")
        return self.joints[name]

    def _link(self, name: str) -> int:
        if name not in self.links:
            raise FlexureError(f"{self.urdf.path.name} has no link {name!r}; it has {', '.join(self.links)}")
        return self.links[name]
