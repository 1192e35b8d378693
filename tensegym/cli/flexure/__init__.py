"""The commands of `tensegym flexure`, one module each."""

COMMANDS: dict[str, tuple[str, str]] = {
    "table": ("tensegym.cli.flexure.table:Table", "the paper's Tables 1 and 2 beside ours; held-out errors"),
    "curves": ("tensegym.cli.flexure.curves:Curves", "torque against angle, drift, stiffness diagrams: PNG, CSV"),
    "fit": ("tensegym.cli.flexure.fit:Fit", "fit a joint model to a hinge or to measured data"),
    "travel": ("tensegym.cli.flexure.travel:Travel", "stiffness, stress and buckling along a hinge's travel"),
    "guide": ("tensegym.cli.flexure.guide:Guide", "a parallelogram by FEM, beam constraint model, pseudo-rigid body"),
    "track": ("tensegym.cli.flexure.track:Track", "pictures of a stand in, angle and position out, as CSV"),
    "stand": ("tensegym.cli.flexure.stand:Stand", "the paper's test stand in PyBullet: pull, track, fit, let go"),
    "view": ("tensegym.cli.flexure.view:View", "a hinge bends under sliders, in the browser: FEM beside the models"),
    "solve": ("tensegym.cli.flexure.solve:Solve", "loads in, poses out, by any of the models"),
}
