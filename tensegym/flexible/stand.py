"""The paper's stand in PyBullet: a dynamometer on its guide pulls the arm, a camera sees arm and marker.

Rakshin and Borisov 2023, fig. 4: the arm is 120 mm beyond the hinge's tip; the guide stands across the undeformed arm,
so the force keeps its direction. The dynamometer is a spring balance between its carriage and the arm's end. The plane
of motion is upright before the camera, a little tilted, and there is no gravity, as the real stand lies flat.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.bullet import packaged_urdf
from tensegym.errors import FlexureError, SimulationError
from tensegym.flexure.models.joint import Joint, Model

from .flexible_robot import FlexibleRobot
from .flexure_joint import FlexureJoint
from .load import Load

ARM, LENGTH = 0.12, 0.04  # m, of the URDF: the arm beyond the tip, the hinge
END = (0.14, 0.0, 0.0)  # m, the arm's end in its own frame, whose origin is half a hinge before the tip
BALANCE = 300.0  # N/m, the dynamometer's spring
DRIVE, DRIVE_DAMPING = 2e3, 40.0  # N/m, N s/m: what moves the carriage of 0.2 kg
TILT = 1.7  # deg, of the stand before the camera: edges along the rows of pixels would all round the same way
_TURN = Rotation.from_euler("xy", [90, -TILT], degrees=True)
UPRIGHT = (0.0, 0.0, 0.0, *_TURN.as_quat())
ALONG_GUIDE = _TURN.apply([0.0, 1.0, 0.0])
EYE, TARGET = (0.09, -0.42, 0.0), (0.09, 0.0, 0.0)
SETTLING = 0.02  # s, loss time while pulling: a state at rest does not depend on it
STILL, PATIENCE = 1e-6, 8.0  # m/s and rad/s at which a state counts as at rest; s it may take
PACE = 0.2  # m/s, the carriage's


@dataclass(frozen=True)
class Pull:
    """States of the stand at rest, one row each."""

    poses: FloatArray
    """(n, 3) tip x, y [m] and theta [rad] that the joint in PyBullet reads."""
    force: FloatArray
    """(n,) the dynamometer's reading [N], along y."""
    pictures: tuple[NDArray[np.uint8], ...]
    """(n) of (h, w, 3); empty when none were asked for."""
    rest: NDArray[np.uint8] | None
    """The unloaded stand."""

    def moment(self, arm: float = ARM) -> FloatArray:
        """(n,) moment about the tip [N m]."""
        return arm * self.force * np.cos(self.poses[:, 2])


def build_stand(joint: Joint, *, dt: float = 1e-3, loss_time: float = 0.0,
                kind: str = "potential") -> tuple[FlexibleRobot, FlexureJoint]:  # fmt: skip
    """The stand with this joint. Raises FlexureError for a hinge that the stand does not take."""
    if abs(joint.length - LENGTH) > 1e-9:
        raise FlexureError(f"the stand takes hinges of {1e3 * LENGTH:g} mm; this one has L = {1e3 * joint.length:g} mm")
    urdf = packaged_urdf("flexure_stand.urdf")
    assert urdf is not None
    robot = FlexibleRobot(urdf, dt=dt, gravity=(0, 0, 0), pose=UPRIGHT, fixed_base=True)
    try:
        return robot, FlexureJoint(robot, "hinge", joint, kind=kind, loss_time=loss_time)
    except FlexureError:
        robot.close()
        raise


def arm_state(model: Model, theta: float, limit: float) -> tuple[float, FloatArray]:
    """How the arm is held at an angle.

    Args:
        model: of the joint.
        theta: [rad].
        limit: largest force either way [N].

    Returns:
        Force along y at the arm's end [N], and the tip (2,) there [m].

    Raises:
        FlexureError: where no force within the limit holds it.
    """

    def miss(force: float) -> float:
        moment = model.poses(np.array([theta]), np.array([[0.0, force]])).moment[0]
        return float(moment - ARM * force * np.cos(theta))

    if miss(-limit) * miss(limit) > 0:
        raise FlexureError(f"no force up to {limit:.4g} N at the arm's end holds {np.degrees(theta):.4g} deg")
    force = float(brentq(miss, -limit, limit, xtol=1e-15))
    return force, model.poses(np.array([theta]), np.array([[0.0, force]])).tip[0]


