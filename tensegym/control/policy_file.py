"""A trained policy in a folder: weights.npz holds its networks, policy.json spaces, statistics and settings.

Both are read as plain numbers. Nothing in them can run, unlike Stable-Baselines3's model.zip and vecnormalize.pkl,
which are not read; `tensegym.train.convert` makes the one of the other for who trusts their maker.
"""

from __future__ import annotations

import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tensegym.arrays import FloatArray
from tensegym.errors import InputError
from tensegym.files import replace_path, write_json
from tensegym.tables import as_number, as_numbers, as_rows, in_file, known, mapping, one_line, read_json

WEIGHTS, SETTINGS = "weights.npz", "policy.json"
_LARGEST = 1 << 28  # bytes of weights
_FIELDS = ("observation_bounds", "action_bounds", "observations", "returns", "clip", "epsilon")

Weights = dict[str, NDArray[Any]]


@dataclass(frozen=True)
class Statistics:
    """Running mean and variance, of ``count`` samples."""

    mean: FloatArray
    variance: FloatArray
    count: float


@dataclass(frozen=True)
class SavedPolicy:
    """What there is to know of a policy.

    Attributes:
        weights: by the names of Stable-Baselines3's state_dict. ``mlp_extractor.index`` (g, n), ``.sign`` (g, n) and
            ``.back`` (g, w) permute an observation (n,) by each symmetry and an action (w,) back; ``.actor`` and
            ``.critic`` are layers between which stands tanh.
        observation_bounds, action_bounds: lowest and highest, (2, n) and (2, w).
        observations, returns: running statistics of the training.
        clip: limit of a normalised observation.
        epsilon: added to a variance before its root is taken.
    """

    weights: Weights
    observation_bounds: NDArray[np.float32]
    action_bounds: NDArray[np.float32]
    observations: Statistics
    returns: Statistics
    clip: float
    epsilon: float

    def layers(self, network: str) -> list[tuple[NDArray[Any], NDArray[Any]]]:
        """Weight and bias of each layer of the ``actor`` or the ``critic``."""
        found: list[tuple[NDArray[Any], NDArray[Any]]] = []
        while (name := f"mlp_extractor.{network}.{2 * len(found)}") + ".weight" in self.weights:
            found.append((self.weights[name + ".weight"], self.weights[name + ".bias"]))
        return found

    @property
    def hidden(self) -> list[int]:
        """Widths of the hidden layers."""
        return [len(bias) for _, bias in self.layers("actor")[:-1]]

    def normalised(self, observation: NDArray[np.float32]) -> NDArray[np.float32]:
        """An observation (n,) as the networks take it."""
        seen = (observation - self.observations.mean) / np.sqrt(self.observations.variance + self.epsilon)
        return np.clip(seen, -self.clip, self.clip).astype(np.float32)


def write_policy(policy: SavedPolicy, folder: Path) -> None:
    """Write weights.npz and policy.json; each file is whole or as before. Raises InputError as `read_policy`."""
    _check(policy, folder)
    write_arrays(policy.weights, folder / WEIGHTS)
    write_json(folder / SETTINGS, {
        "clip": policy.clip, "epsilon": policy.epsilon,
        **{name: {"mean": s.mean.tolist(), "variance": s.variance.tolist(), "count": s.count}
           for name, s in (("observations", policy.observations), ("returns", policy.returns))},
        "observation_bounds": policy.observation_bounds.tolist(), "action_bounds": policy.action_bounds.tolist(),
    })  # fmt: skip


def read_policy(folder: Path) -> SavedPolicy:
    """Read what `write_policy` wrote.

    Raises:
        InputError: a file is cut short, is something else, or does not fit the other.
        OSError: one is missing.
    """
    weights = {name: _single(array) for name, array in read_arrays(folder / WEIGHTS).items()}
    path = folder / SETTINGS
    data = read_json(path, "policy's settings", InputError)
    with in_file(str(path)):
        known(data, _FIELDS, "a policy's settings", InputError)
        for name in _FIELDS:
            if name not in data:
                raise InputError(f"{name} is missing")
        seen, driven = (_bounds(data[name], name) for name in _FIELDS[:2])
        observations, returns = (_statistics(data[name], name) for name in _FIELDS[2:4])
        clip, epsilon = (as_number(data[name], name, InputError) for name in _FIELDS[4:])
    policy = SavedPolicy(weights, seen, driven, observations, returns, clip, epsilon)
    _check(policy, folder)
    return policy


def write_arrays(arrays: Weights, path: Path) -> None:
    """Write arrays by name to an npz file that is whole or as before."""
    with replace_path(path) as fresh, fresh.open("wb") as file:
        np.savez(file, allow_pickle=False, **arrays)


