"""`check` says beforehand what each consumer will make of a file, and the consumers agree."""

import logging
import warnings
from copy import deepcopy
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from lxml import etree
from urdf_faults import BODY, FAULTS, KEEP, SOUND, TOOL, arm, box, fixed, joint, mesh, write_meshes

import dh2urdf
from dh2urdf.checks import RULES, Consumer, Severity, Verdict, ask, ask_consumers, check_urdf
from dh2urdf.checks.probe import probe
from dh2urdf.checks.rounding import meant_angle
from dh2urdf.exceptions import UrdfError

HERE = (Consumer.PINOCCHIO, Consumer.CHECK_URDF, Consumer.YOURDFPY, Consumer.MUJOCO)
ELSEWHERE = (Consumer.PYBULLET, Consumer.DRAKE, Consumer.IKPY)
ORDER = (Verdict.ACCEPTS, Verdict.MISREADS, Verdict.COMPLAINS, Verdict.REFUSES)

ROBOTS = sorted((Path(pin.__file__).parents[4] / "share/example-robot-data").rglob("*.urdf"))

CASES = [
    pytest.param(rule, text, id=f"{rule}-{k}")
    for rule, texts in FAULTS.items()
    for k, text in enumerate(texts)
]
every_case = pytest.mark.parametrize(("rule", "text"), CASES)


@pytest.fixture
def urdf(written, tmp_path):
    """Write a URDF beside some meshes; its path."""
    write_meshes(tmp_path)
    return lambda text: written("arm.urdf", text)


def predicted(findings, consumer):
    """The worst that the findings say of a consumer; it accepts what they do not mention."""
    said = [e.verdict for f in findings for e in f.effects if consumer in e.consumers]
    worst = max(said, key=ORDER.index, default=Verdict.ACCEPTS)
    return Verdict.ACCEPTS if worst is Verdict.MISREADS else worst


def verdict_here(consumer, path, capfd, caplog):
    """What a consumer makes of a file, loaded in this process where it cannot harm it."""
    if consumer is Consumer.CHECK_URDF:
        return ask(consumer, path).verdict
    capfd.readouterr()
    caplog.clear()
    with warnings.catch_warnings(record=True) as caught, caplog.at_level(logging.WARNING):
        warnings.simplefilter("always")
        refused = probe(consumer, str(path))
    if refused:
        return Verdict.REFUSES
    said = caught or caplog.records or capfd.readouterr().err.strip()
    return Verdict.COMPLAINS if said else Verdict.ACCEPTS


def test_every_rule_has_a_file_that_breaks_it():
    """The table of rules and the table of faults name the same rules; each rule says what holds."""
    assert set(FAULTS) == set(RULES)
    assert all(rule.__doc__ for rule in RULES.values())


@every_case
def test_the_fault_is_found(rule, text, urdf):
    """The rule of a fault finds it, on a line of the file, says whom it concerns and the cure."""
    path = urdf(text)
    found = [f for f in check_urdf(path) if f.rule == rule]
    assert found
    lines = text.splitlines()
    for finding in found:
        tag = finding.element.split()[0].strip("<>")
        assert tag in "".join(lines[finding.line - 1 :])
        assert finding.message
        assert finding.mend
        assert finding.consumers


def test_sound_files_have_no_findings(urdf):
    """A sound arm, with and without frames, has none, and everyone here accepts it."""
    frame = TOOL.replace('"tool0"/>', '"tool0"><inertial><mass value="0"/><inertia ixx="0" '
        'ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>', 1)  # fmt: skip
    for text in (SOUND, arm(extra=KEEP + frame)):
        assert check_urdf(urdf(text)) == ()
        assert [ask(c, urdf(text)).verdict for c in HERE] == [Verdict.ACCEPTS] * 4


@pytest.mark.parametrize("name", dh2urdf.list_tables())
def test_own_files_have_no_findings(name, written):
    """What dh2urdf writes passes every rule; who moves its followers is told of each."""
    table = dh2urdf.load_table(name)
    path = written("arm.urdf", dh2urdf.urdf_text(table))
    followers = sum(row.mimic is not None for row in table.joints)
    assert [finding.rule for finding in check_urdf(path)] == ["mimic"] * followers


@pytest.mark.parametrize("consumer", HERE)
@every_case
def test_consumers_do_as_predicted(rule, text, consumer, urdf, capfd, caplog, monkeypatch):
    """Each consumer refuses, complains or accepts exactly as the findings say."""
    if rule == "joins-itself":
        monkeypatch.setattr(ask_consumers, "PATIENCE", 3.0)
    path = urdf(text)
    assert verdict_here(consumer, path, capfd, caplog) == predicted(check_urdf(path), consumer)


@pytest.mark.exhaustive
@pytest.mark.parametrize("consumer", HERE)
@pytest.mark.parametrize("path", ROBOTS, ids=[path.stem for path in ROBOTS])
def test_predictions_hold_for_real_robots(path, consumer):
    """Of every robot of example-robot-data, each consumer makes what the findings say."""
    assert ask(consumer, path).verdict == predicted(check_urdf(path), consumer)