def pull(joint: Joint, count: int = 31, *, max_angle: float | None = None, picture: tuple[int, int] | None = None,
         dt: float = 1e-3) -> Pull:  # fmt: skip
    """Move the carriage from place to place; at each wait until all is at rest, and read.

    Args:
        joint: of a hinge of 40 mm.
        count: places, even over the range.
        max_angle: half range of the arm [rad]; default: 98 % of the fitted one.
        picture: width and height of the pictures [px]; none without.
        dt: time step [s].

    Raises:
        FlexureError: for a hinge that the stand does not take.
        SimulationError: where it does not come to rest.
    """
    angle = 0.98 * joint.box.max_angle if max_angle is None else max_angle
    robot, flexure = build_stand(joint, dt=dt, loss_time=SETTLING)
    with robot:
        force, tip = arm_state(flexure.spring, angle, joint.box.max_force)
        reach = tip[1] + ARM * np.sin(angle) + force / BALANCE
        rest = picture_of(robot, picture) if picture else None
        poses, forces, pictures = [], [], []
        for place in np.linspace(-reach, reach, count):
            forces.append(_settle(robot, float(place)))
            poses.append(flexure.pose)
            if picture:
                pictures.append(picture_of(robot, picture))
    return Pull(np.array(poses), np.array(forces), tuple(pictures), rest)


def _settle(robot: FlexibleRobot, place: float) -> float:
    """Step until everything is at rest with the carriage driven to ``place`` [m]; returns the dynamometer's reading."""
    guide, dt = robot.joints["guide"], robot.dt
    target = robot.positions[guide]
    for step in range(round(PATIENCE / dt)):
        origin, turn = robot.link_pose("arm")
        end = float(ALONG_GUIDE @ (origin + turn @ np.array(END)))
        at = robot.positions[guide]
        reading = BALANCE * (at - end)
        robot.loads = [Load("arm", tuple((reading * ALONG_GUIDE).tolist()), END)]
        target += float(np.clip(place - target, -PACE * dt, PACE * dt))
        robot.torques[guide] = DRIVE * (target - at) - DRIVE_DAMPING * robot.rates[guide] - reading
        robot.step()
        if step % 20 == 19 and target == place and np.abs(robot.velocities).max() < STILL:
            return float(reading)
    raise SimulationError(f"the stand is not at rest after {PATIENCE:g} s")


def picture_of(robot: FlexibleRobot, size: tuple[int, int]) -> NDArray[np.uint8]:
    """(h, w, 3) what the stand's camera sees, twice as fine averaged: edges get their grey."""
    width, height = size
    rgb, _ = robot.world.camera.image(EYE, TARGET, 2 * width, 2 * height)
    fine = rgb.reshape(height, 2, width, 2, 3).astype(float)
    coarse: NDArray[np.uint8] = np.round(fine.mean(axis=(1, 3))).astype(np.uint8)
    return coarse


@dataclass(frozen=True)
class Vibration:
    """The arm let go."""

    time: FloatArray
    """(n,) [s]."""
    theta: FloatArray
    """(n,) [rad]."""
    energy: FloatArray
    """(n,) kinetic and elastic [J]."""

    @property
    def frequency(self) -> float:
        """From the interpolated falling zeros [Hz]; NaN with fewer than two."""
        theta, time = self.theta, self.time
        i = np.flatnonzero((theta[:-1] > 0) & (theta[1:] <= 0))
        zeros = time[i] + theta[i] / (theta[i] - theta[i + 1]) * (time[i + 1] - time[i])
        return float((len(zeros) - 1) / (zeros[-1] - zeros[0])) if len(zeros) > 1 else np.nan

    @property
    def decrement(self) -> float:
        """Logarithmic decrement of the energy a period, halved (amplitude goes with its root), over whole periods."""
        periods = np.floor((self.time[-1] - self.time[0]) * self.frequency)
        if not periods >= 1:
            return np.nan
        end = np.interp(self.time[0] + periods / self.frequency, self.time, self.energy)
        return float(0.5 * np.log(self.energy[0] / end) / periods)


def release(joint: Joint, angle: float, seconds: float, *, dt: float = 1e-3, loss_time: float = 0.0,
            kind: str = "potential") -> Vibration:  # fmt: skip
    """Hold the arm at an angle by its end and let go.

    Args:
        joint: of a hinge of 40 mm.
        angle: [rad].
        seconds: how long it is followed [s].
        dt: time step [s].
        loss_time: structural damping B = loss time x K [s].
        kind: which of the joint's models.
    """
    robot, flexure = build_stand(joint, dt=dt, loss_time=loss_time, kind=kind)
    with robot:
        _, tip = arm_state(flexure.spring, angle, joint.box.max_force)
        robot.place(robot.place_tip("hinge", [*tip, angle]))
        theta, energy = [angle], [robot.energies().total]
        for _ in range(round(seconds / dt)):
            robot.step()
            theta.append(flexure.pose[2])
            energy.append(robot.energies().total)
    return Vibration(np.arange(len(theta)) * np.float64(dt), np.array(theta), np.array(energy))
