"""The physics against closed forms, each measured on the running code. Source of the values: docs/physics.md."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from tensegym.arrays import FloatArray
from tensegym.design.design import RobotDesign, flexible_design
from tensegym.design.parameters import Drive, ElasticCable, Rod
from tensegym.errors import StructureError
from tensegym.physics import drives as drive_kernel
from tensegym.robot.robot import TensegrityRobot
from tensegym.structure.equilibrium import check_balance, count_states, feasible_self_stress
from tensegym.structure.faces import hull_faces, resting_height, tip_geometry
from tensegym.structure.form_finding import form_find
from tensegym.structure.modes import breathing_frequency, free_modes
from tensegym.structure.structure import Structure, paper, six_rod


@dataclass(frozen=True)
class Check:
    """One row: measured is within tolerance of expected, in the unit of the quantity."""

    id: str
    quantity: str
    expected: float
    measured: float
    tolerance: float

    @property
    def passed(self) -> bool:
        return bool(abs(self.measured - self.expected) <= self.tolerance)


def statics() -> Iterator[Check]:
    """S1 to S7: the six-rod self-stress."""
    unit = paper().nodes / 0.7016
    found = form_find(paper().with_nodes(unit), 10.0)
    spacing = np.linalg.norm(found.nodes[found.rods].mean(axis=1)[1] - found.nodes[found.rods].mean(axis=1)[0])
    yield Check("S1", "pair spacing / L, form-found from the paper's nodes", 0.5, float(spacing), 1e-9)
    cables = found.lengths(found.cables)
    yield Check("S2", "cable / L, the one furthest off", np.sqrt(6) / 4, _furthest(cables, np.sqrt(6) / 4), 1e-6)
    exact = six_rod(1.0)
    elastic = count_states(exact)
    density = elastic.basis[:, 0]
    yield Check("S3", "force density rod / cable, furthest off", -1.5,
                _furthest(np.divide.outer(density[24:], density[:24]).ravel(), -1.5), 1e-9)  # fmt: skip
    ratio = density[24:, None] * 1.0 / (density[:24] * np.sqrt(6) / 4)
    yield Check("S4", "force rod / cable, furthest off", -np.sqrt(6), _furthest(ratio.ravel(), -np.sqrt(6)), 1e-9)
    yield Check("S5", "rank, 24 cables and 6 rods", 29, elastic.rank, 0)
    yield Check("S5", "self-stress states", 1, elastic.self_stress_states, 0)
    yield Check("S5", "mechanisms", 1, elastic.mechanisms, 0)
    all_members = count_states(exact, stiff=True)
    yield Check("S6", "self-stress states with the 6 stiff cables", 6, all_members.self_stress_states, 0)
    yield Check("S6", "mechanisms with them", 0, all_members.mechanisms, 0)
    yield Check("S6", "all 30 cables can pull at once (1 yes, 0 no)", 0,
                float(feasible_self_stress(exact, stiff=True) is not None), 0)  # fmt: skip
    off = count_states(paper())
    yield Check("S7", "self-stress states at the paper's spacing", 0, off.self_stress_states, 0)
    yield Check("S7", "mechanisms at the paper's spacing", 0, off.mechanisms, 0)
    yield Check("S7", "the paper's nodes hold a prestress (1 yes, 0 no)", 0, float(_balances(paper())), 0)


def _balances(structure) -> bool:
    try:
        check_balance(structure, 10.0)
    except StructureError:
        return False
    return True


def _furthest(values: FloatArray, target: float) -> float:
    return float(values[np.abs(values - target).argmax()])


PRINTED_MODES = ((1.819, 1), (5.238, 3), (6.581, 3), (7.290, 2), (9.301, 3), (11.048, 3), (12.328, 2), (14.052, 3),
                 (19.004, 3), (21.236, 1))  # fmt: skip


def modes() -> Iterator[Check]:
    """M2: free elastic modes, L 1 m, m 1 kg slender rods, k 1000 N/m, T 10 N."""
    found = free_modes(six_rod(1.0), 10.0, 1000.0, 1.0, 1 / 12).multiplicities()
    yield Check("M2", "distinct frequencies", len(PRINTED_MODES), len(found), 0)
    for (frequency, count), (measured, repeats) in zip(PRINTED_MODES, found, strict=True):
        yield Check("M2", f"mode of {frequency:.3f} Hz, {count}-fold: Hz", frequency, measured, 5.1e-4)
        yield Check("M2", f"mode of {frequency:.3f} Hz: multiplicity", count, repeats, 0)


def equal_rods(damping: float) -> RobotDesign:
    """Six equal rods and the 24 elastic cables tied on the axes, no spin damping: the closed forms' robot."""
    whole = six_rod()
    return RobotDesign(
        structure=Structure(whole.nodes, whole.rods, whole.cables, np.zeros((0, 2), int)),
        active_rod=Rod(),
        passive_rod=Rod(),
        elastic_cable=ElasticCable(damping=damping),
        attachment_radius=0.0,
        spin_damping=0.0,
    )


