"""Controllers by their table, as a task file or an evaluation names them.

    [controller]
    kind = "cpg"              # the pattern generator, the default
    policy = "onboard"        # a shipped policy or a run's folder, in place of the quadratic feedback; default: none
    gain = 1.0                # and the fields of tensegym.control.cpg.Cpg

    kind = "walker"           # the open-loop walker
    tips = ""                 # six_rod, the default, or three_rod_robot; a file of `tensegym step --all-faces`; or
                              # "own": made now
    depth = 1.0               # and the fields of tensegym.control.walker.WalkerSettings

    kind = "planner"          # A* over the table of tips; as the walker, and
    reach = 0.4               # the field of tensegym.control.planner.PlannerSettings

    kind = "stepper"          # from face to face in closed loop
    holds = ""                # a file of `python benchmarks/holds.py`; default: the default design's
    around = true             # and the fields of tensegym.control.stepper.StepperSettings

    kind = "policy"           # what PPO learned, alone
    policy = "rolling"
    observation = "onboard"   # default: as it was trained

    kind = "random"           # the baseline
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from tensegym.errors import DesignError
from tensegym.files import without_version
from tensegym.tables import as_text, bounded, fill, noted, show

from .controller import Controller
from .cpg import Cpg, CpgController
from .planner import Planner, PlannerSettings
from .policy import PolicyController, policy_env, policy_folder
from .policy_file import read_policy
from .random_commands import RandomCommands
from .stepper import Stepper, StepperSettings
from .tabled import holds_of, tips_of
from .walker import Walker, WalkerSettings

OWN = "own"


def make_controller(table: Mapping[str, Any]) -> Controller:
    """The controller that a table describes.

    Raises:
        DesignError: a field is unknown or out of its range.
        FileNotFoundError: a policy or a table of tips is not there.
    """
    kind, parameters = _parsed(table)
    if kind == "cpg":
        policy = table.get("policy")
        return CpgController(parameters, PolicyController(policy) if policy else None)
    if kind in ("walker", "planner"):
        tips, made_for = (None, None) if (name := table.get("tips", "")) == OWN else tips_of(name)
        return (Walker if kind == "walker" else Planner)(tips, parameters, table.get("period", 0.1), made_for)
    if kind == "stepper":
        holds, made_for = holds_of(table.get("holds", ""))
        return Stepper(holds, parameters, made_for)
    if kind == "policy":
        return PolicyController(parameters.policy, parameters.observation, parameters.period)
    return RandomCommands(parameters.period)


def with_defaults(table: Mapping[str, Any]) -> dict[str, Any]:
    """The table with every default in it. Raises as `make_controller`, but makes no network and no table of tips."""
    kind, parameters = _parsed(table)
    policy = {"policy": table.get("policy", "")} if kind == "cpg" else {}
    if named := policy.get("policy") or getattr(parameters, "policy", ""):
        read_policy(policy_folder(named))
        policy_env(named)
    besides: dict[str, Any] = {
        name: table[name] for name in ("tips", "period", "holds") if name in table and name in KINDS[kind][1]
    }
    return {"kind": kind, **policy, **besides, **asdict(parameters)}


@dataclass(frozen=True)
class _PolicySettings:
    policy: str = noted("rolling", "a shipped policy or a run's folder")
    observation: str | None = noted(None, "in place of the policy's own")
    period: float | None = bounded(1e-3, 60, None, "s", "of its commands, in place of the policy's own")


@dataclass(frozen=True)
class _RandomSettings:
    period: float = bounded(1e-3, 60, 0.4, "s", "a command is held for this long")


KINDS: dict[str, tuple[type[Any], frozenset[str]]] = {
    # the parameters of each kind, and what its table may hold besides
    "cpg": (Cpg, frozenset({"policy"})),
    "walker": (WalkerSettings, frozenset({"tips", "period"})),
    "planner": (PlannerSettings, frozenset({"tips", "period"})),
    "stepper": (StepperSettings, frozenset({"holds"})),
    "policy": (_PolicySettings, frozenset()),
    "random": (_RandomSettings, frozenset()),
}


def _parsed(table: Mapping[str, Any]) -> tuple[str, Any]:
    """Kind and parameters."""
    table = without_version(dict(table), "the controller's table")  # as best/controller.toml of a search has one
    kind = table.get("kind", "cpg")
    if not isinstance(kind, str) or kind not in KINDS:
        raise DesignError(f"controller kind = {show(kind)} is not one of {', '.join(KINDS)}")
    parameters, besides = KINDS[kind]
    for name in besides & table.keys() - {"period"}:
        as_text(table[name], f"controller {name}", DesignError)
    if "period" in besides & table.keys():
        fill(_RandomSettings, {"period": table["period"]}, "controller", DesignError)
    own = {name: value for name, value in table.items() if name != "kind" and name not in besides}
    return kind, fill(parameters, own, "controller", DesignError)
