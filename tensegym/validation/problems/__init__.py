"""The problems of the validation page, in its order; one topic a file."""

from tensegym.validation.problem import BOTH, NONE, PYBULLET, Problem

from . import (
    beams,
    closed_forms,
    energy_audit,
    flight_order,
    friction,
    loops,
    pendulum,
    rolling,
    rolling_ball,
    shared_nodes,
    side_by_side,
    torque_free,
)

__all__ = ["PROBLEMS"]

_TRUSTED, _CONTACT, _STEP = "Problems that other people trust", "Contact and friction", "The time step"

_SIDES = "Both engines, side by side"

PROBLEMS: dict[str, Problem] = {
    "closed_forms": Problem("Closed forms", "The closed forms of `tensegym validate`", "derived, see there",
                            closed_forms.closed_forms, minutes=0.5),
    "kane": Problem(_TRUSTED, "Torque-free body that is symmetric about its axis",
                    "Kane, Likins and Levinson, Spacecraft Dynamics 3.1; Drake's benchmark free_body",
                    torque_free.kane),
    "boxes": Problem(_TRUSTED, "Spinning boxes", "Peters' physics benchmark", torque_free.boxes),
    "bowling": Problem(_TRUSTED, "Bowling ball, from sliding to rolling", "Drake's benchmark bowling_ball",
                       rolling_ball.bowling),
    "pushed": Problem(_TRUSTED, "Box pushed under 25 balls", "SimBenchmark (ETH Zurich), rolling test",
                      rolling_ball.pushed_box),
    "pendulum": Problem(_TRUSTED, "IFToMM A01: simple pendulum", "IFToMM library of computational benchmarks",
                        pendulum.pendulum, PYBULLET, 0.5),
    "four_bars": Problem(_TRUSTED, "IFToMM A02: two four-bars", "IFToMM library of computational benchmarks",
                         loops.four_bars, PYBULLET, 0.3),
    "bricard": Problem(_TRUSTED, "IFToMM A04: Bricard's mechanism", "IFToMM library of computational benchmarks",
                       loops.bricard, PYBULLET, 0.3),
    "elastica": Problem(_TRUSTED, "Elastica", "elliptic integrals; Mattiasson 1981", beams.elastica, NONE),
    "princeton": Problem(_TRUSTED, "Princeton beam, linear tips", "beam theory; Dowell and Traybar 1975",
                         beams.princeton, NONE),
    "wittrick": Problem(_TRUSTED, "Cross spring", "Wittrick 1951; Haringx 1949", beams.wittrick, NONE),
    "joints": Problem("Rods that share a node", "Ball joints", "conservation laws; Lagrange's equations; statics",
                      shared_nodes.shared_nodes, minutes=0.2),
    "stopping": Problem(_CONTACT, "Stopping distance of a rod", "v^2 / (2 mu g)", friction.stopping),
    "slope": Problem(_CONTACT, "Slope at which rod and robot let go", "atan(mu); statics", friction.slope),
    "creep": Problem(_CONTACT, "Creep at rest", "Coulomb: what is at rest stays", friction.creep, minutes=0.3),
    "contacts": Problem(_CONTACT, "Complementarity while rolling", "Signorini and Coulomb", rolling.contacts,
                        minutes=0.3),
    "flight": Problem(_STEP, "Order in free flight", "order of the scheme", flight_order.flight_order, minutes=0.2),
    "steps": Problem(_STEP, "Speed of rolling at four time steps", "the same at 1 ms", rolling.time_steps, minutes=3),
    "parting": Problem(_STEP, "How fast two ways part", "sensitive dependence", rolling.parting, minutes=0.3),
    "sides": Problem(_SIDES, "At rest and in flight", "the other engine", side_by_side.at_rest_and_in_flight, NONE,
                     needs=BOTH),
    "faces": Problem(_SIDES, "End faces of the table of tips", "the other engine", side_by_side.end_faces, NONE, 4,
                     needs=BOTH),
    "audit": Problem("Energy", "Energy audit of random commands", "first law", energy_audit.energy_audit, minutes=5),
}  # fmt: skip
