"""The engines side by side on one robot, part by part: by how much they differ, and why.

    motion.py          nodes against time, in free flight and on the ground, beside the same engine a little off
    settling.py        the height at which the robot comes to rest on each face
    steps.py           the face that each tabulated pull ends on
    episodes.py        a policy's episodes, with intervals
    part.py            Part: what a comparison comes to
    picture.py         all of it in one picture
"""
