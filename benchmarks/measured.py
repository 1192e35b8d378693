"""How well measured data become a joint: fits to noisy states, and poses seen in pictures of a stand.

    python benchmarks/measured.py
    python benchmarks/measured.py --seeds 2 --poses 3   # sooner, and milder: fewer to take the worst of

Prints two tables. First the clean held-out error of the potential that ``fit_noisy`` fits to 60, 150 and 600 FEM states
of each of the paper's hinges, with noise of 0.05 mm on x and on y and 0.5 % of the 30-deg moment on the torque: RMS
over 300 random wrenches, torque in % of the 30-deg moment, each the worst of all noise seeds. Then the largest errors
of angle and of tip (in % of the arm's length) of ``sight``, which `tensegym flexure track` runs on every picture, over
random poses drawn by tests/flexure/measured/stand_pictures.py at four sizes under four conditions, the same poses in
every cell.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "flexure" / "measured"))

from stand_pictures import ARM_MM, Picture

from tensegym.flexure.fem.sampling import default_box, fit_states, held_out_states, moment_at
from tensegym.flexure.hinge import PAPER_HINGES, Hinge, States, preset
from tensegym.flexure.measured.noisy_fit import fit_noisy
from tensegym.flexure.measured.sighting import sight
from tensegym.flexure.models.model_error import model_errors
from tensegym.report import table

COUNTS = (60, 150, 600)
HELD_OUT = 300
TIP_NOISE, TORQUE_NOISE = 50e-6, 0.005  # m a coordinate; of the 30-deg moment
SCALES = (0.5, 1.0, 2.0, 3.75)  # of 320 x 240 px with an arm of 160 px
CONDITIONS = {
    "clean": Picture(),
    "soft, uneven": Picture(blur=0.7, noise=4.0, uneven=0.4),
    "softer, very uneven": Picture(blur=1.5, noise=8.0, uneven=0.7),
    "rounded ends, soft": Picture(round_ends=True, blur=1.0, noise=4.0),
}
LARGEST_TURN, LARGEST_SHIFT = 38.0, 4.0  # deg; px of the 320 x 240 picture


def noisy(states: States, moment: float, seed: int) -> States:
    """``states`` as a stand would measure them; moment: the 30-deg moment [N m]."""
    rng = np.random.default_rng(seed)
    tip = states.tip + rng.normal(0.0, TIP_NOISE, states.tip.shape)
    torque = states.moment + rng.normal(0.0, TORQUE_NOISE * moment, len(states))
    return States(states.theta, tip, states.force, torque)


def noise_column(hinge: Hinge, seeds: int) -> list[str]:
    """One hinge's worst errors, count by count."""
    box, moment = default_box(hinge), moment_at(hinge, np.radians(30.0))
    held_out = held_out_states(hinge, box, HELD_OUT)
    column = []
    for count in COUNTS:
        clean = fit_states(hinge, box, count)
        fits = [fit_noisy(noisy(clean, moment, seed), hinge.length, box=box) for seed in range(seeds)]
        errors = [model_errors(fit.potential, held_out, moment) for fit in fits]
        tip, torque = max(e.tip_rms for e in errors), max(e.moment_rms for e in errors)
        column.append(f"{1e6 * tip:.1f} um, {100 * torque:.3f} %")
    return column


def picture_cell(condition: Picture, scale: float, poses: int) -> str:
    """Largest errors of angle and tip in one condition at one size."""
    rng = np.random.default_rng(0)
    turns, places = [], []
    for seed in range(poses):
        angle = rng.uniform(-LARGEST_TURN, LARGEST_TURN)
        across, down = np.array(condition.tip) + rng.uniform(-LARGEST_SHIFT, LARGEST_SHIFT, 2)
        scene = replace(condition, angle_deg=angle, tip=(across, down)).scaled(scale)  # blur and noise are not scaled
        picture = replace(scene, seed=seed)
        seen = sight(picture.drawn())
        turns.append(abs(np.degrees(seen.angle) - angle))
        miss_mm = 1e3 * seen.from_marker(1e-3 * ARM_MM) - picture.tip_from_marker_mm()
        places.append(np.linalg.norm(miss_mm) / ARM_MM)
    return f"{max(turns):.3f} deg, {100 * max(places):.2f} %"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=6, help="noise seeds of every fit (default: 6)")
    parser.add_argument("--poses", type=int, default=12, help="poses of every size and condition (default: 12)")
    args = parser.parse_args()
    if min(args.seeds, args.poses) < 1:
        parser.error("--seeds and --poses: give 1 or more")

    columns = [noise_column(preset(name), args.seeds) for name in PAPER_HINGES]
    print(f"clean held-out error of the potential from noisy states, the worst of {args.seeds} noise seeds")
    rows = [[str(count), *cells] for count, *cells in zip(COUNTS, *columns, strict=True)]
    print(table(["states", *PAPER_HINGES], rows))

    print(f"\nlargest errors of angle and tip in pictures of a stand, {args.poses} random poses each")
    for name, look in CONDITIONS.items():
        print(f"  {name}: blur {look.blur:g} px, noise {look.noise:g} of 255, corner {100 * look.uneven:.0f} % darker")
    rows = []
    for scale in SCALES:
        size = Picture().scaled(scale)
        cells = [picture_cell(look, scale, args.poses) for look in CONDITIONS.values()]
        rows.append([f"{size.columns} x {size.rows}", f"{size.length:.0f}", *cells])
    print(table(["picture px", "arm px", *CONDITIONS], rows))


if __name__ == "__main__":
    main()
