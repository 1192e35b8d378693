import pytest

from tensegym.errors import InputError
from tensegym.search.problem import load_problem, problem_from


def test_the_start_and_every_value_reach_the_tables(tiny):
    space = tiny().space
    assert [d.name for d in space.dimensions] == [
        "design.elastic_cable.pretension", "controller.lags[0]", "controller.lags[1]"
    ]  # fmt: skip
    assert list(space.start.values()) == [10.0, 0.0, 0.0]
    tables = space.apply(space.start | {"design.elastic_cable.pretension": 7.0, "controller.lags[1]": 0.5})
    assert tables["design"]["elastic_cable"] == {"pretension": 7.0}
    assert tables["controller"]["lags"] == [0.0, 0.5]
    assert space.apply(space.start)["controller"]["lags"] == [0.0, 0.0]


def test_choices_and_lengths_of_rods(tiny):
    space = tiny(('"controller.lags" = {low = -1.0, high = 1.0}', """
"design.structure.rod_length" = {low = 0.65, high = 0.9}
"design.payload.two_way" = {choices = [false, true]}
[design.payload]""")).space  # fmt: skip
    tables = space.apply(space.start | {"design.payload.two_way": 1, "design.structure.rod_length": 0.6})
    assert tables["design"]["payload"] == {"two_way": True}
    assert tables["design"]["structure"] == {"rod_length": 0.6}
    assert space.start["design.structure.rod_length"] == pytest.approx(0.70167, abs=1e-5)


def test_the_shipped_carry_task_begins_at_the_papers_numbers():
    problem = load_problem("carry")
    assert problem.task.payload == problem.space.tables["design"]["payload"]["mass"] == 0.5
    start = problem.space.start
    assert start["design.elastic_cable.stiffness"] == 300 and start["design.elastic_cable.damping"] == 150
    assert start["design.payload.stiffness"] == 120 and start["design.payload.damping"] == 60


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("low = 5.0, high = 20.0", "low = 20.0, high = 20.0", ["elastic_cable.pretension", "is no range"]),
        ("low = 5.0, high = 20.0", "low = 5.0", ["must give low and high"]),
        ("low = 5.0, high = 20.0", "low = -5.0, high = 20.0", ["from -5 to 20 is no range", "above 0 with log"]),
        ("low = 5.0, high = 20.0, log = true", "low = -5.0, high = 20.0", ["at -5", "outside [0, 10000] N"]),
        ("elastic_cable.pretension", "elastic_cable.pretention", ["unknown field 'pretention'", "pretension"]),
        ("design.elastic_cable.pretension", "elastic.pretension", ["under design. or controller."]),
        ("controller.lags", "controller.legs", ["unknown field 'legs'", "lags"]),
        ('motion = "roll"', 'motion = "fly"', ["'fly' is not one of roll, step"]),
        ('motion = "roll"', 'motion = "roll"\ngoal = "grace >= 1"', ["no metric measures 'grace'", "speed_lps"]),
        ("seconds = 0.8", "seconds = -1", ["seconds = -1 is outside"]),
        ("seconds = 0.8", "seconds = 80\nroughness = 0.02", ["Roll.seconds = 80.0", "over 73 s"]),
        ("seconds = 0.8", "second = 0.8", ["unknown field 'second'", "seconds"]),
        ('sampler = "random"', 'sampler = "random"\nobjectives = ["max beauty"]', ["no metric measures 'beauty'"]),
        ('sampler = "random"', 'sampler = "random"\nconstraints = ["arrived >= 1"]', ["no metric measures 'arrived'"]),
        ('sampler = "random"', 'sampler = "luck"', ["'luck' is not one of cmaes"]),
        ('sampler = "random"', 'sampler = "cmaes"\nobjectives = ["max tips", "min mass"]', ["cmaes takes one"]),
        ("batch = 3", "batch = 0", ["search.batch = 0 is outside"]),
        ("episodes = 2", "episode = 2", ["'episode'", "episodes"]),
        ("[search]", "[serach]", ["unknown field 'serach' in the task file; did you mean 'search'"]),
        ("[search]", "[search", ["is not TOML"]),
    ],
)
def test_bad_task_files_are_refused(tiny, old, new, words):
    with pytest.raises(InputError) as refused:
        tiny((old, new))
    for word in ["tiny", *words]:
        assert word in str(refused.value)


@pytest.mark.parametrize(("structure", "words"), [
    ("rods = 2", ["structure.rods = 2 is outside [3, 60]"]),
    ("height = -1", ["structure.height = -1 is outside"]),
    ('builder = "prsim"', ["'prsim' is not one of prism"]),
])  # fmt: skip
def test_a_builder_that_makes_nothing_is_refused(tiny, structure, words):
    builder = "" if "builder" in structure else 'builder = "prism"\n'
    with pytest.raises(InputError) as refused:
        tiny(("[controller]", f"[design.structure]\n{builder}{structure}\n[controller]"))
    assert all(word in str(refused.value) for word in ["tiny", *words])


def test_whole_numbers_are_searched_as_choices(tiny):
    prism = ("[controller]\namplitudes = [0.5, 0.5]",
             '[design.structure]\nbuilder = "prism"\nwound = "around"\n[controller]\nkind = "random"')  # fmt: skip
    space = '"controller.lags" = {low = -1.0, high = 1.0}'
    with pytest.raises(InputError, match=r"takes whole numbers; give them as choices = \[3, 4\]"):
        tiny(prism, (space, '"design.structure.rods" = {low = 3, high = 5}'))
    problem = tiny(prism, (space, '"design.structure.rods" = {choices = [3, 4]}'))
    rods = "design.structure.rods"
    assert problem.space.apply(problem.space.start | {rods: 1})["design"]["structure"]["rods"] == 4


def test_a_space_is_needed():
    with pytest.raises(InputError, match="is empty; give at least one field"):
        problem_from('task = "roll"', "nothing")


@pytest.mark.parametrize("name", [
    "agile", "carry", "carry_conditioned", "climb", "climb_untaught", "course", "cross", "four_rod", "prism", "roll",
    "sprint", "step", "three_rod",
])  # fmt: skip
def test_shipped_task_files_are_sound(name):
    problem = load_problem(name)
    other = {"agile": "places", "sprint": "roll", "prism": "roll", "three_rod": "roll", "four_rod": "roll"}
    assert problem.task.motion == other.get(name, name.split("_")[0])
    assert set(problem.space.start) == {d.name for d in problem.space.dimensions}
