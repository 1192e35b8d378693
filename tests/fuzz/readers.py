"""Every reader of a file a user can write, with valid files to start from."""

import io
import json
import tomllib
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import tomli_w
import yaml
from hypothesis import strategies as st

from tests.fuzz import folders, mutants

ROOT = Path(__file__).parents[2]
PRISM = """
name = "prism"
[structure]
nodes = [[0.3, 0, 0], [-0.15, 0.26, 0], [-0.15, -0.26, 0], [-0.26, 0.15, 0.5], [0, -0.3, 0.5], [0.26, 0.15, 0.5]]
rods = [[1, 4], [2, 5], [3, 6]]
cables = [[1, 2], [2, 3], [3, 1], [4, 5], [5, 6], [6, 4], [1, 6], [2, 4], [3, 5]]
stiff_cables = [[1, 5], [2, 6]]
"""


class Reader(NamedTuple):
    """What reads a kind of file."""

    name: str
    file: str
    """Name of the damaged file."""
    read: Callable[[Path], Any]
    sources: Callable[[], list[bytes]]
    """Valid files."""
    load: Callable[[bytes], Any] | None = None
    """A file as a tree, where it is one."""
    dump: Callable[[Any], bytes] | None = None
    neighbours: tuple[Path, ...] = ()
    """Files that a read file points at; they are copied beside it."""
    beside: Callable[[], dict[str, bytes]] | None = None
    """Other files of its folder, by name."""

    def inputs(self) -> st.SearchStrategy[bytes]:
        """Damaged files."""
        sources = self.sources()
        found = mutants.texts(sources)
        if self.load is None or self.dump is None:
            return found
        whole = [self.load(source) for source in sources]
        return found | mutants.trees(whole).map(self.dump)


def to_toml(tree: Any) -> bytes:
    try:
        return tomli_w.dumps(_without_none(tree)).encode()
    except (TypeError, ValueError, AttributeError, RecursionError):  # no TOML says this
        return _written(tree)


def _without_none(tree: Any) -> Any:
    if isinstance(tree, dict):
        return {str(key): _without_none(value) for key, value in tree.items()}
    if isinstance(tree, list):
        return [_without_none(value) for value in tree]
    return "none" if tree is None else tree


def from_toml(text: bytes) -> Any:
    return tomllib.loads(text.decode())


def to_json(tree: Any) -> bytes:
    try:
        return json.dumps(tree, default=str).encode()
    except (ValueError, RecursionError):
        return _written(tree)


def to_yaml(tree: Any) -> bytes:
    try:
        return yaml.safe_dump(tree).encode()
    except (yaml.YAMLError, ValueError, RecursionError):
        return _written(tree)


def _written(tree: Any) -> bytes:
    """As Python writes it, which no file of these kinds is."""
    try:
        return repr(tree).encode()
    except (ValueError, RecursionError):  # too many digits, too deep
        return b"[" * 5000


def _files(*patterns: str) -> list[bytes]:
    return [path.read_bytes() for pattern in patterns for path in sorted(ROOT.glob(pattern))]


# -- one function a kind, so that a reader is imported when it is used ------------------------------------------------


def _design(path: Path) -> Any:
    from tensegym.design.design_file import load_design

    return load_design(path)


def _designs() -> list[bytes]:
    from tensegym.design.design_file import as_design, design_to_dict

    whole = [tomli_w.dumps(design_to_dict(as_design(name))).encode() for name in ("six_rod", "paper")]
    small = b'preset = "six_rod"\n[elastic_cable]\nstiffness = 400.0\n[payload]\nmass = 0.5\n[drive]\ngear_ratio = 9\n'
    split = b'preset = "six_rod_flexible"\n[flexure]\nhinge = "x-hinge"\nthickness = 6e-4\nrods = "active"\n'
    return [*whole, small, small, small, split, PRISM.encode(), b"[structure]\nrod_length = 0.8\nspacing = 0.4\n"]


def _task(path: Path) -> Any:
    from tensegym.search.problem import load_problem

    return load_problem(str(path))


def _config(path: Path) -> Any:
    from tensegym.train.config import load_config

    return load_config(str(path))