@pytest.mark.exhaustive
@pytest.mark.parametrize("consumer", ELSEWHERE)
@every_case
def test_other_consumers_do_as_predicted(rule, text, consumer, urdf, monkeypatch):
    """The same of PyBullet, Drake and ikpy, each in a process of its own."""
    pytest.importorskip(ask_consumers.MODULES[consumer])
    if rule == "joins-itself":
        monkeypatch.setattr(ask_consumers, "PATIENCE", 10.0)
    path = urdf(text)
    assert ask(consumer, path).verdict == predicted(check_urdf(path), consumer)


def test_severity_is_that_of_the_worst_effect(urdf):
    """No mass: MuJoCo refuses, an error. Root with mass: KDL complains, a warning."""
    (finding,) = check_urdf(urdf(arm(fore="")))
    assert finding.severity is Severity.ERROR
    (finding,) = check_urdf(urdf(arm(base=BODY)))
    assert finding.severity is Severity.WARNING
    (finding,) = check_urdf(urdf(arm(elbow=joint(kind="continuous", limit=""))))
    assert finding.severity is Severity.ADVICE


def test_continuous_joints_have_two_numbers_in_pinocchio(urdf):
    """As the advice says: model.nq exceeds model.nv."""
    model = pin.buildModelFromUrdf(str(urdf(arm(elbow=joint(kind="continuous", limit="")))))
    assert (model.nq, model.nv) == (3, 2)


def test_mujoco_fuses_links_on_fixed_joints(urdf):
    """As the advice says: tool0 is gone, and stays where fusestatic is false."""
    import mujoco

    (text,) = FAULTS["fused-frames"]
    model = mujoco.MjModel.from_xml_path(str(urdf(text)))
    assert "tool0" not in {model.body(i).name for i in range(model.nbody)}
    model = mujoco.MjModel.from_xml_path(str(urdf(text.replace("</robot>", f"{KEEP}</robot>"))))
    assert "tool0" in {model.body(i).name for i in range(model.nbody)}


def pinocchio_moves(path):
    """Degrees of freedom without and with being asked to follow."""
    return [pin.buildModelFromUrdf(path, mimic=asked).nv for asked in (False, True)] == [2, 1]


def yourdfpy_moves(path):
    """Only the leader is a value, and the follower's link turns by both joints."""
    import yourdfpy

    robot = yourdfpy.URDF.load(path)
    robot.update_cfg([0.25])
    turned = np.arctan2(*robot.get_transform("fore", "upper")[[0, 0], [2, 0]])
    return robot.actuated_joint_names == ["shoulder"] and abs(turned - 0.25) < 1e-12


