"""
Six rods stand half a rod apart
===============================

Six rods in three parallel pairs, 24 cables that all pull alike: which distance of the rods of a pair balances? With
rods of length ``L`` at a distance ``d`` a cable is as long as ``sqrt(d^2 + (L - d)^2 + L^2) / 2``, and all of
them pull alike where their sum is stationary: at ``d = L / 2``. There each is ``sqrt(3/8) L`` long.
"""

import matplotlib.pyplot as plt
import numpy as np

from tensegym.structure.equilibrium import out_of_balance
from tensegym.structure.form_finding import form_find
from tensegym.structure.structure import six_rod

# %%
# Form finding starts from the wrong distance and gets there by itself.

found = form_find(six_rod(rod_length=1.0, spacing=0.62), tension=10.0)
middles = found.nodes[found.rods].mean(axis=1)
apart = np.linalg.norm(middles[0] - middles[1:], axis=1)
distance = 2 * np.linalg.norm(middles - middles.mean(axis=0), axis=1)
np.testing.assert_allclose(distance, 0.5, atol=1e-9)
np.testing.assert_allclose(found.lengths(found.cables), np.sqrt(3 / 8), atol=1e-9)
print(f"rods of a pair: {distance[0]:.9f} L apart; every cable: {found.lengths(found.cables)[0]:.9f} L")

# %%
# What 10 N in every cable leaves on a node, for other distances:

spacings = np.linspace(0.3, 0.7, 41)
left = [np.linalg.norm(out_of_balance(six_rod(1.0, d), 10.0), axis=1).max() for d in spacings]
figure, axis = plt.subplots(figsize=(6, 3.5), layout="constrained")
axis.plot(spacings, left)
axis.set_xlabel("distance of parallel rods [L]")
axis.set_ylabel("force left on a node [N]")
assert abs(spacings[np.argmin(left)] - 0.5) < 1e-9