def _hinge(path: Path) -> Any:
    from tensegym.flexure.hinge import as_hinge

    return as_hinge(path)


def _hinges() -> list[bytes]:
    from tensegym.flexure.hinge import PRESETS, preset
    from tensegym.flexure.hinge.hinge_file import hinge_to_toml

    return [hinge_to_toml(preset(name)).encode() for name in PRESETS]


def _flexures(path: Path) -> Any:
    from tensegym.flexible.flexure_file import load_robot

    with load_robot(path):
        return None


def _urdf(path: Path) -> Any:
    from tensegym.flexible import FlexibleRobot

    with FlexibleRobot(path, fixed_base=True):
        return None


def _joint(path: Path) -> Any:
    from tensegym.flexure import load_joint

    return load_joint(path)


@lru_cache(maxsize=1)
def _joints() -> list[bytes]:
    from tensegym.flexure import fit_joint, preset
    from tensegym.flexure.models.joint_file import joint_to_dict

    found = [joint_to_dict(fit_joint(preset(name), held_out=0, count=120)) for name in ("leaf-spring", "x-hinge")]
    return [json.dumps(joint).encode() for joint in found]


def _tips(path: Path) -> Any:
    from tensegym.control.walker import load_table

    return load_table(path)


def _few_tips() -> list[bytes]:
    rows = json.loads((ROOT / "train/policies/walker/tips.json").read_text())
    return [json.dumps(rows[:5] if isinstance(rows, list) else rows | {"tips": rows["tips"][:5]}).encode()]


def _commands(path: Path) -> Any:
    from tensegym.control.commands_file import read_commands

    return read_commands(path, 6)


def _command_rows() -> list[bytes]:
    header = "time_s," + ",".join(f"drive_{d}_rad" for d in range(1, 7))
    rows = [",".join(map(str, [round(0.1 * n, 3), *[1.5 * n] * 6])) for n in range(6)]
    return ["\n".join([header, *rows]).encode(), "\r\n".join([header, *rows, ""]).encode()]


def _measured(path: Path) -> Any:
    from tensegym.flexure.measured import fit_measured, read_measured

    return fit_measured(read_measured(path), 0.04, "planar")


def _measured_rows() -> list[bytes]:
    rows = [(a, 40 - 0.002 * a * a, 0.5 * a, 0.02 * a) for a in np.linspace(-25, 25, 11).tolist()]
    by_force = "angle_deg,x_mm,y_mm,force_N\n" + "\n".join(",".join(f"{v:.5g}" for v in row) for row in rows)
    by_torque = "angle_deg,x_mm,y_mm,torque_Nmm\n" + "\n".join(",".join(f"{v:.5g}" for v in row) for row in rows)
    return [by_force.encode(), by_torque.encode()]


def _loads(path: Path) -> Any:
    from tensegym.cli.flexure.solve import read_loads

    return read_loads(path)


def _picture(path: Path) -> Any:
    from tensegym.flexure.measured.photo import read_grey
    from tensegym.flexure.measured.sighting import sight

    return sight(read_grey(path))


def _pictures() -> list[bytes]:
    from PIL import Image

    grey = np.full((120, 160), 220, np.uint8)
    grey[50:60, 60:150] = 20
    grey[52:58, 20:28] = 20
    found = []
    for kind in ("PNG", "BMP", "GIF"):
        file = io.BytesIO()
        Image.fromarray(grey).save(file, kind)
        found.append(file.getvalue())
    return found


def _ntrt(path: Path) -> Any:
    from tensegym.exchange import read_ntrt

    return read_ntrt(path, "dm", 10.0)


def _nodes(path: Path) -> Any:
    from tensegym.exchange import read_matrices

    return read_matrices(path, path.with_name("rods.csv"), path.with_name("cables.csv"), "mm", 1)


def _members(path: Path) -> Any:
    from tensegym.exchange import read_matrices

    return read_matrices(path.with_name("nodes.csv"), path, path.with_name("cables.csv"), "mm", 1)


@lru_cache(maxsize=1)
def _matrices() -> dict[str, bytes]:
    from tensegym.design.design_file import as_design
    from tensegym.exchange import matrix_files

    return {name: text.encode() for name, text in matrix_files(as_design("six_rod")).items()}


