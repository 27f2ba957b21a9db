"""Robot descriptions with a shape: whole files of which some parts are wrong in kind or value."""

import copy
import random
from pathlib import Path

from hypothesis import strategies as st
from lxml import etree

TEXTS = [
    *("", " ", "0", "1", "-1", "nan", "inf", "-inf", "1e308", "-1e308", "1e400", "1e-400", "1e30"),
    *("0x10", "1_0", "1,0", "${1}", "9" * 400, "\u0661", "0 0", "0 0 0", "0 0 1", "1 1e308 0"),
    *("nan 0 1", "1e-200 0 0", "1e308 1e308 1e308", "0 0 1 1", "\ud7ff", "\uffe9", "a\nb", "<"),
    *("revolute", "fixed", "prismatic", "continuous", "floating", "planar", "spherical", "hinge"),
    *("link_1", "base_link", "tool0", "joint_1", "x" * 3000, "\u202e", "http://[", "package://"),
    "file:///dev/zero",
]


FILES = sorted(Path(__file__).parents[2].glob("urdf/*.urdf"))
KEPT = [etree.parse(str(path)).getroot() for path in FILES[:: max(1, len(FILES) // 8)]]


def mutated(seed):
    """A file of this package, or of a maker, with a few of its parts changed for the worse."""
    rng = random.Random(seed)
    root = copy.deepcopy(rng.choice(KEPT))
    for element in list(root):
        if element.tag in ("dh2urdf", "material") or not isinstance(element.tag, str):
            root.remove(element)
    for _ in range(rng.choice([1, 1, 2, 5, 20])):
        elements = list(root.iter(etree.Element))
        element = rng.choice(elements)
        kind = rng.randrange(7)
        if kind <= 2 and element.attrib:
            element.set(rng.choice(list(element.attrib)), rng.choice(TEXTS))
        elif kind == 3 and element.attrib:
            del element.attrib[rng.choice(list(element.attrib))]
        elif kind == 4 and element is not root:
            element.getparent().remove(element)
        elif kind == 5 and element is not root:
            rng.choice(elements).append(copy.deepcopy(element))
        elif kind == 6:
            element.tag = rng.choice(["link", "joint", "origin", "axis", "limit", "mimic", "x"])
    return etree.tostring(root)


NUMBERS = st.one_of(
    st.sampled_from([0, 1, -1, 1e308, -1e308, 1e-300, 10**400, -(10**17), 1e9, 1e9 + 1]),
    st.floats(),
    st.floats(-2, 2),
)
values = st.recursive(
    st.one_of(st.none(), st.booleans(), NUMBERS, st.sampled_from(TEXTS)),
    lambda inner: st.one_of(
        st.lists(inner, max_size=6), st.dictionaries(st.sampled_from(TEXTS), inner, max_size=3)
    ),
    max_leaves=20,
)
triples = st.one_of(st.lists(NUMBERS, min_size=3, max_size=3), values)
entries = st.fixed_dictionaries(
    {"axis": triples},
    optional={"point": triples, "type": st.sampled_from(["R", "P", "x", None, 3]), "name": values},
)
screws = st.lists(st.lists(NUMBERS, min_size=6, max_size=6), max_size=4) | values
tools = st.fixed_dictionaries({}, optional={"xyz": triples, "rpy": triples}) | values
contents = values | st.fixed_dictionaries(
    {},
    optional={
        "axes": st.lists(entries, max_size=5) | values,
        **{"screws": screws, "frames": values, "tool": tools, "names": values, "name": values},
        "types": st.sampled_from(["R", "RP", "RRR"]) | values,
    },
)


def as_yaml(value):
    """JSON is YAML; numbers that JSON has not are written as YAML has them."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{as_yaml(k)}: {as_yaml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(as_yaml, value)) + "]"
    if isinstance(value, str):
        return "'" + value.replace("'", "''").replace("\n", " ") + "'"
    if value is None or isinstance(value, bool):
        return str(value).lower().replace("none", "null")
    return str(value).replace("nan", ".nan").replace("inf", ".inf")


XACRO = (
    "<robot name='r' xmlns:xacro='http://ros.org/wiki/xacro'>{}<link name='a'/><link name='b'/>"
    "<joint name='j' type='revolute'><parent link='a'/><child link='b'/><origin xyz='0 0 {}'/>"
    "<axis xyz='{}'/><limit lower='{}' upper='1' effort='1' velocity='1'/></joint></robot>"
)
TERMS = [
    *("1", "0.5", "pi", "h", "nope", "h.x", '""', "[1]", "{}", "1/0", "sin(1)", "-", "None"),
    *("9**9", '"a"*9', "__import__", "().__class__", "lambda: 1", "range(9)", 'load_yaml("x")'),
]
TERM = st.lists(st.sampled_from(TERMS), min_size=1, max_size=3).map(" + ".join)
COMPUTED = st.one_of(TERM.map("${{{}}}".format), TERM.map("$(eval {})".format))
PLAIN = st.sampled_from(
    [t for t in TEXTS if "<" not in t] + ["$(arg x)", "$(find x)", "${", "$(", "$$"]
)
VALUE = st.one_of(COMPUTED, PLAIN)
EXTRAS = [
    *("<xacro:property name='h' value='{}'/>", "<xacro:arg name='x' default='{}'/>", "<xacro:h/>"),
    *("<xacro:if value='{}'><link name='c'/></xacro:if>", "<xacro:include filename='{}'/>"),
    *("<xacro:macro name='m' params='p:={}'/>", "<xacro:m p='{}'/>"),
    "<xacro:insert_block name='{}'/>",
]
EXTRA = st.lists(st.tuples(st.sampled_from(EXTRAS), VALUE), max_size=3)


def computed(extra, z, axis, lower):
    """A xacro with values of every kind where it evaluates them."""
    body = "".join(what.replace("{}", value) for what, value in extra)
    return XACRO.format(body, z, axis, lower).encode(errors="replace")


URDFS = st.integers(0, 10**9).map(mutated)
XACROS = st.builds(computed, EXTRA, VALUE, VALUE, VALUE)
AXES = contents.map(as_yaml).map(lambda text: text.encode(errors="replace"))
