"""
In free flight nothing turns the robot
======================================

Far from ground and gravity, with its drives at work, a robot changes its shape as it spins. Yet its angular momentum
stays to rounding, and its centre of mass goes straight on. An engine that integrates the velocity terms of turning
rods carelessly fails this.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.spatial.transform import Rotation

import tensegym

SPIN = np.array([0.8, -0.5, 1.2])  # rad/s


def flight(dt):
    """Times [s], angular momenta [kg m^2/s] and places of the centre [m] over 0.8 s of random commands."""
    design = tensegym.RobotDesign().with_(spin_damping=0.0)  # which acts on each rod from outside
    rng, rows = np.random.default_rng(0), []
    with tensegym.TensegrityRobot(design, dt=dt, ground=False) as robot:
        robot.reset_rotated(Rotation.identity())
        arms = robot.poses_in_world[:, :3] - robot.centre_of_mass_in_world()
        turning = np.concatenate([np.cross(SPIN, arms) + np.array([1, 0, 0]), np.tile(SPIN, (len(arms), 1))], axis=1)
        robot.reset_rotated(Rotation.identity(), velocities=turning)
        for _ in range(40):
            robot.command(robot.command_limit * rng.uniform(0, 0.5, 6))
            robot.step(round(0.02 / dt))
            _, angular = robot.momentum_in_world()
            rows.append([robot.time, *angular, *robot.centre_of_mass_in_world()])
    return np.split(np.array(rows), [1, 4], axis=1)


times, momenta, centres = flight(2e-3)
size = np.linalg.norm(momenta[0])
wander = np.linalg.norm(momenta - momenta[0], axis=1) / size
print(f"angular momentum {size:.3f} kg m^2/s, which wanders by {wander.max():.1e} of it")
assert wander.max() < 1e-9

# %%
# The centre of mass moves at the 1 m/s it was given, to rounding.

way = centres - centres[0]
np.testing.assert_allclose(way, (times - times[0]) * [[1.0, 0.0, 0.0]], atol=1e-9)

figure, axis = plt.subplots(figsize=(6, 3.5), layout="constrained")
axis.plot(times, momenta, label=["x", "y", "z"])
axis.set_xlabel("time [s]")
axis.set_ylabel("angular momentum [kg m^2/s]")
axis.legend()