def _controller(path: Path) -> Any:
    from tensegym.control.table import make_controller, with_defaults
    from tensegym.errors import InputError
    from tensegym.tables import read_toml

    table = read_toml(path, "controller", InputError)
    with_defaults(table)
    return make_controller(table)


def _controllers() -> list[bytes]:
    cpg = {"version": 1, "gain": 1.5, "lags": [0.1, -0.2], "amplitudes": [0.5, 0.4], "frequency": 0.7}
    walker = {"kind": "walker", "tips": "own", "depth": 0.9, "period": 0.2}
    policies = [{"kind": "policy", "policy": "onboard", "period": 0.3}, {"policy": "onboard", "gain": 1.0}]
    return [tomli_w.dumps(table).encode() for table in (cpg, walker, *policies, {"kind": "random", "period": 0.4})]


READERS = {
    reader.name: reader
    for reader in (
        Reader("design", "input.toml", _design, _designs, from_toml, to_toml),
        Reader("task", "input.toml", _task, lambda: _files("tensegym/search/tasks/*.toml"), from_toml, to_toml),
        Reader("training", "input.yaml", _config, lambda: _files("train/configs/*.yaml"), yaml.safe_load, to_yaml),
        Reader("hinge", "input.toml", _hinge, _hinges, from_toml, to_toml),
        Reader("flexures", "input.toml", _flexures, lambda: _files("urdf/flexure_*.toml"), from_toml, to_toml,
               tuple(sorted((ROOT / "urdf").glob("flexure_*.urdf")))),
        Reader("urdf", "input.urdf", _urdf, lambda: _files("urdf/*.urdf")),
        Reader("joint", "input.json", _joint, _joints, json.loads, to_json),
        Reader("tips", "input.json", _tips, _few_tips, json.loads, to_json),
        Reader("commands", "input.csv", _commands, _command_rows),
        Reader("measured", "input.csv", _measured, _measured_rows),
        Reader("loads", "input.csv", _loads, lambda: [b"Fx_N,Fy_N,Mz_Nmm\n0,0.5,10\n-0.5,0.2,-20\n0,0,0\n"]),
        Reader("ntrt", "input.yaml", _ntrt, lambda: _files("tests/exchange/cases/*.yaml"), yaml.safe_load, to_yaml,
               tuple(sorted((ROOT / "tests/exchange/cases").glob("*.yaml")))),
        Reader("nodes", "nodes.csv", _nodes, lambda: [_matrices()["nodes.csv"]], beside=_matrices),
        Reader("members", "rods.csv", _members, lambda: [_matrices()["rods.csv"], b"1;2\n3;4\n5;6\n7;8\n9;10\n11;12\n"],
               beside=_matrices),
        Reader("picture", "input.png", _picture, _pictures),
        Reader("controller", "input.toml", _controller, _controllers, from_toml, to_toml),
        Reader("policy", "policy.json", folders.read_policy_folder, lambda: [folders.policy()["policy.json"]],
               json.loads, to_json, beside=folders.policy),
        Reader("weights", "weights.npz", folders.read_policy_folder, lambda: [folders.policy()["weights.npz"]],
               folders.from_npz, folders.to_npz, beside=folders.policy),
        Reader("trained in", "config.yaml", folders.read_policy_folder,
               lambda: [folders.policy()["config.yaml"], *_files("train/policies/*/config.yaml")],
               yaml.safe_load, to_yaml, beside=folders.policy),
        Reader("state", "state.json", folders.resume, lambda: [folders.training()["state.json"]], json.loads, to_json),
        Reader("moments", "optimiser.npz", folders.resume, lambda: [folders.training()["optimiser.npz"]],
               folders.from_npz, folders.to_npz),
        Reader("curve", "curve.csv", folders.resume, lambda: [folders.CURVE.encode()]),
        Reader("study", "study.db", folders.read_study, lambda: [folders.study()],
               folders.from_sqlite, folders.to_sqlite),
        Reader("storage", "storage.txt", folders.read_storage,
               lambda: [b"", b"sqlite:///study.db", b"postgresql://a:***@b/c"]),
    )
}  # fmt: skip
