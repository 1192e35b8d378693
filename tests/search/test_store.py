"""What a store shows and keeps of its database's address."""

import sqlite3

import pytest
import sqlalchemy

from tensegym.cli.design import open_search
from tensegym.errors import InputError
from tensegym.search.asker import Asker
from tensegym.search.evaluate import TrialResult
from tensegym.search.store import Store, masked


@pytest.mark.parametrize(
    ("url", "shown"),
    [
        ("postgresql+psycopg2://me:se:c@r/et@host:5432/db", "postgresql+psycopg2://me:***@host:5432/db"),
        ("postgresql://host/db?user=me&password=secret&port=1", "postgresql://host/db?user=me&password=***&port=1"),
        ("mysql://me@host/db", "mysql://me@host/db"),
        ("sqlite:////home/me/a@b.db", "sqlite:////home/me/a@b.db"),
        ("", ""),
    ],
)
def test_passwords_are_masked_and_nothing_else_is(url, shown):
    assert masked(url) == shown


@pytest.mark.parametrize("url", ["postgresql://me:secret@127.0.0.1:1/db", "sqlite://me:secret@host/db"])
def test_no_password_in_an_error(tiny, tmp_path, url):
    with pytest.raises(InputError) as caught:
        Store(tmp_path, tiny(), url)
    assert caught.value.__suppress_context__  # which names it
    assert "secret" not in str(caught.value)


def test_a_search_whose_password_was_not_kept_asks_for_it(tmp_path):
    (tmp_path / "storage.txt").write_text(masked("postgresql://me:secret@host/db"))
    with pytest.raises(InputError, match=r"kept at postgresql://me:\*\*\*@host/db, .*give --storage URL again"):
        open_search(tmp_path)


def test_a_database_that_takes_nothing_more_is_told_in_one_line(tiny, tmp_path):
    store = Store(tmp_path, problem := tiny())
    with sqlite3.connect(tmp_path / "study.db") as other:
        full = other.execute("PRAGMA page_count").fetchone()[0]
    sqlalchemy.event.listen(store.study._storage._backend.engine, "checkout",
                            lambda c, *_: c.execute(f"PRAGMA max_page_count = {full}"))  # fmt: skip
    asker = Asker(problem)
    with pytest.raises(InputError, match=r"study\.db' does not answer: .*full"):
        for number in range(200):
            store.add(asker, asker.ask()[0], TrialResult(number, {"speed_lps": 1.0, "notes" * 500: 0.0}, 1))


def test_a_study_of_a_newer_version_is_refused(tiny, tmp_path):
    Store(tmp_path, tiny()).note("version", 2)
    with pytest.raises(InputError, match=r"study\.db is of version 2, this tensegym reads up to 1"):
        Store(tmp_path, None)
