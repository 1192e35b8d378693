"""MuJoCo as an engine, and its files. Nothing else imports it, and nothing here but world.py and c_interface.py does.

    mjcf.py            MJCF of bodies and of a scene
    robot_mjcf.py      MJCF of a whole robot with MuJoCo's own tendons, to go on with there
    world.py           MujocoWorld: the protocol of engines (tensegym.engine)
    c_interface.py     MuJoCo's C interface, and the substeps with no Python in between
"""
