"""Nodes and connectivity as CSV: every layout that the tools have, back and forth, and what is refused."""

import numpy as np
import pytest

from tensegym.design.design_file import design_from_dict
from tensegym.errors import InputError
from tensegym.exchange import matrix_files, read_matrices
from tensegym.structures import Prism


@pytest.fixture
def files(tmp_path):
    """A prism's matrices, as they are written."""
    plan = Prism(3).build()
    design = design_from_dict({"structure": {"builder": "prism"}})
    for name, text in matrix_files(design, "mm").items():
        (tmp_path / name).write_text(text)
    return plan, tmp_path


def read(folder, units="mm", base=None):
    table, _ = read_matrices(folder / "nodes.csv", folder / "rods.csv", folder / "cables.csv", units, base)
    return {name: np.array(value) for name, value in table["structure"].items()}


def save(path, rows):
    path.write_text("\n".join(",".join(map(str, row)) for row in np.asarray(rows).tolist()))


def assert_same(found, plan):
    np.testing.assert_allclose(found["nodes"], plan.nodes, atol=1e-9)
    np.testing.assert_array_equal(found["rods"] - 1, plan.rods)
    np.testing.assert_array_equal(found["cables"] - 1, plan.all_cables)


def test_what_is_written_comes_back(files):
    plan, folder = files
    assert_same(read(folder), plan)
    assert np.loadtxt(folder / "nodes.csv", delimiter=",").shape == (3, 6)
    assert np.loadtxt(folder / "nodes.csv", delimiter=",")[2, 3] == pytest.approx(350)


def test_rods_that_share_nodes_come_back_as_they_stand(tmp_path):
    """Matrices hold no tensions: equal ones would not balance a spine, those of its closed form do."""
    design = design_from_dict({"structure": {"builder": "spine", "vertebrae": 3}})
    for name, text in matrix_files(design, "cm").items():
        (tmp_path / name).write_text(text)
    table, notes = read_matrices(tmp_path / "nodes.csv", tmp_path / "rods.csv", tmp_path / "cables.csv", "cm")
    assert "share nodes" in notes[-1]
    back = design_from_dict(table)
    np.testing.assert_allclose(back.standing.nodes, design.standing.nodes, atol=1e-9)
    np.testing.assert_array_equal(back.structure.rods, design.structure.rods)
    np.testing.assert_array_equal(back.structure.cables, design.structure.cables)
    ratio = back.rest_tensions / design.rest_tensions
    np.testing.assert_allclose(ratio, ratio[0], rtol=1e-9)


@pytest.mark.parametrize("base", [0, 1])
@pytest.mark.parametrize("turned", [False, True])
def test_members_as_pairs_of_numbers(files, base, turned):
    plan, folder = files
    for name, pairs in (("rods", plan.rods + base), ("cables", plan.all_cables + base)):
        save(folder / f"{name}.csv", pairs.T if turned else pairs)
    save(folder / "nodes.csv", plan.nodes * 1000 if turned else plan.nodes.T * 1000)
    assert_same(read(folder, base=base), plan)


@pytest.mark.parametrize("between", [";", "\t", "  "])
def test_columns_between_other_marks(files, between):
    plan, folder = files
    for path in folder.iterdir():
        path.write_text(path.read_text().replace(",", between))
    assert_same(read(folder), plan)


@pytest.mark.parametrize(("name", "text", "base", "reason"), [
    ("rods", "1,5\n2,6\n3,4\n", None, "say whether they count from 0 or 1"),
    ("rods", "1,5\n2,6\n3,4\n", 0, "name nodes 1 to 6; counted from 0 there are 0 to 5"),
    ("rods", "0,4\n1,5\n2,3\n", 1, "name nodes 0 to 5; counted from 1 there are 1 to 6"),
    ("rods", "1.5,5\n2,6\n3,4\n", 1, "not whole"),
    ("rods", "1,-1,1,0,0,0\n", None, "row 1: a member has one -1 and one 1"),
    ("rods", "1,2,3\n4,5,6\n7,8,9\n", 1, "3 x 3 is neither"),
    ("nodes", "1,2\n3,4\n", None, "2 x 2; give 3 rows or 3 columns"),
    ("nodes", "x,y,z\n1,2,3\n", None, "row 1: 'x' is not a number"),
    ("nodes", "1,2,3\n4,5\n", None, "rows of 2 to 3 numbers"),
    ("nodes", "1,2,nan\n4,5,6\n", None, "is not a number"),
    ("nodes", "", None, "holds nothing"),
    ("nodes", "1,,3\n1,2,3\n", None, "empty cell"),
])  # fmt: skip
def test_what_is_no_matrix_is_refused(files, name, text, base, reason):
    folder = files[1]
    (folder / f"{name}.csv").write_text(text)
    with pytest.raises(InputError, match=reason):
        read(folder, base=base)


def test_units_are_asked_for(files):
    with pytest.raises(InputError, match="give units"):
        read(files[1], units=None)
