"""Flexible joints: hinge geometry, a beam FEM, the paper's spring models and a passive potential, from one package.

The package stands alone on numpy, scipy and numba. SI units inside; millimetres only in files and tables, and said so
in the column's name. Frames: base axes are fixed to the hinge's ground at A, x along the hinge, the tip B at (L, 0) at
rest; a tip position is of B in base axes, a force acts at the tip in base axes (dead: it keeps its direction), a moment
is about the tip, counterclockwise positive, theta is the turn of the tip's body.

What stands where, from the bottom up:

    states.py         States: (theta, tip, force, moment) of n equilibrium states, from a FEM or from a measurement
    hinge.py          Material, Body, Leaf, Hinge: a planar graph; presets.py; hinge_file.py: TOML in and out
    beam.py, fem.py   corotational beam and its solver: rotation, load and wrench control
    sampling.py       States from a hinge over many load paths; held-out random wrenches
    pseudo_rigid.py   1-DoF torsion spring (lambda, F1), planar spring (a, b, F2), axis drift, which model is enough
    planar_spring.py  the paper's planar spring: wrench, guarded inversion to stiffness diagrams, constant k
    potential.py      Potential: wrench, Jacobian, pose under a load; potential_fit.py: fit_potential(states, length)
    joint_file.py     save and load a fitted Potential
    errors_table.py   held-out errors of every model
    commands/         one module a command of `tensegym flexure`

Every fitting function takes a ``States`` and the rest length L [m] as its first two arguments.
"""
