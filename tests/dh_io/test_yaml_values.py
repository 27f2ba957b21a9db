"""YAML as plain values, for files that are no tables: bounded, and read like ruamel reads it."""

import io

import pytest
from hostile import hostile, outcome
from hypothesis import strategies as st
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from dh2urdf.dh_io.formats.yaml import yaml_values
from dh2urdf.exceptions import TableFileError

BOMB = "a: &a [x, x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{chr(98 + i)}: &{chr(98 + i)} [{', '.join(['*' + chr(97 + i)] * 10)}]\n" for i in range(8)
)

MARKS = ["[", "]", "{", "}", "- ", "? ", ": ", "'", '"', "\\", "#", "|", ">", "\n", "\n  ", "\t"]
WORDS = ["axes: ", "&a ", "*a", "!!set ", "1e999", "~", "9" * 400, "\\UFFFFFFFF", "%YAML 1.2\n"]
PIECES = st.sampled_from(MARKS + WORDS)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (BOMB, "alias"),
        ("axes: " + "[" * 3000, "nested deeper than 16 levels"),
        ("{a: " * 3000, "nested deeper than 16 levels"),
        ("[" + "1, " * 400_000 + "]", "larger than"),
        ("[" + "1, " * 100_000 + "]", "more than 20000 cells"),
        ("a: 1\na: 2", "given twice"),
        ("a: !!python/object:os.system x", "tag"),
        ('a: "\\UFFFFFFFF"', "not YAML"),
    ],
)
def test_what_would_grow_without_bound_is_refused(text, says):
    """Aliases, depths and counts end the reading of a YAML file before they cost anything."""
    got = outcome(yaml_values, text, "axes.yaml")
    assert isinstance(got, TableFileError)
    assert "axes.yaml:" in str(got)
    assert says in str(got)


@hostile(text=st.one_of(st.lists(PIECES, max_size=30).map("".join), st.text(max_size=60)))
def test_any_yaml_is_values_or_refused(text):
    """Whatever the text, it is read or refused with the place of the fault."""
    outcome(yaml_values, text, "axes.yaml")


VALUES = st.recursive(
    st.one_of(
        st.none(),
        st.booleans(),
        st.integers(-(10**14), 10**14),
        st.floats(allow_nan=False),
        st.text(st.characters(exclude_categories=["C", "Z"]), max_size=6),
    ),
    lambda parts: st.lists(parts, max_size=3) | st.dictionaries(st.text("abc_"), parts, max_size=3),
    max_leaves=12,
)


@hostile(values=VALUES)
def test_values_come_back_as_ruamel_wrote_them(values):
    """Numbers, texts, truths and nothing keep their kinds."""
    written = {"values": values}
    stream = io.StringIO()
    YAML(typ="safe", pure=True).dump(written, stream)
    text = stream.getvalue()
    try:
        faithful = YAML(typ="safe", pure=True).load(text) == written
    except YAMLError:
        faithful = False  # it writes some texts that begin with ":" or "?" without quotes
    found = outcome(yaml_values, text, "values.yaml")
    assert found == written or not faithful
