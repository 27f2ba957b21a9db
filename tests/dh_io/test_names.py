"""Arms that ship by the names that people type."""

import itertools

import pytest

import dh2urdf
from dh2urdf import list_tables, load_table
from dh2urdf.dh_io.names import _spelling, near_names, other_names
from dh2urdf.exceptions import NameNotFoundError

TYPED = {
    "panda": "franka_fer",
    "Panda": "franka_fer",
    "franka_emika_panda": "franka_fer",
    "fr3": "franka_fr3",
    "iiwa14": "kuka_iiwa14",
    "lbr_iiwa_14_r820": "kuka_iiwa14",
    "LBR iiwa 7 R800": "kuka_iiwa7",
    "kr6": "kuka_kr6_r700",
    "KR 6 R700": "kuka_kr6_r700",
    "irb120": "abb_irb120",
    "IRB-140": "abb_irb140",
    "crx10ia": "fanuc_crx10ia",
    "CRX-10iA": "fanuc_crx10ia",
    "UR-5e": "ur5e",
    "TX2-60": "staubli_tx2_60",
    "puma": "puma560",
    "gen3": "kinova_gen3",
    "SO-ARM100": "so100",
    "AR4-MK3": "ar4",
}


@pytest.mark.parametrize("typed", TYPED)
def test_an_arm_is_found_by_what_people_call_it(typed):
    """The same table as by its own name, its name included."""
    assert load_table(typed) == load_table(TYPED[typed])
    assert dh2urdf.Robot.from_dh(typed).table == load_table(TYPED[typed])


def test_no_name_is_that_of_two_arms():
    """Every spelling of every name leads to its table only."""
    names = [(also, name) for name in list_tables() for also in (name, *other_names(name))]
    for (one, _), (two, _) in itertools.combinations(names, 2):
        assert _spelling(one) != _spelling(two)
    assert all(load_table(also) == load_table(name) for also, name in names)


@pytest.mark.parametrize(
    ("typed", "meant"),
    [("pandda", "panda"), ("iiwa", "iiwa7 or iiwa14"), ("kr6_r70", "kr6_r700"), ("ur6", "ur")],
)
def test_a_slip_names_what_was_meant(typed, meant):
    """Other names are among those that are near."""
    with pytest.raises(NameNotFoundError, match=f"did you mean .*{meant}"):
        load_table(typed)


def test_nothing_near_names_the_list():
    """No guess where nothing is like it."""
    assert near_names("qwertzuiop") == []
    with pytest.raises(NameNotFoundError, match="`dh2urdf list` names them"):
        load_table("qwertzuiop")


def test_a_file_goes_before_another_name(tmp_path, monkeypatch):
    """A file called panda is that file, whatever it holds."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "panda").write_text("nothing")
    with pytest.raises(dh2urdf.Dh2UrdfError, match="not a table file by its name"):
        load_table("panda")