def breathe(damping: float, dt: float = 1e-3, periods: int = 30) -> tuple[float, float]:
    """Breathing mode in free flight in PyBullet: frequency [Hz] from zero crossings, damping ratio from peaks."""
    with TensegrityRobot(equal_rods(damping), dt=dt, ground=False) as robot:
        poses = robot.cables.rest_poses
        outward = poses[:, :3] - poses[:, :3].mean(axis=0)
        velocities = np.zeros((6, 6))
        velocities[:, :3] = 2e-3 * outward / np.linalg.norm(outward, axis=1)[:, None]
        robot.reset_rotated(Rotation.identity(), velocities)
        expected = breathing_frequency(10.0, robot.design.mass / 6, robot.design.standing.lengths([[0, 4]])[0])
        speeds = []
        for _ in range(int(periods / expected / dt)):
            robot.step()
            v, x = robot.velocities_in_world()[:, :3], robot.poses_in_world[:, :3]
            radial = x - x.mean(axis=0)
            speeds.append(((v * radial).sum(axis=1) / np.linalg.norm(radial, axis=1)).mean())
    s = np.array(speeds)
    falls = np.flatnonzero((s[:-1] > 0) & (s[1:] <= 0))
    crossings = (falls + s[falls] / (s[falls] - s[falls + 1])) * dt
    frequency = (len(crossings) - 1) / (crossings[-1] - crossings[0])
    peaks = [s[a:b].max() for a, b in pairwise(falls)]
    decrement = np.log(peaks[0] / peaks[-1]) / (len(peaks) - 1)
    return float(frequency), float(decrement / (2 * np.pi))


def breathing() -> Iterator[Check]:
    """M1 and M3 in PyBullet at 1 ms."""
    design = equal_rods(0.0)
    expected = breathing_frequency(10.0, design.passive_rod.mass, design.standing.lengths([[0, 4]])[0])
    frequency, _ = breathe(0.0)
    yield Check("M1", "breathing mode in PyBullet, 1 ms: Hz", expected, frequency, 5e-4 * expected)
    _, ratio = breathe(5.0)
    yield Check("M3", "its damping ratio with cable dampers of 5 N s/m", 0.0, ratio, 1e-4)


def geometry() -> Iterator[Check]:
    """G1 to G3: resting heights and tips of equal-mass rods, L = 1 m."""
    structure = six_rod(1.0)
    faces, centre = hull_faces(structure), structure.nodes.mean(axis=0)
    heights = np.array([resting_height(structure.nodes, t, centre) for t in faces.triangles])
    yield Check("G1", "closed faces", 8, int(faces.closed.sum()), 0)
    yield Check("G1", "open faces", 12, int((~faces.closed).sum()), 0)
    for name, kind, height in (("closed", faces.closed, np.sqrt(3) / 4), ("open", ~faces.closed, 1 / np.sqrt(5))):
        yield Check("G1", f"resting height / L, {name} face", height, _furthest(heights[kind], height), 1e-9)
    for face in np.flatnonzero(faces.closed)[:1]:
        tip = tip_geometry(faces, structure.nodes, centre, face, faces.neighbours[face][0])
        yield Check("G2", "closed to open: angle, deg", 39.23, float(np.degrees(tip.angle)), 5e-3)
        yield Check("G2", "closed to open: barrier / L", 0.03469, tip.barrier, 5e-6)
        yield Check("G2", "closed to open: travel / L", 0.3137, tip.travel, 5e-5)
    face = int(np.flatnonzero(~faces.closed)[0])
    other = next(n for n in faces.neighbours[face] if not faces.closed[n])
    tip = tip_geometry(faces, structure.nodes, centre, face, other)
    yield Check("G3", "open to open: angle, deg", 53.13, float(np.degrees(tip.angle)), 5e-3)
    yield Check("G3", "open to open: barrier / L", 0.05279, tip.barrier, 5e-6)
    yield Check("G3", "open to open: travel / L", 0.4472, tip.travel, 5e-5)


