"""Odd actions and reset options for the environment."""

from typing import Any

import numpy as np
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from tests.fuzz.mutants import NUMBERS, TEXTS, VALUES

KINDS = st.sampled_from([np.float64, np.float32, np.int64, np.bool_, np.complex128, np.object_])
ACTIONS = st.one_of(
    hnp.arrays(np.float64, 6, elements=st.floats(-1, 1)),
    hnp.arrays(np.float64, 6, elements=st.floats(allow_nan=True, allow_infinity=True)),
    hnp.arrays(np.float32, hnp.array_shapes(min_dims=0, max_dims=3, max_side=8), elements=st.floats(-1, 1, width=32)),
    st.lists(NUMBERS, min_size=6, max_size=6),
    st.builds(lambda kind, n: np.zeros(n, kind), KINDS, st.sampled_from([0, 1, 5, 6, 7, 100_000])),
    st.lists(TEXTS, min_size=6, max_size=6),
    VALUES,
)
OPTIONS = st.one_of(
    st.none(),
    VALUES,
    st.dictionaries(
        st.sampled_from(["face", "heading", "direction", "design", "seed"]) | TEXTS,
        st.one_of(st.sampled_from([0, 3, 19, 20, -1, 0.5, "six_rod", "paper", {"payload": {"mass": 0.5}}]), VALUES),
        max_size=3,
    ),
)
SEEDS = st.one_of(st.none(), st.sampled_from([0, 1, 2**31, 2**64, -1, 0.5, "1", True, np.int64(3)]))
CALLS = st.one_of(
    st.tuples(st.just("step"), ACTIONS),
    st.tuples(st.just("reset"), st.fixed_dictionaries({"seed": SEEDS, "options": OPTIONS})),
)


class Environment:
    """An environment that is called, and made again after what broke it."""

    def __init__(self) -> None:
        self.env: Any = None

    def call(self, call: tuple[str, Any]) -> None:
        from tensegym.envs.rolling import RollingEnv

        if self.env is None:
            self.env = RollingEnv(control_period=0.02, settle=0.0)
            self.env.reset(seed=0)
        name, argument = call
        if name == "step":
            _, _, terminated, _, _ = self.env.step(argument)
            if terminated:
                self.env.reset(seed=1)
        else:
            self.env.reset(**argument)

    def close(self) -> None:
        if self.env is not None:
            self.env.close()
            self.env = None
