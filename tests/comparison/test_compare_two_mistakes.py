"""`compare` of tables with two mistakes: nothing that differs is kept quiet."""

import json
from dataclasses import replace
from functools import reduce

import numpy as np
import pytest
from mistaken import KINDS, mistake, rewritten, with_row

import dh2urdf
from dh2urdf.comparison.cells import Cell, with_cell
from dh2urdf.conversions.assign import chain_to_dh
from dh2urdf.conversions.write import dh_to_chain

GENERAL = """\
name: general
convention: standard
units: {length: mm, angle: deg}
joints:
  - {theta: theta_1 + 10, d: 400, a: 25, alpha: -90}
  - {theta: theta_2 - 90, d: 15, a: 455, alpha: 0}
  - {theta: -theta_3, d: 7, a: 35, alpha: 90}
  - {theta: theta_4, d: -420, a: 0, alpha: -90}
  - {theta: theta_5, d: 3, a: 5, alpha: 90.5}
  - {theta: theta_6 + 180, d: -80, a: 0, alpha: 180}
"""

EDITS = {
    "a row and the sign of an angle near 90": {"a: 455": "a: 445", "alpha: 90.5": "alpha: -90.5"},
    "a row and the sign of an angle": {
        "a: 455": "a: 445",
        "-90}\n  - {theta: theta_5": "60}\n  - {theta: theta_5",
    },
    "two rows and a sign": {"a: 455": "a: 300", "d: 7": "d: 70", "alpha: 90.5": "alpha: -90.5"},
    "a row and a sign that zeros take back": {"a: 455": "a: 445", "alpha: 180": "alpha: -90"},
    "two signs": {"a: 455": "a: -455", "alpha: 90.5": "alpha: -90.5"},
    "a row and a zero": {"a: 455": "a: 445", "theta_6 + 180": "theta_6 + 90"},
    "a sign and a zero": {"alpha: 90.5": "alpha: -90.5", "theta_2 - 90": "theta_2"},
    "a row and a kind of joint": {
        "a: 455": "a: 445",
        "theta: theta_4, d: -420": "theta: 0, d: d_4",
    },
}


def general(folder):
    """The table, from ``right.yaml`` in a folder."""
    (folder / "right.yaml").write_text(GENERAL)
    return dh2urdf.load_table(folder / "right.yaml")


def rows_that_differ(a, b):
    """Rows of texts that differ, counted from 1."""
    lines = [text.splitlines()[4:] for text in (a, b)]
    return {i for i, (r, s) in enumerate(zip(*lines, strict=True), 1) if r != s}


@pytest.mark.parametrize("edits", EDITS.values(), ids=EDITS)
def test_every_row_that_differs_is_listed_with_the_numbers_of_the_files(edits, run, tmp_path):
    """With and without --exact and in JSON, each as the files have it."""
    wrong = reduce(lambda text, edit: text.replace(*edit), edits.items(), GENERAL)
    (tmp_path / "right.yaml").write_text(GENERAL)
    (tmp_path / "wrong.yaml").write_text(wrong)
    status, out, _ = run("compare", "right.yaml", "wrong.yaml", "--json")
    told = json.loads(out)["results"][0]["differences"]
    assert status == 1
    assert {one["row"] for one in told} == rows_that_differ(GENERAL, wrong)
    tables = [dh2urdf.load_table(tmp_path / name) for name in ("right.yaml", "wrong.yaml")]
    for one in told:
        rows = [table.rows[one["row"] - 1] for table in tables]
        key = {"type": "joint_type"}.get(one["quantity"], one["quantity"])
        assert [one["a"], one["b"]] == [getattr(row, key) for row in rows]
        assert not one["rewritten"]
    texts = [run("compare", "right.yaml", "wrong.yaml", *more)[1] for more in ([], ["--exact"])]
    assert texts[0] == texts[1]
    assert all(f"row {i}: " in texts[0] for i in rows_that_differ(GENERAL, wrong))


def test_two_mistakes_were_both_made(tmp_path):
    """Joined by "and"; "or" is for those that come to the same."""
    a = general(tmp_path)
    b = with_row(with_row(a, 1, a=-a.rows[1].a), 4, alpha=-a.rows[4].alpha)
    text = "row 2: a has the other sign and row 5: alpha has the other sign"
    assert text in str(dh2urdf.compare(a, b))


def twice_mistaken(count, seed):
    """Shipped tables with two mistakes that leave the number of rows as it is."""
    rng = np.random.default_rng(seed)
    while count:
        table = dh2urdf.load_table(str(rng.choice(dh2urdf.list_tables())))
        wrong = table
        for kind in rng.choice(KINDS, 2, replace=False):
            made = mistake(wrong, str(kind), rng)
            wrong = made[0] if made else wrong
        if len(wrong.rows) == len(table.rows) and wrong != table:
            count -= 1
            yield table, wrong


def test_with_what_is_told_put_right_the_arms_are_the_same():
    """Of a hundred tables with two mistakes, each cell told is put into A, which then is B."""
    told = 0
    for table, wrong in twice_mistaken(100, seed=7):
        found = dh2urdf.compare(table, wrong)
        if found.same or any(d.rewritten or d.quantity == "joints" for d in found.differences):
            continue
        told += 1
        cells = (Cell(d.row, d.quantity, d.a, d.b) for d in found.differences)
        assert dh2urdf.compare(reduce(with_cell, cells, table), wrong).same, str(found)
    assert told > 50


def test_numbers_of_neither_file_are_said_to_be_so():
    """Of tables of other frames on other axes, lines tell that both were rewritten."""
    rng, told = np.random.default_rng(2), 0
    for name in ("puma560", "kuka_kr6_r700", "staubli_tx2_60"):
        a = dh2urdf.load_table(name)
        wrong = replace(a, rows=tuple(replace(r, a=r.a * 1.1, d=r.d * 1.2) for r in a.rows))
        b = chain_to_dh(rewritten(dh_to_chain(wrong), rng, base=True, directions=True)).table
        found = dh2urdf.compare(a, b)
        numbers = {round(abs(v), 9) for r in (*a.rows, *b.rows) for v in (r.a, r.d)}
        for one in found.differences:
            told += one.rewritten
            assert one.rewritten == ("(both rewritten in the same frames)" in str(one))
            if not one.rewritten and one.quantity in ("a", "d"):
                assert {round(abs(v), 9) for v in (one.a, one.b)} <= numbers
    assert told


def test_exact_says_different_of_an_arm_that_is_the_same_up_to_something(run, tmp_path):
    """The first line says what the status says."""
    table = general(tmp_path)
    dh2urdf.save_table(with_row(table, 1, theta=0.5), tmp_path / "zero.yaml")
    status, out, _ = run("compare", "right.yaml", "zero.yaml", "--exact")
    first, second = out.splitlines()[:2]
    assert status == 1
    assert first == "right.yaml and zero.yaml: different with --exact, the same arm only up to"
    assert "zero of joint 2" in second
    status, out, _ = run("compare", "right.yaml", "right.yaml", "--exact")
    assert status == 0
    assert "the same arm (" in out
