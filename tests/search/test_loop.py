import numpy as np
import pytest
from workers import killed_once, quick

from tensegym.errors import InputError
from tensegym.processes import Pool
from tensegym.search.loop import run_search
from tensegym.search.store import Store

ONE = Pool(1)


class Killed(Exception):
    pass


def values_of(store):
    return {n: (values, outcome.metrics, outcome.refused) for n, (values, outcome) in store.finished().items()}


@pytest.fixture
def store(tmp_path):
    def make(name, problem):
        (tmp_path / name).mkdir(exist_ok=True)
        return Store(tmp_path / name, problem)

    return make


@pytest.mark.parametrize("sampler", ["cmaes", "tpe", "nsga2", "random"])
def test_a_search_that_was_killed_and_resumed_equals_one_that_was_not(tiny, store, sampler):
    problem = tiny(('"random"', f'"{sampler}"'))
    whole, broken = store("whole", problem), store("broken", problem)
    run_search(problem, whole, ONE, 17, evaluate=quick)

    runs: list[int] = []

    def counted(trial):
        if len(runs) in (5, 12):
            runs.append(-1)
            raise Killed
        runs.append(trial.number)
        return quick(trial)

    for _ in range(2):
        with pytest.raises(Killed):
            run_search(problem, broken, ONE, 17, evaluate=counted)
    run_search(problem, store("broken", None), ONE, 17, evaluate=counted)
    assert values_of(broken) == values_of(whole)
    assert sorted(n for n in runs if n >= 0) == list(range(17))  # none twice
    assert sum(outcome.refused is not None for _, outcome in whole.finished().values()) == 2


def test_a_budget_raised_later_gives_the_trials_of_a_larger_one(tiny, store):
    problem = tiny(('"random"', '"cmaes"'))
    whole, later = store("whole", problem), store("later", problem)
    run_search(problem, whole, ONE, 14, evaluate=quick)
    run_search(problem, later, ONE, 6, evaluate=quick)
    run_search(problem, later, ONE, 14, evaluate=quick)
    assert values_of(later) == values_of(whole)


def test_the_seed_decides(tiny, store):
    problems = [tiny(), tiny().with_settings(seed=1)]
    for i, problem in enumerate(problems):
        run_search(problem, store(str(i), problem), ONE, 5, evaluate=quick)
    first, second = (values_of(store(str(i), None)) for i in range(2))
    assert first[0][0] == second[0][0]  # the start
    assert first[1][0] != second[1][0]


def test_cmaes_finds_the_top_of_a_hill_that_random_search_does_not(tiny, store):
    best = {}
    for sampler in ("cmaes", "random"):
        problem = tiny(('"random"', f'"{sampler}"'), ("batch = 3", "batch = 8"))
        run_search(problem, kept := store(sampler, problem), ONE, 97, evaluate=quick)
        best[sampler] = max(o.metrics.get("speed_lps", 0) for _, o in kept.finished().values())
    assert best["cmaes"] > 0.98
    assert best["cmaes"] > best["random"]


def test_two_processes_find_what_one_finds(tiny, store):
    problem = tiny()
    run_search(problem, one := store("one", problem), ONE, 5)
    with Pool(2) as engine:
        run_search(problem, two := store("two", problem), engine, 5)
    assert values_of(one) == values_of(two)


def test_a_trial_whose_worker_was_killed_is_run_again(tiny, store, tmp_path):
    problem = tiny()
    space = problem.space
    space.tables["controller"]["policy"] = str(tmp_path / "killed")
    with Pool(2) as engine:
        run_search(problem, kept := store("kept", problem), engine, 4, evaluate=killed_once)
    assert (tmp_path / "killed").exists()
    assert sorted(kept.finished()) == [0, 1, 2, 3]


def test_a_store_of_another_search_is_refused(tiny, store):
    store("one", tiny())
    with pytest.raises(InputError, match="holds the study of another task file"):
        store("one", tiny(("batch = 3", "batch = 4")))


def test_stored_trials_that_this_search_does_not_ask_for_are_refused(tiny, store):
    problem = tiny()
    run_search(problem, kept := store("one", problem), ONE, 4, evaluate=quick)
    other = problem.with_settings(seed=5)
    with pytest.raises(InputError, match="stored trial 1 is not the one"):
        run_search(other, kept, ONE, 8, evaluate=quick)


def test_two_objectives_give_a_front(tiny, store):
    from tensegym.search.winner import losses_of, pareto

    problem = tiny(('"random"', '"nsga2"\nobjectives = ["max speed_lps", "min mass"]'), ("batch = 3", "batch = 8"))
    run_search(problem, kept := store("two", problem), ONE, 60, evaluate=quick)
    numbers, losses = losses_of(problem, kept.finished())
    front = losses[pareto(losses)]
    assert len(numbers) == 60 - 8  # those refused have none
    order = front[np.argsort(front[:, 0])]
    assert len(order) > 1 and (np.diff(order[:, 1]) < 0).all()