def mujoco_moves(path):
    """An equality of the follower and its leader, beside two numbers in qpos."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(path)
    new = tuple(map(int, mujoco.__version__.split(".")[:2])) >= (3, 13)
    return (model.nq, model.neq) == (2, int(new))


def pybullet_moves(path):
    """The follower stays when its leader is put somewhere else."""
    pybullet = pytest.importorskip("pybullet")
    client = pybullet.connect(pybullet.DIRECT)
    arm = pybullet.loadURDF(path, useFixedBase=True)
    pybullet.resetJointState(arm, 0, 0.25)
    state = pybullet.getJointState(arm, 1)[0]
    pybullet.disconnect(client)
    return state == 0


def drake_moves(path):
    """A constraint, with a discrete time step only."""
    parsing = pytest.importorskip("pydrake.multibody.parsing")
    plants = pytest.importorskip("pydrake.multibody.plant")
    plant = plants.MultibodyPlant(0.001)
    plant.set_discrete_contact_approximation(plants.DiscreteContactApproximation.kSap)
    parsing.Parser(plant).AddModels(path)
    plant.Finalize()
    return plant.num_constraints() == 1


def ikpy_moves(path):
    """The follower is a link of its own: with the leader turned, its link turns by that alone."""
    chains = pytest.importorskip("ikpy.chain")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        chain = chains.Chain.from_urdf_file(path, base_elements=["base_link"])
        T = chain.forward_kinematics([0, 0.25, 0])
    return abs(np.arctan2(T[1, 0], T[0, 0]) - 0.25) < 1e-9 and abs(T[2, 2] - 1) < 1e-12


@pytest.mark.parametrize("does", [pinocchio_moves, yourdfpy_moves, mujoco_moves])
def test_who_moves_a_follower_along(does, urdf):
    """As the advice says of Pinocchio, yourdfpy and MuJoCo."""
    (text,) = FAULTS["mimic"]
    assert does(str(urdf(text)))


@pytest.mark.exhaustive
@pytest.mark.parametrize("does", [pybullet_moves, drake_moves, ikpy_moves])
def test_who_else_moves_a_follower_along(does, urdf):
    """As the advice says of PyBullet, Drake and ikpy."""
    (text,) = FAULTS["mimic"]
    assert does(str(urdf(text)))


def test_frames_of_two_kinds_share_a_name_in_pinocchio(urdf):
    """As the advice says: getFrameId raises on a name that a link and a joint have."""
    (text,) = FAULTS["joint-named-as-link"]
    model = pin.buildModelFromUrdf(str(urdf(text)))
    with pytest.raises(ValueError, match="Several frames"):
        model.getFrameId("fore")


def test_bounds_left_out_read_as_zero_in_pinocchio(urdf):
    """As the warning says: the joint has nowhere to go."""
    (text,) = FAULTS["limit-without-bounds"]
    model = pin.buildModelFromUrdf(str(urdf(text)))
    k = model.joints[model.getJointId("elbow")].idx_q
    assert model.lowerPositionLimit[k] == model.upperPositionLimit[k] == 0


@pytest.mark.parametrize(
    ("word", "meant"),
    [
        ("1.5708", np.pi / 2),
        ("-1.5707", -np.pi / 2),
        ("1.57", np.pi / 2),
        ("3.1415927", np.pi),
        ("0.785398", np.pi / 4),
        ("0.2618", np.pi / 12),
        ("1.5707963267948966", None),
        ("1.570796327", None),
        ("1.57079633", None),
        ("0.26", None),
        ("1.58", None),
        ("0", None),
        ("0.0001", None),
        ("2", None),
        ("1.0", None),
    ],
)
def test_rounded_angles_are_told_from_others(word, meant):
    """A rounding of a multiple of 15 degrees is one; other numbers, and exact ones, are not."""
    found = meant_angle(word)
    assert found == (None if meant is None else pytest.approx(meant, abs=1e-15))


def test_cost_of_a_rounded_angle_is_measured(urdf):
    """An angle off by e turns the rest of the arm, 1 m long, about by 2 sin(e / 2) m."""
    tip = '<link name="tip"/>' + fixed("t", "fore", "tip").replace(
        "<parent", '<origin xyz="0 1 0"/><parent'
    )
    text = arm(elbow=joint(rpy="1.5708 0 0", kind="fixed", axis="", limit=""), extra=KEEP + tip)
    (finding,) = [f for f in check_urdf(urdf(text)) if f.rule == "rounded-angle"]
    assert "'tip' by up to 3.67 um" in finding.message
    assert "1.5707963267948966 0.0 0.0" in finding.mend


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "not XML"),
        ("\x00\x01", "not XML"),
        ("<robot>", "not XML"),
        ("<mujoco/>", "MJCF"),
        ("<sdf/>", "SDF"),
        ("<!DOCTYPE r [<!ENTITY a 'b'>]><robot name='&a;'/>", "DOCTYPE"),
    ],
)
def test_what_is_no_urdf_is_an_error_of_one_line(content, message, written):
    """Unreadable files raise UrdfError with the file's name."""
    path = written("arm.urdf", content)
    with pytest.raises(UrdfError, match=message) as caught:
        check_urdf(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_elements_in_odd_places_are_passed_over(urdf):
    """Numbers outside joints, inertials and shapes are nobody's, and no rule stumbles on them."""
    odd = '<origin xyz="-0.0 nan up"/><limit lower="x"/>'
    text = arm(upper=f"{BODY}{odd}", extra=f"{odd}<gazebo>{odd}</gazebo><!-- note --><?pi?>")
    assert {f.rule for f in check_urdf(urdf(text))} <= {"number", "not-finite"}


WORDS = ["", "nan", "-0", "1e400", "1 2", "0 0 0", "fore", "upper", "${x}", "revolute", "fixed"]
WORDS += ["ä b"]
RICH = arm(
    fore=BODY + box() + mesh("small.stl", "collision"),
    elbow=joint(extra='<mimic joint="shoulder"/><dynamics damping="0.1"/>', rpy="1.5708 0 0"),
    extra=KEEP + TOOL + '<material name="m"><color rgba="1 0 0 1"/></material>',
)


@settings(max_examples=200, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.tuples(st.integers(0, 10_000), st.sampled_from(WORDS)), max_size=6))
def test_no_damage_makes_a_rule_stumble(urdf, damage):
    """Whatever is dropped from a file, doubled or replaced, findings come and no exception."""
    root = etree.fromstring(RICH.encode())
    for where, word in damage:
        elements = list(root.iter(etree.Element))[1:]
        element = elements[where % len(elements)]
        keys = sorted(element.attrib)
        if word == "":
            element.getparent().remove(element)
        elif word == "fixed":
            element.addnext(deepcopy(element))
        elif keys:
            element.set(keys[where % len(keys)], word)
    findings = check_urdf(urdf(etree.tostring(root, encoding="unicode")))
    assert all(finding.mend for finding in findings)


def test_a_missing_file_is_an_error(tmp_path):
    """So is a folder."""
    for path in (tmp_path / "nowhere.urdf", tmp_path):
        with pytest.raises(UrdfError, match=str(path)):
            check_urdf(path)
