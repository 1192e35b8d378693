"""
A leaf spring under a pure moment is an arc
===========================================

A straight leaf that a moment ``M`` bends by ``theta`` is an arc of a circle: ``M = E I theta / L``, its tip
at ``x = L sin(theta) / theta``, ``y = L (1 - cos(theta)) / theta``. The finite elements must give that, and so must
the fitted potential; a torsion spring, which is a pin, cannot.
"""

import matplotlib.pyplot as plt
import numpy as np

from tensegym.flexure import fit_joint, preset
from tensegym.flexure.fem import rotate

hinge = preset("leaf-spring")
theta = np.radians(np.linspace(3, 30, 10))
solution = rotate(hinge, theta)
states = solution.states()
length, leaf = hinge.length, hinge.leaves[0]
bending = hinge.material.youngs_modulus * leaf.width * leaf.thickness**3 / 12

arc = length * np.stack([np.sin(theta) / theta, (1 - np.cos(theta)) / theta], axis=1)
np.testing.assert_allclose(states.moment, bending * theta / length, rtol=1e-6)
np.testing.assert_allclose(states.tip, arc, atol=1e-7 * length)
print(f"largest error of the tip: {np.abs(states.tip - arc).max() / length:.1e} L")

# %%
# The models of this hinge, each asked for the pose under the same moment.

joint = fit_joint(hinge, held_out=0)
figure, axis = plt.subplots(figsize=(6, 3.5), layout="constrained")
axis.plot(np.degrees(theta), 0 * theta, color="black", label="arc")
misses = {}
for name in ("potential", "planar", "torsion"):
    poses = joint.model(name).poses(theta, np.zeros((len(theta), 2)))
    off = np.linalg.norm(poses.tip - arc, axis=1)
    misses[name] = off.max()
    axis.plot(np.degrees(theta), 1e3 * off, "o-", label=name)
axis.set_xlabel("turn [deg]")
axis.set_ylabel("tip off the arc [mm]")
axis.legend()
print({name: f"{1e3 * miss:.4f} mm" for name, miss in misses.items()})
assert misses["potential"] < 5e-6 < misses["torsion"]
