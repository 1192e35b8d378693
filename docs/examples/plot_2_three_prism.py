"""
The three-rod prism twists by 30 degrees
========================================

The smallest tensegrity: three rods between two triangles of cables and three cables up the sides. It balances at one
twist alone, 30 degrees beyond where the rods would stand straight in a row of the cables (150 degrees between the ends
of a rod), whatever its size. Where all cables pull alike, the triangles' cables are ``sqrt(3)`` times
as long as the others.
"""

import matplotlib.pyplot as plt
import numpy as np

from tensegym.structure.equilibrium import count_states
from tensegym.structure.form_finding import form_find
from tensegym.structure.structure import Structure

corners = 2 * np.pi * np.arange(3) / 3
ring = 0.3 * np.stack([np.cos(corners), np.sin(corners), 0 * corners], axis=1)
straight = Structure(
    nodes=np.concatenate([ring, ring + np.array([0, 0, 0.25])]),
    rods=[[0, 4], [1, 5], [2, 3]],
    cables=[[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]],
    stiff_cables=np.zeros((0, 2), int),
)
twisted = form_find(straight, tension=10.0)

# %%
# Both numbers, from the nodes that form finding ends with.

lengths = twisted.lengths(twisted.cables)
ratio = lengths[:6].mean() / lengths[6:].mean()
np.testing.assert_allclose(ratio, np.sqrt(3), rtol=1e-6)

axis = np.cross(*(twisted.nodes[[1, 2]] - twisted.nodes[0]))
axis /= np.linalg.norm(axis)
flat = [twisted.nodes[k : k + 3] - twisted.nodes[k : k + 3].mean(axis=0) for k in (0, 3)]
turn = np.degrees(np.arctan2(np.cross(flat[0][0], flat[1][1]) @ axis, flat[0][0] @ flat[1][1]))
np.testing.assert_allclose(abs(turn), 150, atol=1e-4)
states = count_states(twisted)
assert states.self_stress_states == 1 and states.mechanisms == 1
print(f"triangle over side: {ratio:.9f}; from end to end of a rod: {turn:.6f} deg; "
      f"{states.self_stress_states} self-stress, {states.mechanisms} mechanism")

# %%
# Rods thick, cables thin; the start in grey.

figure = plt.figure(figsize=(5, 4.5), layout="constrained")
picture = figure.add_subplot(projection="3d")
for structure, colour in ((straight, "0.8"), (twisted, None)):
    for pairs, width, own in ((structure.rods, 4, "#0072b2"), (structure.cables, 1, "#d55e00")):
        for a, b in pairs:
            picture.plot(*structure.nodes[[a, b]].T, color=colour or own, linewidth=width)
picture.set_box_aspect((1, 1, 0.8))
picture.set_xlabel("x [m]")
picture.set_ylabel("y [m]")
picture.set_zlabel("z [m]")
