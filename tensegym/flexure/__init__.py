"""Flexible joints: hinge geometry, a beam FEM, the paper's spring models and a passive potential, from one package.

The package stands alone on numpy, scipy and numba. SI units inside; millimetres only in files and tables, and said so
in the column's name. Frames: base axes are fixed to the hinge's ground at A, x along the hinge, the tip B at (L, 0) at
rest; a tip position is of B in base axes, a force acts at the tip in base axes (dead: it keeps its direction), a moment
is about the tip, counterclockwise positive, theta is the turn of the tip's body.

What stands where, from the bottom up:

    states.py            States: (theta, tip, force, moment) of n equilibrium states, from a FEM or from a measurement
    hinge.py             Material, Leaf, Hinge: a planar graph; presets.py; hinge_file.py: TOML in and out
    beam.py, chain.py,   corotational beam; one leaf condensed to its ends; a hinge's Newton step; paths and stability
    frame.py, newton.py
    fem.py               rotate (rotation control), apply_wrench (load and wrench control) -> Solution
    sampling.py          Box; States from a hinge over many load paths; random wrenches held out
    pseudo_rigid.py      where the paper puts its springs: lambda (F1), a and b (F2); centre_shift.py
    torsion_spring.py    1-DoF model; planar_spring.py: constant k; stiffness_diagram.py: the guarded inversion
    potential.py         Potential: wrench, Jacobian, pose under a load; potential_kernel.py: the same, compiled
    potential_fit.py     fit_potential(states, length) -> Fit; potential_residual.py: its equations and Jacobian
    certificate.py       proof of a potential on its box; passivity.py: work around closed loops
    joint.py             Joint: all models of one hinge with errors; fit_joint; joint_file.py: JSON in and out
    buckling.py          buckling load of a rod with a hinge in it; pin.py: RodPin, the pin that stands for the hinge
    load_solver.py       where a model stands under a wrench; model_choice.py: which model is enough
    pictures.py          hinges, torque, drift, stiffness, errors
    measured.py, ...     data of an experiment and its fit; track.py: pictures of the stand
    commands/            one module a command of `tensegym flexure`

Every fitting function takes a ``States`` and the rest length L [m] as its first two arguments.
"""
