"""What structures become: builders of `tensegym.structures` and files, each with its verdict, as tables; a gallery.

    python benchmarks/structures.py                            # the builders: a table, docs/structures.png
    python benchmarks/structures.py --files DIR/*.toml         # files: design files, NTRT's YAML (--units)
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from tensegym.design.design import RobotDesign
from tensegym.design.design_file import design_from_dict, load_design
from tensegym.errors import TensegymError
from tensegym.exchange import read_ntrt
from tensegym.plotting import new_figure, save
from tensegym.robot.picture import picture
from tensegym.robot.settling import robot_for
from tensegym.robot.sight import sight_of
from tensegym.robot.standing import standing_verdict
from tensegym.structure.faces import hull_faces

STRONG = {"elastic_cable": {"pretension": 25.0, "stiffness": 600.0}}  # for many rods on short cables
STRONGER = {"elastic_cable": {"pretension": 80.0, "stiffness": 2000.0}}
SHOWN: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "three-rod prism": ({"builder": "prism"}, {}),
    "four-rod prism, 0.9 m": ({"builder": "prism", "rods": 4, "height": 0.9}, {}),
    "six-rod prism, 0.6 m": ({"builder": "prism", "rods": 6, "height": 0.6}, {}),
    "octahedron": ({"builder": "octahedron"}, {}),
    "tower of 2 x 4 rods": ({"builder": "tower", "rods": 4}, {}),
    "tower of 2 x 5 rods": ({"builder": "tower", "rods": 5}, {}),
    "truncated tetrahedron": ({"builder": "truncated"}, {}),
    "truncated cube": ({"builder": "truncated", "solid": "cube"}, STRONG),
    "truncated octahedron": ({"builder": "truncated", "solid": "octahedron"}, STRONG),
    "truncated dodecahedron": ({"builder": "truncated", "solid": "dodecahedron"}, STRONGER),
    "truncated icosahedron": ({"builder": "truncated", "solid": "icosahedron"}, STRONGER),
    "three-rod robot": ({"builder": "three_rod_robot"}, {}),
    "stack of 3 prisms": ({"builder": "stack"}, {}),
    "tetrahedral spine": ({"builder": "spine"}, {}),
}


def facts(design: RobotDesign) -> list[str]:
    """Rods, cables, height on its first resting face, how far form finding moved it, and the verdict."""
    structure, verdict = design.standing, standing_verdict(design)
    faces = hull_faces(structure)
    heights = [np.ptp(structure.nodes @ normal) for normal in faces.normals]
    sag = max((face.sag for face in verdict.faces), default=0.0)
    says = verdict.text.split("\n")[0]
    return [f"{len(structure.rods)}", f"{len(structure.cables)}", f"{design.length:.4g}", f"{max(heights):.4g}",
            f"{design.shape.moved:.3g}",
            f"stands ({1e3 * sag:.2g} mm)" if verdict.kind == "stands" else says]  # fmt: skip


def row(name: str, make: Any) -> tuple[str, RobotDesign | None]:
    """A line of the table, and the design."""
    try:
        design = make()
        return " | ".join([name, *facts(design)]), design
    except (TensegymError, OSError) as error:
        return f"{name} | | | | | | refused: {error}", None


def read(path: Path, units: str) -> RobotDesign:
    """A design file, or an NTRT model."""
    return load_design(path) if path.suffix == ".toml" else design_from_dict(read_ntrt(path, units, 10.0).table)


def gallery(designs: dict[str, RobotDesign], path: Path) -> None:
    """Every robot after it has settled on a face."""
    columns = 4
    figure, axes = new_figure(-(-len(designs) // columns), columns, size=(12, 2.6 * -(-len(designs) // columns)))
    for axis in np.ravel(axes):
        axis.axis("off")
    for axis, (name, design) in zip(np.ravel(axes), designs.items(), strict=False):
        with robot_for(design) as robot:
            robot.step(round(2.0 / robot.dt))
            sight, extent = sight_of(robot), float(np.ptp(robot.node_positions_in_world(), axis=0).max())
            axis.imshow(picture(sight._replace(length=max(sight.length, 0.85 * extent)), 480, 360))
        axis.set_title(name, fontsize=10)
    save(figure, path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--files", nargs="*", type=Path, help="files in place of the builders")
    parser.add_argument("--units", default="dm", help="of NTRT's models")
    parser.add_argument("--out", type=Path, default=Path("docs/structures.png"))
    given = parser.parse_args()
    print("| structure | rods | cables | rod length, m | tallest face to node, m | moved, m | under its weight |")
    print("|---|---|---|---|---|---|---|")
    made = {}
    if given.files:
        for path in given.files:
            print(f"| {row(path.name, lambda path=path: read(path, given.units))[0]} |", flush=True)
        return
    for name, (structure, rest) in SHOWN.items():
        line, design = row(name, lambda s=structure, r=rest: design_from_dict({"structure": s, **r}))
        print(f"| {line} |", flush=True)
        if design is not None:
            made[name] = design
    gallery(made, given.out)


if __name__ == "__main__":
    main()
