"""A trained policy as one ONNX graph: observation in, action out, the running statistics and symmetries inside."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tensegym.files import replace_path

from .policy_file import SavedPolicy

if TYPE_CHECKING:
    import onnx

OPERATORS = 17  # version of ONNX's operators: any runtime of the last years has it


def policy_graph(policy: SavedPolicy, about: Mapping[str, Any]) -> onnx.ModelProto:
    """The graph of a policy's deterministic action.

    Its input ``observation`` (batch, n) and its output ``action`` (batch, w) are single precision; normalisation is in
    double, as `SavedPolicy.normalised` has it.

    Args:
        policy: what was learned.
        about: kept in the file's metadata as text, or as JSON where it is none.
    """
    from onnx import TensorProto, checker, helper, numpy_helper

    nodes, constants = [], []

    def constant(name: str, value: Any) -> str:
        constants.append(numpy_helper.from_array(np.ascontiguousarray(value), name))
        return name

    def node(kind: str, inputs: list[str], output: str, **attributes: Any) -> str:
        nodes.append(helper.make_node(kind, inputs, [output], **attributes))
        return output

    seen, weights = policy.observations, policy.weights
    deviation = np.sqrt(seen.variance + policy.epsilon)
    at = node("Cast", ["observation"], "exact", to=TensorProto.DOUBLE)
    at = node("Sub", [at, constant("mean", seen.mean)], "centred")
    at = node("Div", [at, constant("deviation", deviation)], "scaled")
    at = node("Clip", [at, constant("lowest", -policy.clip), constant("highest", policy.clip)], "clipped")
    at = node("Cast", [at], "normalised", to=TensorProto.FLOAT)
    index = weights["mlp_extractor.index"].astype(np.int64)
    at = node("Gather", [at, constant("index", index)], "permuted", axis=1)  # (batch, g, n)
    at = node("Mul", [at, constant("sign", weights["mlp_extractor.sign"].astype(np.float32))], "images")
    for number, (weight, bias) in enumerate(policy.layers("actor")):
        if number:
            at = node("Tanh", [at], f"hidden{number}")
        at = node("MatMul", [at, constant(f"weight{number}", weight.T)], f"product{number}")
        at = node("Add", [at, constant(f"bias{number}", bias)], f"layer{number}")
    # back (g, w): entry (g, k) of an image's action belongs to drive k; flat, so that one Gather takes them all
    back = weights["mlp_extractor.back"].astype(np.int64)
    group, driven = back.shape
    flat = back + driven * np.arange(group)[:, None]
    at = node("Reshape", [at, constant("flat", np.array([0, group * driven]))], "every")
    at = node("Gather", [at, constant("back", flat)], "turned", axis=1)
    at = node("ReduceMean", [at], "average", axes=[1], keepdims=0)
    low, high = (constant(name, row.astype(np.float32)) for name, row in
                 zip(("low", "high"), policy.action_bounds, strict=True))  # fmt: skip
    at = node("Max", [at, low], "above")
    node("Min", [at, high], "action")

    size = policy.observation_bounds.shape[1]
    graph = helper.make_graph(
        nodes, "policy",
        [helper.make_tensor_value_info("observation", TensorProto.FLOAT, ["batch", size])],
        [helper.make_tensor_value_info("action", TensorProto.FLOAT, ["batch", driven])],
        constants,
    )  # fmt: skip
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", OPERATORS)], producer_name="tensegym",
                              ir_version=8)  # fmt: skip
    helper.set_model_props(model, {key: value if isinstance(value, str) else json.dumps(value)
                                   for key, value in about.items()})  # fmt: skip
    checker.check_model(model)
    return model


def write_onnx(policy: SavedPolicy, about: Mapping[str, Any], path: Path) -> None:
    """Write `policy_graph` to a file that is whole or as before."""
    text = policy_graph(policy, about).SerializeToString()
    with replace_path(path) as fresh:
        fresh.write_bytes(text)
