"""A rod that a flexure splits: its halves, the load at which it buckles, the pin that stands for its hinge."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tensegym.errors import DesignError

from .parameters import RodFlexure

if TYPE_CHECKING:
    from tensegym.flexure.models.rod_pin import RodPin

PIN_TOLERANCE = 1.25  # of the buckling load with a split rod's pin over that with its hinge


def half_length(flexure: RodFlexure, length: float) -> float:
    """Of the tube on either side of the hinge in a rod of a length [m]. Raises DesignError when the hinge fills it."""
    half = (length - flexure.length) / 2
    if half <= 0:
        raise DesignError(
            f"RodFlexure.length = {flexure.length!r} is outside (0, {length:g}) m: the hinge is longer than the rod"
        )
    return half


def split_buckling_load(flexure: RodFlexure, length: float) -> float:
    """Compression under which a split rod of a length [m] bends out of line [N]."""
    from tensegym.flexure.fem.buckling import buckling_load

    half = half_length(flexure, length)
    return buckling_load(flexure.geometry(), half, half)


def standing_pin(flexure: RodFlexure, length: float, compression: float, rod: str) -> RodPin:
    """The pin and the torsion spring that stand for the hinge of a rod of a length [m] under its compression [N].

    Raises DesignError, naming the ``rod``, where the compression buckles it or no pin stands for its hinge.
    """
    from tensegym.flexure.models.rod_pin import rod_pin

    limit = split_buckling_load(flexure, length)
    if compression >= limit:
        raise DesignError(
            f"RodFlexure: the prestress compresses rod {rod} by {compression:.4g} N, over the "
            f"{limit:.4g} N at which its {flexure.hinge} buckles; thicken the hinge (thickness = "
            f"{flexure.thickness:g} m) or lower ElasticCable.pretension"
        )
    half = half_length(flexure, length)
    # rounded, so that equal rods share one fit; a rod that two-way cables stretch is fitted without load
    pin = rod_pin(flexure.geometry(), half, half, flexure.max_angle, max(0.0, round(compression, 6)))
    ratio = pin.buckling_ratio
    if not 1 / PIN_TOLERANCE <= ratio <= PIN_TOLERANCE:
        raise DesignError(
            f"RodFlexure: no pin stands for a {flexure.hinge} of length = {flexure.length:g} m: "
            f"with one the rod would buckle at {ratio:.3g} times its load, outside [{1 / PIN_TOLERANCE:g}, "
            f"{PIN_TOLERANCE:g}]; take a shorter hinge, or one that turns rather than shifts"
        )
    return pin
