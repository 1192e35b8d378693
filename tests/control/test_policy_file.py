"""A policy's files: the same bits back, and what does not fit is refused in one line."""

import io
import json
import shutil
import zipfile

import numpy as np
import pytest

from tensegym.control.policy import load_policy, shipped, shipped_names
from tensegym.control.policy_file import read_arrays, read_policy, write_policy
from tensegym.errors import InputError


@pytest.mark.parametrize("name", shipped_names())
def test_a_policy_is_written_and_read_back_to_the_bit(name, tmp_path):
    saved = read_policy(shipped(name))
    write_policy(saved, tmp_path)
    again = read_policy(tmp_path)
    assert saved.weights.keys() == again.weights.keys()
    for one, other in ((saved.weights, again.weights), (vars(saved.observations), vars(again.observations)),
                       (vars(saved.returns), vars(again.returns))):  # fmt: skip
        for key in one:
            np.testing.assert_array_equal(one[key], other[key], strict=isinstance(one[key], np.ndarray))
    assert (saved.clip, saved.epsilon) == (again.clip, again.epsilon)


def test_actions_are_those_of_stable_baselines3():
    torch = pytest.importorskip("torch")
    pytest.importorskip("stable_baselines3")
    from gymnasium.spaces import Box

    from tensegym.train.symmetric_policy import SymmetricPolicy

    policy, saved = load_policy("onboard"), read_policy(shipped("onboard"))
    index, sign, back = (saved.weights[f"mlp_extractor.{part}"].tolist() for part in ("index", "sign", "back"))
    own = SymmetricPolicy(Box(*saved.observation_bounds), Box(*saved.action_bounds), lambda _: 0.0,
                          hidden=saved.hidden, observation_index=index, observation_sign=sign,
                          action_index=back)  # fmt: skip
    own.load_state_dict({name: torch.from_numpy(value) for name, value in saved.weights.items()})
    rng = np.random.default_rng(0)
    for scale in (0.1, 1.0, 30.0):
        seen = (scale * rng.normal(size=policy.observed)).astype(np.float32)
        wanted, _ = own.predict(saved.normalised(seen)[None], deterministic=True)
        np.testing.assert_array_equal(policy(seen), wanted[0], strict=True)


def changed(array):
    return array[..., :-1]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda w, s: w.update({"log_std": changed(w["log_std"])}), "log_std has the shape"),
        (lambda w, s: w.pop("mlp_extractor.index"), "mlp_extractor.index"),
        (lambda w, s: w["mlp_extractor.index"].fill(10_000), "index is outside"),
        (lambda w, s: w["mlp_extractor.actor.0.weight"].fill(np.nan), "not of finite numbers"),
        (lambda w, s: w.pop("mlp_extractor.actor.4.weight"), "actor does not give"),
        (lambda w, s: w.update({"mlp_extractor.actor.4.bias": np.float32(1)}), "TypeError"),
        (lambda w, s: s.pop("clip"), "clip"),
        (lambda w, s: s.update(clip=-1.0), "clip"),
        (lambda w, s: s["observations"].update(mean=[1.0]), "observations.mean has the shape"),
        (lambda w, s: s.update(observation_bounds=[[1.0], [2.0, 3.0]]), "observation_bounds row 2 .* has 2 entries"),
        (lambda w, s: s.update(observation_bounds="wide"), "observation_bounds must be a row of lowest and one of"),
        (lambda w, s: s["action_bounds"][0].__setitem__(2, 1e300), "action_bounds is not finite"),
        (lambda w, s: s["returns"].update(mean=["0"]), r"returns.mean\[1\] = '0' is a text"),
        (lambda w, s: s["returns"].update(count=-1.0), "a count not below"),
        (lambda w, s: s["observations"].pop("count"), "observations.count is missing"),
        (lambda w, s: s.update(observations="../../elsewhere.json"), "observations = .* must be a table"),
        (lambda w, s: s.update(more=1), "unknown field 'more'"),
        (lambda w, s: s.update(version=2), "is of version 2"),
    ],
)
def test_files_that_do_not_fit_are_refused(change, words, tmp_path):
    folder = tmp_path / "policy"
    shutil.copytree(shipped("onboard"), folder)
    weights, settings = read_arrays(folder / "weights.npz"), json.loads((folder / "policy.json").read_text())
    change(weights, settings)
    np.savez(folder / "weights.npz", **weights)
    (folder / "policy.json").write_text(json.dumps(settings))
    with pytest.raises(InputError, match=words):
        read_policy(folder)


@pytest.mark.parametrize("keep", [0, 1, 100, 5000, -1])
def test_weights_cut_short_are_refused(keep, tmp_path):
    path = tmp_path / "weights.npz"
    path.write_bytes((shipped("onboard") / "weights.npz").read_bytes()[:keep])
    with pytest.raises(InputError, match="holds no arrays of numbers"):
        read_arrays(path)


def test_numbers_of_other_widths_are_read_as_networks_take_them(tmp_path):
    folder = tmp_path / "policy"
    shutil.copytree(shipped("onboard"), folder)
    kinds = {"f": np.float64, "i": np.int16}
    wide = {name: array.astype(kinds[array.dtype.kind]) for name, array in read_policy(folder).weights.items()}
    np.savez(folder / "weights.npz", **wide)
    seen = np.linspace(-1, 1, load_policy("onboard").observed, dtype=np.float32)
    np.testing.assert_array_equal(load_policy(folder)(seen), load_policy("onboard")(seen), strict=True)


def test_an_array_whose_head_says_more_than_is_there_is_refused(tmp_path):
    """A kilobyte that would unpack to a terabyte."""
    path = tmp_path / "weights.npz"
    head = io.BytesIO()
    np.lib.format.write_array_header_1_0(head, {"descr": "<f4", "fortran_order": False, "shape": (1 << 38,)})
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("log_std.npy", head.getvalue() + b"0" * 1000)
    with pytest.raises(InputError, match="holds no arrays of numbers"):
        read_arrays(path)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("log_std.npy", bytes(300 << 20))
    assert path.stat().st_size < 1 << 20
    with pytest.raises(InputError, match="more than 256 MB"):
        read_arrays(path)
