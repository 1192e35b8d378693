"""Strategies for damaged input: valid files with tokens and bytes changed, and their trees with odd values in them."""

import copy
import datetime
import re

from hypothesis import strategies as st

NUMBERS = st.sampled_from(
    [0, -0.0, 1, -1, 2, 7, 0.5, -0.3, 1e-300, 1e-12, 1e-3, 1e3, 1e6, 1e9, 1e18, 1e300, 2**31, 2**63, 2**64,
     -(2**63), 10**30, 10**308, 10**400, float("nan"), float("inf"), float("-inf"), 5e-324, 1.7976931348623157e308]
)  # fmt: skip
TEXTS = st.sampled_from(
    ["", " ", "x", "1", "nan", "true", "None", "six_rod", "leaf-spring", "../../etc", "/", ".", "a" * 400, "\x00",
     "\u202e", "e\u0301", "\U0001f916", "${h}", "1,5", "1;2", "1e", "0x10", "-", "__class__", "a.b", "[0]"]
)  # fmt: skip
ODD = NUMBERS | TEXTS | st.booleans() | st.sampled_from([datetime.date(2020, 1, 1), datetime.time(1, 2)]) | st.none()


def _deep(value, depth):
    for _ in range(depth):
        value = [value]
    return value


VALUES = st.one_of(
    NUMBERS,
    ODD,
    st.lists(ODD, max_size=4),
    st.lists(st.lists(NUMBERS, max_size=4), max_size=4),
    st.dictionaries(TEXTS | st.sampled_from(["low", "high", "log", "choices", "spread", "value"]), ODD, max_size=3),
    st.builds(_deep, ODD, st.sampled_from([2, 5, 50, 300])),
    st.lists(st.just(0.5), min_size=1000, max_size=1000),
)


def places(tree, path=()):
    """Where a tree has values: paths of keys and indices."""
    pairs = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    for key, value in pairs:
        yield (*path, key)
        yield from places(value, (*path, key))


def at(tree, path):
    for key in path:
        tree = tree[key]
    return tree


@st.composite
def trees(draw, sources):
    """One of the source trees with one to three values replaced, dropped, moved, doubled or renamed."""
    tree = copy.deepcopy(draw(st.sampled_from(sources)))
    for _ in range(draw(st.integers(1, 3))):
        found = list(places(tree))
        if not found:
            break
        path = draw(st.sampled_from(found))
        parent, key = at(tree, path[:-1]), path[-1]
        edit = draw(st.sampled_from(["replace", "replace", "replace", "scale", "drop", "other", "double", "rename"]))
        if edit == "replace":
            parent[key] = draw(VALUES)
        elif edit == "scale" and isinstance(parent[key], int | float) and not isinstance(parent[key], bool):
            parent[key] = parent[key] * draw(st.sampled_from([-1, 0, 1e-9, 1e-3, 0.1, 10, 1e3, 1e9]))
        elif edit == "drop":
            del parent[key]
        elif edit == "other":
            parent[key] = copy.deepcopy(at(tree, draw(st.sampled_from(found))))
        elif edit == "double" and isinstance(parent, list):
            parent.append(copy.deepcopy(parent[key]))
        elif isinstance(parent, dict):
            parent[draw(TEXTS)] = parent.pop(key)
    return tree


SCRAPS = [
    "", " ", "\n", "\t", ",", ";", "=", ":", "-", "[", "]", "{", "}", "<", ">", '"', "'", "#", "&a", "*a", "<!--",
    "]]", "[[",
    "0", "-1", "1e999", "nan", "inf", "1_000", "0x1F", "1,5", "true", "null", "9" * 300, "9" * 5000, "[" * 3000,
    "{" * 500, "x" * 100_000, "\ufeff", "\x00", "\r", "\u2028", "1979-05-27", "!!python/object:os.system", "&#x0;",
]  # fmt: skip


@st.composite
def texts(draw, sources):
    """One of the source files (bytes) with one to four tokens or bytes changed, or cut short."""
    content = draw(st.sampled_from(sources))
    tokens = re.findall(rb"\w+|\s+|[^\w\s]", content)
    for _ in range(draw(st.integers(1, 4))):
        if not tokens:
            break
        place = draw(st.integers(0, len(tokens) - 1))
        edit = draw(st.sampled_from(["scrap", "drop", "double", "swap", "insert", "bytes", "cut"]))
        if edit == "scrap":
            tokens[place] = draw(st.sampled_from(SCRAPS)).encode()
        elif edit == "drop":
            del tokens[place : place + draw(st.integers(1, 8))]
        elif edit == "double":
            end = place + draw(st.integers(1, 30))
            tokens[place:place] = tokens[place:end]
        elif edit == "swap":
            other = draw(st.integers(0, len(tokens) - 1))
            tokens[place], tokens[other] = tokens[other], tokens[place]
        elif edit == "insert":
            tokens.insert(place, draw(st.sampled_from(SCRAPS)).encode())
        elif edit == "bytes":
            tokens[place] = draw(st.binary(max_size=4))
        else:
            del tokens[place:]
    return b"".join(tokens)
