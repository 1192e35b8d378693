"""Where finished trials are kept: an Optuna study in SQLite, or in any database that SQLAlchemy has a URL for.

A trial is written in one transaction when it is finished, never before, so a killed search leaves whole trials only.
"""

from __future__ import annotations

import re
import sqlite3
from contextlib import closing
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
import optuna
import sqlalchemy
from optuna.trial import FrozenTrial, TrialState, create_trial
from sqlalchemy.exc import SQLAlchemyError

from tensegym.errors import InputError
from tensegym.files import VERSION, without_version
from tensegym.tables import as_number, as_text, as_whole, fill, one_line

from .asker import Asker
from .evaluate import TrialResult
from .problem import Problem
from .space import Value

Finished = dict[int, tuple[dict[str, Value], TrialResult]]  # number of a trial: its values and outcome


def masked(url: str) -> str:
    """A database URL as it may be shown and kept: with *** for its password."""
    return re.sub(r"((?:^|[?&])[^=&?]*password=)[^&]*", r"\1***", re.sub(r"(://[^/?#]*?:).*@", r"\1***@", url))


def _unanswered(url: str, error: Exception) -> InputError:
    cause = error.__cause__ or error  # Optuna wraps what the database said
    reason = str(cause).splitlines()[0].replace(url, masked(url))
    return InputError(f"storage {masked(url)!r} does not answer: {reason}")


def _unreadable(url: str, error: Exception) -> InputError:
    reason = f"{type(error).__name__}: {error}".replace(url, masked(url))
    return InputError(one_line(f"storage {masked(url)!r} holds no study that can be read: {reason}"))


class Store:
    """The study of one output folder. url: default study.db in the folder.

    Raises InputError where the database does not answer, or holds another search under the same name.
    """

    def __init__(self, folder: Path, problem: Problem | None, url: str | None = None) -> None:
        url = url or f"sqlite:///{folder / 'study.db'}"
        name = "tensegym design" if url.startswith("sqlite:///") else f"tensegym design {folder.resolve().name}"
        optuna.logging.set_verbosity(optuna.logging.ERROR)
        if problem is None and url.startswith("sqlite:///"):
            _check_database(Path(url.removeprefix("sqlite:///")))
        try:
            storage = optuna.storages.RDBStorage(url)
            if url.startswith("sqlite:"):
                sqlalchemy.event.listen(storage.engine, "connect", _write_ahead)
                storage.engine.dispose()  # connections made from now on
            if problem is None:
                self._study = optuna.load_study(study_name=name, storage=storage)
            else:
                self._study = optuna.create_study(
                    study_name=name, storage=storage, load_if_exists=True,
                    directions=[o.direction for o in problem.settings.objectives],
                )  # fmt: skip
        except KeyError as error:
            raise InputError(f"{masked(url)} holds no study {name!r}; start one with `tensegym design run`") from error
        except (SQLAlchemyError, ImportError, optuna.exceptions.OptunaError) as error:
            raise _unanswered(url, error) from None
        except Exception as error:  # of what Optuna finds in a database of something else
            raise _unreadable(url, error) from None
        self._url = url
        without_version({"version": self.noted("version") or 0}, masked(url))
        known = self.noted("problem")
        if problem is not None and known is None:
            self.note("version", VERSION)
            self.note("problem", problem.text)
        elif problem is not None and known != problem.text:
            raise InputError(f"{folder} holds the study of another task file; resume that one, or give another --out")

    @property
    def problem_text(self) -> str:
        """The task file of the search. Raises InputError where the study has none."""
        return as_text(self.noted("problem"), f"{masked(self._url)}: problem", InputError)

    @property
    def budget(self) -> int:
        """Trials in all, as last asked for. Raises InputError where the study does not say."""
        return as_whole(self.noted("budget"), f"{masked(self._url)}: budget", InputError, "--budget to resume it with")

    @property
    def study(self) -> optuna.Study:
        """For Optuna's own tools."""
        return self._study

    def note(self, key: str, value: Any) -> None:
        """Keep a plain value with the study. Raises InputError where the database does not take it."""
        try:
            self._study.set_user_attr(key, value)
        except (SQLAlchemyError, optuna.exceptions.OptunaError) as error:
            raise _unanswered(self._url, error) from None

    def noted(self, key: str) -> Any:
        """What `note` kept, or None. Raises InputError where the database cannot be read."""
        try:
            return self._study.user_attrs.get(key)
        except Exception as error:
            raise _unreadable(self._url, error) from None

    def add(self, asker: Asker, values: dict[str, Value], outcome: TrialResult) -> None:
        """Write a finished trial. Raises InputError where the database does not take it, as on a full disk."""
        refused = outcome.refused is not None
        trial = create_trial(
            state=TrialState.FAIL if refused else TrialState.COMPLETE,
            values=None if refused else [outcome.metrics[o.metric] for o in asker.settings.objectives],
            params=values, distributions=asker.distributions, user_attrs={"outcome": asdict(outcome)},
        )  # fmt: skip
        try:
            self._study.add_trial(trial)
        except (SQLAlchemyError, optuna.exceptions.OptunaError) as error:
            raise _unanswered(self._url, error) from None

    def pace(self, budget: int) -> dict[str, float | None]:
        """Trials a minute over the last fifty, and the seconds that ``budget`` trials still take at that rate."""
        ends = sorted(t.datetime_complete for t in self._trials() if t.datetime_complete)
        recent = ends[-50:]
        span = (recent[-1] - recent[0]).total_seconds() if len(recent) > 1 else 0.0
        if not span:
            return {"trials_a_minute": None, "seconds_left": None}
        rate = (len(recent) - 1) / span
        return {"trials_a_minute": 60 * rate, "seconds_left": max(0, budget - len(ends)) / rate}

    def seconds(self) -> float:
        """Wall time of the search [s]: between its trials' ends, less any break of over ten minutes."""
        times = [t.datetime_complete.timestamp() for t in self._trials() if t.datetime_complete]
        gaps = np.diff(sorted(times))
        return float(gaps[gaps < 600].sum())

    def finished(self) -> Finished:
        """Every trial that is done, by number. Raises InputError for one that this package has not written."""
        found: Finished = {}
        for trial in self._trials():
            where = f"{masked(self._url)}: trial {trial.number}"
            outcome = fill(TrialResult, trial.user_attrs.get("outcome"), where, InputError)
            metrics = {name: _number(value, f"{where}: {name}") for name, value in outcome.metrics.items()}
            found[outcome.number] = (dict(trial.params), replace(outcome, metrics=metrics))
        return found

    def _trials(self) -> list[FrozenTrial]:
        try:
            return self._study.get_trials(deepcopy=False)
        except Exception as error:
            raise _unreadable(self._url, error) from None


def _number(value: Any, where: str) -> float:
    """A metric, which may be infinite. Raises InputError."""
    return value if isinstance(value, float) else as_number(value, where, InputError)


def _check_database(path: Path) -> None:
    """Look whether a file holds a study, without writing to it as Optuna does. Raises InputError."""
    try:
        with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)) as database:
            database.execute("SELECT study_name FROM studies LIMIT 1")
    except (sqlite3.Error, ValueError) as error:
        raise InputError(one_line(f"{path} holds no study: {error}")) from None


def _write_ahead(connection: Any, _: Any) -> None:
    """SQLite's log in place of its journal: fewer waits for the disk, and as safe against a killed process."""
    connection.execute("PRAGMA journal_mode=WAL")
    connection.execute("PRAGMA synchronous=NORMAL")
