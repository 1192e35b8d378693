"""The compiled substep and nothing else.

    substep.py         the kernel: from poses to one force and one moment a body
    model.py           Model, State and Out, the arrays it works on
    robot_arrays.py    a design flattened into a Model; the explicit step limit
    geometry.py        lengths, directions and moment arms of springs
    cable_law.py       the force law, explicit and implicit
    mobility.py        what unit tensions do to the rates of all lengths
    spin.py            the damping of rods that spin about their axes
    split_rods.py      rods of two halves that a pin joins
    joints.py          ball joints of rods that share nodes, linearised
    drives.py          winch drives
    terrain.py         the ground
    readings.py        velocities, momentum and energies from the arrays
    vectors.py         vectors, rotations and small matrices for kernels
"""
