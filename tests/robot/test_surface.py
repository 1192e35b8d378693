"""What lies over ground and boxes lies on their surface."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx
from scipy.spatial.transform import Rotation

from tensegym.physics.box import Box
from tensegym.physics.terrain import FLAT, Ground, Terrain, distance_to_ground
from tensegym.robot.surface import draped, on_ground, on_top


def tilted(degrees, axis, centre, half):
    return Box(centre, half, tuple(Rotation.from_euler(axis, degrees, degrees=True).as_quat()))


def test_a_ramp_rises_with_its_angle():
    """Of a slab of half thickness h the upper side is at z = (h - x sin a) / cos a, where it is turned by a about y."""
    ground = FLAT.holding([tilted(-20, "y", (0, 0, 0), (3, 1, 0.1))])
    x, a = np.linspace(0, 2, 5), np.radians(-20)
    at = on_top(ground, np.column_stack([x, 0 * x]))
    assert at[:, 2] == approx((0.1 - x * np.sin(a)) / np.cos(a))
    assert on_top(ground, np.array([[0.0, 1.01]]))[0, 2] == 0
    assert np.all(on_ground(ground, at[:, :2])[:, 2] == 0)


numbers = st.floats(-1, 1, allow_subnormal=False)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(numbers, numbers, st.floats(-180, 180), st.sampled_from(["x", "y", "z", "xyz"])), max_size=4),
       st.booleans(), st.tuples(numbers, numbers))  # fmt: skip
def test_the_top_is_on_the_surface_and_clear_above(boxes, rough, point):
    ground = Ground(Terrain(roughness=0.05, reach=2.0, seed=3).heights(0.1), 0.075) if rough else FLAT
    ground = ground.holding(tilted([angle] * len(axis) if len(axis) > 1 else angle, axis, (x, y, 0.1), (0.5, 0.3, 0.2))
                            for x, y, angle, axis in boxes)  # fmt: skip
    at = on_top(ground, np.array([point]))[0]
    tolerance = 0.01 if rough else 1e-9  # between the grid's points the engine has triangles
    assert distance_to_ground(at, ground) == approx(0, abs=tolerance)
    for above in (0.05, 0.3, 2.0):
        assert distance_to_ground(np.array([*at[:2], at[2] + above]), ground) > 0


def test_a_line_is_laid_over_a_bar():
    """Down to the ground before and behind it, and on its top between, through all its points."""
    ground = FLAT.holding([Box.between((0.9, -1.0, -0.3), (1.1, 1.0, 0.2))])
    line = draped(ground, np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0]]), 0.05)
    assert np.linalg.norm(np.diff(line[:, :2], axis=0), axis=1).max() <= 0.05 + 1e-12
    assert line[-1] == approx([2.0, 1.0, 0.0])
    assert line[(line[:, 0] > 0.9) & (line[:, 0] < 1.1), 2] == approx(0.2)
    assert np.all(line[(line[:, 0] < 0.9) | (line[:, 0] > 1.1), 2] == 0)
