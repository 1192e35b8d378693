"""The gallery's examples assert their numbers; here they are held to them."""

import runpy
from pathlib import Path

import matplotlib
import pytest

EXAMPLES = sorted((Path(__file__).parents[1] / "docs" / "examples").glob("plot_*.py"))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_holds(path, capsys):
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    assert "assert" in path.read_text()
    runpy.run_path(str(path))
    assert capsys.readouterr().out.strip()
    assert plt.get_fignums()
    plt.close("all")