@dataclass(frozen=True)
class FreeFlight:
    """Relative drift of linear and angular momentum, least tension, and tensions of cables that were slack."""

    linear_drift: float
    angular_drift: float
    least_tension: float
    slack_tension: float
    slack_seen: int


def free_flight(
    dt: float = 1e-3, seconds: float = 2.0, seed: int = 0, design: RobotDesign | None = None
) -> FreeFlight:
    """Fly without gravity, tumbling, the drives commanded at random every 0.2 s; default: six rods, no spin damping."""
    rng = np.random.default_rng(seed)
    with TensegrityRobot(design or RobotDesign(spin_damping=0.0), dt=dt, ground=False) as robot:
        rest = robot.cables.rest_poses[:, :3]
        turning, moving = np.array([1.0, 2.0, -1.5]), np.array([0.3, -0.2, 0.1])
        centre = robot.cables.masses @ rest / robot.cables.masses.sum()
        velocities = np.hstack([moving + np.cross(turning, rest - centre), np.tile(turning, (len(rest), 1))])
        robot.reset_rotated(Rotation.identity(), velocities)
        start = robot.momentum_in_world()
        least, slack_tension, slack_seen, linear, angular = np.inf, 0.0, 0, 0.0, 0.0
        for _ in range(round(seconds / 0.2)):
            robot.command(rng.uniform(0, 1, len(robot.drives)) * robot.command_limit)
            for _ in range(round(0.2 / dt)):
                before = robot.natural_lengths.copy()
                robot.step()
                slack = robot.lengths < before
                least = min(least, robot.tensions.min())
                slack_tension = max(slack_tension, np.abs(robot.tensions[slack]).max(initial=0.0))
                slack_seen += int(slack.sum())
            now = robot.momentum_in_world()
            linear = max(linear, float(np.linalg.norm(now[0] - start[0]) / np.linalg.norm(start[0])))
            angular = max(angular, float(np.linalg.norm(now[1] - start[1]) / np.linalg.norm(start[1])))
    return FreeFlight(float(linear), float(angular), float(least), float(slack_tension), slack_seen)


def flight() -> Iterator[Check]:
    """I1: momentum and one-sided cables in free flight, of rigid and of flexible rods."""
    for rods, design in (("", RobotDesign()), (", flexible rods", flexible_design())):
        seen = free_flight(design=design.with_(spin_damping=0.0))
        yield Check("I1", f"linear momentum, relative drift in 2 s{rods}", 0.0, seen.linear_drift, 1e-6)
        yield Check("I1", f"angular momentum, relative drift in 2 s{rods}", 0.0, seen.angular_drift, 1e-6)
        yield Check("I1", f"least tension, N, where negative{rods}", 0.0, min(seen.least_tension, 0.0), 0)
        yield Check("I1", f"tension of slack cables, N{rods}", 0.0, seen.slack_tension, 0)


def drive_speed(tension: float, drive: Drive | None = None) -> float:
    """Steady winding speed [m/s] against a constant cable tension [N], full command."""
    constants = drive_kernel.drive_constants(drive or Drive())
    state = np.zeros(drive_kernel.STATE_SIZE)
    state[drive_kernel.COMMAND] = 1e4
    for _ in range(300):
        drive_kernel.drive_step(constants, state, tension, 1e-3)
    return state[drive_kernel.PULLED] / 1e-3


def drive_figures() -> Iterator[Check]:
    """The drive's four figures."""
    yield Check("drive", "unloaded speed, m/s", 0.197, drive_speed(0.0), 0.002)
    yield Check("drive", "speed at the nominal 41 N, m/s", 0.121, drive_speed(41.0), 0.002)
    yield Check("drive", "tension at the nominal 0.121 m/s, N", 41.0,
                brentq(lambda t: drive_speed(t) - 0.121, 1, 80), 1.0)  # fmt: skip
    yield Check("drive", "largest tension it winds against, N", 82.0,
                brentq(lambda t: drive_speed(t) - 1e-4, 50, 150), 1.5)  # fmt: skip


ALL: tuple[Callable[[], Iterator[Check]], ...] = (statics, breathing, modes, geometry, flight, drive_figures)