def read_arrays(path: Path) -> Weights:
    """Arrays of numbers by name from an npz file. Raises InputError for one that holds anything else, or OSError."""
    if path.exists() and not path.is_file():  # a device would be read for ever
        raise InputError(one_line(f"{path} is no file: give one of arrays, as NumPy's savez writes it"))
    try:
        with zipfile.ZipFile(path) as archive:
            if sum(member.file_size for member in archive.infolist()) > _LARGEST:
                raise ValueError(f"more than {_LARGEST >> 20} MB")
        with np.load(path, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        for name, array in arrays.items():
            if not isinstance(array, np.ndarray) or array.dtype.kind not in "fi" or not np.isfinite(array).all():
                raise ValueError(f"{name} is not of finite numbers")
    except (ValueError, EOFError, KeyError, NotImplementedError, MemoryError, RuntimeError, zipfile.BadZipFile,
            zlib.error) as error:  # fmt: skip
        raise InputError(f"{path} holds no arrays of numbers: {' '.join(str(error).split())}") from None
    return arrays


def _bounds(value: Any, name: str) -> NDArray[np.float32]:
    """Lowest and highest, (2, n)."""
    if not isinstance(value, list) or len(value) != 2 or not isinstance(value[0], list):
        raise InputError(f"{name} must be a row of lowest and one of highest values")
    return _single(as_rows(value, len(value[0]), name, InputError))


def _single(array: NDArray[Any]) -> NDArray[Any]:
    """Numbers as networks take them: float32, int64."""
    with np.errstate(over="ignore"):  # infinities are refused later
        return array.astype(np.float32 if array.dtype.kind == "f" else np.int64)


def _statistics(value: Any, name: str) -> Statistics:
    table = mapping(value, name, InputError)
    if missing := {"mean", "variance", "count"} - table.keys():
        raise InputError(f"{name}.{min(missing)} is missing")
    mean, variance = (
        np.array(as_numbers(table[key], None, f"{name}.{key}", InputError) if isinstance(table[key], list)
                 else as_number(table[key], f"{name}.{key}", InputError))
        for key in ("mean", "variance")
    )  # fmt: skip
    return Statistics(mean, variance, as_number(table["count"], f"{name}.count", InputError))


def _check(policy: SavedPolicy, folder: Path) -> None:
    """Raises InputError where shapes or numbers do not fit."""
    try:
        _check_shapes(policy)
    except (KeyError, ValueError, TypeError) as error:  # TypeError: one number where an array stands
        raise InputError(one_line(f"{folder} holds no policy: {type(error).__name__} {error}")) from None


def _check_shapes(policy: SavedPolicy) -> None:
    n, w = policy.observation_bounds.shape[1], policy.action_bounds.shape[1]
    index, sign, back = (policy.weights[f"mlp_extractor.{name}"] for name in ("index", "sign", "back"))
    wanted: dict[str, tuple[NDArray[Any], tuple[int, ...]]] = {
        "observation_bounds": (policy.observation_bounds, (2, n)), "action_bounds": (policy.action_bounds, (2, w)),
        "observations.mean": (policy.observations.mean, (n,)), "returns.mean": (policy.returns.mean, ()),
        "observations.variance": (policy.observations.variance, (n,)),
        "returns.variance": (policy.returns.variance, ()), "log_std": (policy.weights["log_std"], (w,)),
        "index": (index, (len(index), n)), "sign": (sign, (len(index), n)), "back": (back, (len(index), w)),
    }  # fmt: skip
    for network, outputs in (("actor", w), ("critic", 1)):
        layers, width = policy.layers(network), n
        if not layers or len(layers[-1][1]) != outputs:
            raise ValueError(f"{network} does not give {outputs} numbers")
        for number, (weight, bias) in enumerate(layers):
            wanted[f"{network} {number}, bias"] = bias, (len(bias),)
            wanted[f"{network} {number}, weight"] = weight, (len(bias), width)
            width = len(bias)
    for name, (array, shape) in wanted.items():
        if array.shape != shape:
            raise ValueError(f"{name} has the shape {array.shape}, not {shape}")
        if not np.isfinite(array).all():
            raise ValueError(f"{name} is not finite")
    for name, rows, size in (("index", index, n), ("back", back, w)):
        if rows.dtype.kind != "i" or not ((rows >= 0) & (rows < size)).all():
            raise ValueError(f"{name} is outside [0, {size - 1}]")
    least = min(policy.observations.count, policy.returns.count, policy.returns.variance, *policy.observations.variance)
    if not (policy.clip > 0 and policy.epsilon > 0 and least >= 0):
        raise ValueError("clip and epsilon must be above 0, a variance and a count not below")
