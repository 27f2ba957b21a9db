"""``dh2urdf compare`` as a student, a teacher and an integrator meet it."""

import json

import pytest
from example_robots import UR5
from mistaken import with_row

import dh2urdf


@pytest.fixture
def homework(run, tmp_path):
    """Files of the Puma: right, with the sign of an alpha, and with its zeros elsewhere."""
    table = dh2urdf.load_table("puma560")
    dh2urdf.save_table(table, tmp_path / "right.yaml")
    dh2urdf.save_table(with_row(table, 2, a=-table.rows[2].a), tmp_path / "sign.yaml")
    dh2urdf.save_table(with_row(table, 1, theta=0.5), tmp_path / "zero.yaml")
    return run


def test_exit_status_and_words(homework):
    """0 and one line for the same arm, 1 and the row for another; stderr stays empty."""
    status, out, err = homework("compare", "puma560", "right.yaml")
    assert (status, err, out.count("\n")) == (0, "", 1)
    assert out.startswith("puma560 and right.yaml: the same arm (largest difference ")
    status, out, err = homework("compare", "puma560", "sign.yaml")
    assert (status, err) == (1, "")
    assert "  row 3: a 0.0203 m in A, " in out
    assert "B reads as A with a mistake: row 3: a has the other sign" in out


def test_zeros_are_free_unless_exactly_the_same_is_asked_for(homework):
    """The same arm up to a zero is 0, with --exact 1; the zero is printed both times."""
    for more, expected in (([], 0), (["--exact"], 1)):
        status, out, _ = homework("compare", "puma560", "zero.yaml", *more)
        assert status == expected
        assert "zero of joint 2: q2 of B = q2 of A" in out


def test_many_are_compared_with_the_first(homework):
    """Each in turn, one that cannot be read too; status 2, and the count on stderr."""
    names = ["right.yaml", "nowhere.yaml", "sign.yaml", "zero.yaml"]
    status, out, err = homework("compare", "puma560", *names)
    assert status == 2
    assert [line.split(":")[0] for line in out.splitlines() if line[0] != " "] == [
        f"puma560 and {name}" for name in names if name != "nowhere.yaml"
    ]
    assert "dh2urdf: nowhere.yaml: " in err
    assert "2 of 4 are the same arm as puma560" in err
    assert homework("compare", "puma560", "right.yaml", "zero.yaml")[0] == 0


def test_json_is_one_object_with_numbers_in_metres_and_radians(homework):
    """Every field of the result, of arms that differ in the number of joints as well."""
    status, out, _ = homework("compare", "puma560", "sign.yaml", "planar_rr", "--json")
    data = json.loads(out)
    assert (status, data["verb"], data["failed"]) == (1, "compare", [])
    sign, planar = data["results"]
    assert (sign["a"], sign["b"], sign["same"]) == ("puma560", "sign.yaml", False)
    assert sign["mistakes"][0]["rows"] == [3]
    assert [(d["row"], d["quantity"], d["b"]) for d in sign["differences"]] == [(3, "a", -0.0203)]
    assert (planar["max_error"], planar["base"], planar["directions"]) == (None, None, None)
    assert planar["differences"][0]["a"] == "RRRRRR"


def test_a_vendors_file_is_compared_with_the_data_sheet(homework):
    """A URDF on either side, between links that are named."""
    links = ["--base", "base", "--tip", "tool0"]
    for argv in (["ur5", str(UR5)], [str(UR5), "ur5"]):
        status, out, _ = homework("compare", *argv, *links)
        assert (status, out.count("\n")) == (0, 1)
    assert homework("compare", "ur5e", str(UR5))[0] == 1


def test_a_wrong_call_is_told_in_one_message(homework, refused):
    """No second arm, a tolerance beyond its bounds, a table without a convention."""
    assert "name one or more arms" in refused("compare", "ur5")
    assert "tolerance: expected a number from 1e-12 to 0.1" in refused(
        "compare", "ur5", "ur5", "--tolerance", "3"
    )
    assert "nowhere.yaml" in refused("compare", "nowhere.yaml", "ur5")
