"""A table written in any format and unit reads back identical, bit by bit."""

import json
import math
import struct
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ruamel.yaml import YAML

from dh2urdf import DHConvention, DHRow, DHTable, JointType, Mimic, Origin
from dh2urdf.dh_io import SI, Units, parse_table, read_table, table_to_text, write_table
from dh2urdf.exceptions import TableError

FORMATS = ("yaml", "toml", "json", "csv", "tsv", "markdown")

numbers = st.floats(-1e4, 1e4) | st.sampled_from([0.0, math.pi / 2, -math.pi, 0.089159, 1e-300])
positive = st.floats(1e-12, 1e6)
triples = st.tuples(numbers, numbers, numbers)
words = st.text(min_size=1, max_size=12) | st.sampled_from(
    ["null", "no", "~", "-", "1", "a: b", "# x", "'", '"', "a|b", "a\\", "[x]", "a,b", " a ", "é"]
)
origins = st.builds(Origin, triples, triples)
maybe_origins = st.just(Origin()) | origins
limits = st.none() | st.tuples(numbers, numbers).map(sorted)


def maybe(strategy: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    return st.none() | strategy


@st.composite
def joints(draw: st.DrawFn, number: int) -> DHRow:
    """A joint's row with anything or nothing given; names differ by their number."""
    lower, upper = draw(limits) or (None, draw(maybe(numbers)))
    mass = draw(maybe(positive))
    return DHRow(
        *draw(st.tuples(numbers, numbers, numbers, numbers)),
        draw(st.sampled_from([JointType.REVOLUTE, JointType.PRISMATIC])),
        sign=draw(st.sampled_from([1, -1])),
        name=draw(st.just("") | words.map(lambda w: f"{w}{number}")),
        lower=lower,
        upper=upper,
        velocity=draw(maybe(positive)),
        effort=draw(maybe(positive)),
        damping=draw(maybe(positive)),
        friction=draw(maybe(positive)),
        mass=mass,
        com=draw(maybe(triples)) if mass else None,
        inertia=draw(maybe(st.tuples(*[numbers] * 6))) if mass else None,
    )


@st.composite
def between(draw: st.DrawFn, rows: list[DHRow]) -> tuple[list[DHRow], dict[str, Any]]:
    """The rows, the last one following the first or coupled to it and to others."""
    places = [i for i, row in enumerate(rows) if row.is_joint]
    names = [rows[i].name or f"joint_{k}" for k, i in enumerate(places, 1)]
    way = draw(st.sampled_from(["none", "none", "mimic", "couplings"]))
    if len(set(names)) < len(names) or len(names) < 2 or way == "none":
        return rows, {}
    ratios, last = st.floats(-1e4, 1e4), places[-1]
    if way == "mimic":
        follows = Mimic(names[0], draw(ratios), draw(numbers))
        return [*rows[:last], replace(rows[last], mimic=follows), *rows[last + 1 :]], {}
    drivers = draw(st.lists(st.sampled_from(names[:-1]), min_size=1, unique=True))
    return rows, {names[-1]: {name: draw(st.floats(-10, 10)) for name in drivers}}


fixed_rows = origins.map(lambda o: DHRow(joint_type=JointType.FIXED, origin=o)) | st.builds(
    lambda p: DHRow(*p, JointType.FIXED), st.tuples(numbers, numbers, numbers, numbers)
)


@st.composite
def tables(draw: st.DrawFn) -> DHTable:
    rows = [draw(joints(0))]
    rows += [draw(joints(k) | fixed_rows) for k in range(1, draw(st.integers(1, 4)))]
    rows, couplings = draw(between(rows))
    return DHTable(
        tuple(rows),
        draw(st.sampled_from(DHConvention)),
        couplings=couplings,
        name=draw(words),
        base=draw(maybe_origins),
        tool=draw(maybe_origins),
        source=draw(st.just("") | words),
        checked=draw(st.just("") | words),
    )


units = st.builds(Units, st.sampled_from(["m", "cm", "mm", "in"]), st.sampled_from(["rad", "deg"]))


def bits(table: DHTable) -> list[bytes]:
    """All numbers of a table as their eight bytes, -0.0 taken as 0.0."""
    out = [*table.base.xyz, *table.base.rpy, *table.tool.xyz, *table.tool.rpy]
    for row in table.rows:
        out += [row.theta, row.d, row.a, row.alpha, *(row.com or ()), *(row.inertia or ())]
        out += [*row.origin.xyz, *row.origin.rpy] if row.origin else []
        limits = (row.lower, row.upper, row.velocity, row.mass)
        out += [value for value in limits if value is not None]
    return [struct.pack("d", value + 0.0) for value in out]


@pytest.mark.parametrize("format", FORMATS)
@given(table=tables(), units=units)
def test_a_table_survives_every_format_and_unit(format: str, table: DHTable, units: Units) -> None:
    """What is read equals what was written, every float to the last bit."""
    text = table_to_text(table, format, units)
    again = parse_table(text, format).table
    assert again == table
    assert bits(again) == bits(table)


@given(tables())
def test_writing_twice_gives_the_same_text(table: DHTable) -> None:
    """The text of a table that was read is the text it was read from."""
    for format in FORMATS:
        text = table_to_text(table, format)
        assert table_to_text(parse_table(text, format).table, format) == text


@given(tables())
def test_other_readers_see_the_same_numbers(table: DHTable) -> None:
    """YAML, TOML and JSON files are that for the readers everybody has, in metres and radians."""
    read = [
        YAML(typ="safe", pure=True).load(table_to_text(table, "yaml")),
        tomllib.loads(table_to_text(table, "toml")),
        json.loads(table_to_text(table, "json")),
    ]
    for data in read:
        assert data["name"] == table.name
        assert data["convention"] == str(table.convention)
        assert data["units"] == {"length": "m", "angle": "rad"}
        for row, expected in zip(data["joints"], table.rows, strict=True):
            assert row.get("name", "") == expected.name
            if expected.origin is None:
                for key in ("theta", "d", "a", "alpha"):
                    assert float(row[key]) == getattr(expected, key)
            else:
                assert tuple(map(float, row["xyz"])) == expected.origin.xyz


@pytest.mark.parametrize("suffix", [".yaml", ".yml", ".toml", ".json", ".csv", ".tsv", ".md"])
def test_a_file_is_written_by_its_suffix(tmp_path: Path, suffix: str) -> None:
    """The suffix decides the format, both ways."""
    table = DHTable((DHRow(0.1, 0.2, 0.3, 0.4),), DHConvention.MODIFIED, name="arm")
    path = tmp_path / f"arm{suffix}"
    assert write_table(table, path, units=Units("mm", "deg")) == path
    assert read_table(path).table == table


def test_numbers_are_written_plainly() -> None:
    """No exponent where a person would not write one, and no trailing zeros."""
    table = DHTable((DHRow(math.pi / 2, 3.0, 0.1, 1e-7),), DHConvention.STANDARD)
    line = table_to_text(table, "csv").splitlines()[-1]
    assert line == "revolute,1.5707963267948966,3,0.1,1e-07"
    line = table_to_text(table, "csv", Units("mm", "deg")).splitlines()[-1]
    assert line == "revolute,90,3000,100,5.729577951308232e-6"


def test_unknown_formats_and_units_are_refused() -> None:
    """The message lists what is allowed."""
    table = DHTable((DHRow(),), DHConvention.STANDARD)
    with pytest.raises(TableError, match=r"format: expected 'yaml' or 'toml' .* got 'excel'"):
        table_to_text(table, "excel")
    with pytest.raises(TableError, match=r"units\.length: expected 'm' or .* got 'ft'"):
        table_to_text(table, "yaml", Units("ft", "deg"))
    with pytest.raises(TableError, match=r"units\.angle: expected 'rad' or 'deg', got 'm'"):
        table_to_text(table, "yaml", Units("m", "m"))


def test_plain_tuples_serve_as_units() -> None:
    """A pair of names is as good as `Units`."""
    table = DHTable((DHRow(0, 1, 0, 0),), DHConvention.STANDARD)
    assert table_to_text(table, "yaml", ("m", "rad")) == table_to_text(table, "yaml", SI)  # type: ignore[arg-type]
