"""Names and sources that are code: whatever is written quotes them by the rules of its language."""

import ast
import io
import json
import re
import tokenize
from html.parser import HTMLParser

import pytest
from hostile import hostile, outcome
from hypothesis import strategies as st
from lxml import etree
from markdown_it import MarkdownIt

import dh2urdf
from dh2urdf import DHRow, DHTable, JointType, Origin
from dh2urdf.conversions.write import verified_mjcf
from dh2urdf.conversions.write.constructors import CONSTRUCTORS
from dh2urdf.conversions.write.urdf_file import verified_urdf
from dh2urdf.dh_io import parse_table, table_to_text
from dh2urdf.dh_io.xml import embedded_table
from dh2urdf.exceptions import TableError

CODE = [
    "r\nimport os; os.system('touch X') #",
    "coding: utf-7 +AAo-import os",
    *("'; system('touch X'); '", "\\input{/etc/passwd}", "\\end{tabular}\\write18{touch X}"),
    *("$\\frac$", "<script>alert(1)</script>", "[x](javascript:alert(1))", "![x](y)", "` | `\n|-|"),
    *("--><robot/>", "]]></dh2urdf>", "&amp;&#10;", "{{x}} %{ %} ...", "a: b # c", "- [x]"),
    *("https://x.y www.x.y x@y.z", "**x** _y_ ~~z~~ $z$", '"""\n', "=cmd|' /C calc'!A0"),
    *("universe", "base_link", "tool0"),
]
PARTS = st.sampled_from(
    [*CODE, "'", '"', "\\", "\n", "\r", "\r\n", "\0", "\x0c", "\x1b[2J", "\x85", "\u2028"]
)
NAMES = st.one_of(
    st.lists(PARTS | st.text(max_size=3), min_size=1, max_size=4).map("".join),
    st.text(min_size=1, max_size=20),
).filter(bool)
SLIDE = DHRow(d=0.1, joint_type=JointType.PRISMATIC, sign=-1)


def table_of(name, source="", *, fixed=False):
    """An arm whose name, joint and source are hostile."""
    rows = [DHRow(a=0.5, theta=0.1, name=name, lower=-1.0, upper=1.0), SLIDE]
    if fixed:
        rows.append(DHRow(joint_type=JointType.FIXED, origin=Origin((0.1, 0, 0))))
    return DHTable(tuple(rows), "standard", name=name, source=source, checked=source)


def shown(name):
    """A name as a cell in one line has it."""
    return "".join(c if c.isprintable() else " " for c in name).strip()


@hostile(name=NAMES, source=NAMES, fixed=st.booleans())
def test_written_python_makes_a_robot_and_nothing_else(name, source, fixed):
    """The Python is two imports and the robot, whose name is the table's, in UTF-8."""
    text = CONSTRUCTORS["rtb"](table_of(name, source, fixed=fixed))
    assert tokenize.detect_encoding(io.BytesIO(text.encode()).readline)[0] == "utf-8"
    first, second, *made = ast.parse(text).body
    assert isinstance(first, ast.Import)
    assert isinstance(second, ast.ImportFrom)
    assert [type(statement) for statement in made] == [ast.Assign] * (2 if fixed else 1)
    assert made[-1].targets[0].id == "robot"
    calls = [node.func for node in ast.walk(made[0]) if isinstance(node, ast.Call)]
    assert all(ast.unparse(call).startswith(("rtb.", "SE3")) for call in calls)
    keywords = {keyword.arg: keyword.value for keyword in made[-1].value.keywords}
    assert ast.literal_eval(keywords["name"]) == name


LITERAL = re.compile(r"'((?:[^'\n]|'')*)'|char\(\[([\d, ]+)\]\)")
STATEMENTS = re.compile(
    r"(L\(\d+\) = Link\(|robot = SerialLink\(L, |robot = rigidBodyTree\(|body = rigidBody\(|"
    r"jnt = rigidBodyJoint\(|setFixedTransform\(jnt, |jnt\.JointAxis = |jnt\.PositionLimits = |"
    r"body\.Joint = jnt|addBody\(robot, body, )[^'\n;%!]*(S[^'\n;%!]*)*;$"
)


def evaluated(match):
    """Text of a literal of MATLAB."""
    if match[2] is None:
        return match[1].replace("''", "'")
    units = [int(code) for code in match[2].split(",")]
    return b"".join(unit.to_bytes(2, "big") for unit in units).decode("utf-16-be")


def matlab(format):
    """The property that every line is a comment or a statement of the format, with the name."""

    @hostile(name=NAMES, source=NAMES)
    def test(name, source):
        text = CONSTRUCTORS[format](table_of(name, source))
        assert not re.search(r"[\r\x0b\x0c\x85\u2028\u2029\0]", text)
        named = []
        for line in text.rstrip("\n").split("\n"):
            if line.startswith("% "):
                continue
            plain = LITERAL.sub("S", line)
            assert STATEMENTS.match(plain.replace("; ", ", ")), line
            words = "".join(map(evaluated, LITERAL.finditer(line)))
            named += [words] if plain.startswith(("robot = Serial", "body = rigidBody(")) else []
        assert any(word in (name, f"name{name}") for word in named)

    return test


test_written_matlab_makes_a_serial_link_and_nothing_else = matlab("matlab")
test_written_matlab_makes_a_tree_and_nothing_else = matlab("matlab-rst")


SPECIAL = {"\\textbackslash{}": "\\", "\\textasciicircum{}": "^", "\\textasciitilde{}": "~"}
SPECIAL |= {"\\textless{}": "<", "\\textgreater{}": ">", "\\textbar{}": "|"}
SPECIAL |= {f"\\{c}": c for c in "{}$&#%_"}
LATEX = re.compile("|".join(map(re.escape, SPECIAL)) + r"|[^\\{}$&#%_^~<>|]", re.DOTALL)


@hostile(name=NAMES)
def test_written_latex_shows_the_name(name):
    """The cell is the name, each of its special characters as the command that shows it."""
    lines = table_of(name).to_latex().split("\n")
    heads = ["\\beg", "\\cen", "\\cap", "\\beg", "\\top", "$i$ ", "\\mid", "1 & ", "2 & "]
    assert [line[:4] for line in lines] == [*heads, "\\bot", "\\end", "", "\\end"]
    cell = re.split(r"(?<!\\) & ", lines[7])[1]
    out, at = "", 0
    while at < len(cell):
        match = LATEX.match(cell, at)
        assert match, cell[at:]
        out, at = out + SPECIAL.get(match[0], match[0]), match.end()
    assert out == shown(name)


def cells_of(markdown):
    """Tokens inside the cells of a rendered Markdown table, row by row, html and links on."""
    page = MarkdownIt("commonmark", {"html": True}).enable(["table", "strikethrough"])
    tokens = page.parse(markdown)
    assert {"html_block", "fence", "code_block"} & {token.type for token in tokens} == set()
    return [token.children for token in tokens if token.type == "inline"]


class Tags(HTMLParser):
    """Tags of a page, and its texts."""

    def __init__(self, page):
        super().__init__()
        self.tags, self.texts = [], []
        self.feed(page)

    def handle_starttag(self, tag, attrs):
        """A tag and the names of its attributes."""
        self.tags.append((tag, *sorted(key for key, _ in attrs)))

    def handle_data(self, data):
        """A text, its entities resolved."""
        self.texts.append(data)


@hostile(name=NAMES)
def test_written_html_shows_the_name(name):
    """The page of a hostile arm has the tags of a harmless one, and the name as text."""
    page = Tags(table_of(name)._repr_html_())
    assert page.tags == Tags(table_of("joint")._repr_html_()).tags
    if shown(name):
        assert shown(name) in page.texts


@hostile(name=NAMES, source=NAMES)
def test_a_written_mjcf_holds_the_name_or_is_refused(name, source):
    """MuJoCo reads each joint by its name, and the file gives the table back; or XML forbids it."""
    table = table_of(name, source)
    made = outcome(verified_mjcf, table)
    if isinstance(made, TableError):
        assert "XML forbids" in str(made) or "taken by another joint" in str(made)
        return
    text, error, _ = made
    assert error < 1e-12
    assert embedded_table(io.BytesIO(text.encode())) == table


@hostile(
    name=NAMES,
    source=NAMES,
    format=st.sampled_from(["yaml", "toml", "json", "csv", "tsv", "markdown"]),
)
def test_written_tables_are_read_back_and_render_as_text(name, source, format):
    """A table file gives the same name back; as a Markdown page it has no markup of its own."""
    table = table_of(name, source)
    text = table_to_text(table, format)
    assert parse_table(text, format).table == table
    if format == "json":
        assert json.loads(text)["name"] == name
    if format == "markdown":
        kinds = {token.type for cell in cells_of(text.split("---\n\n")[1]) for token in cell or []}
        assert kinds <= {"text", "text_special"}


def test_a_joint_is_not_called_like_pinocchio_s_world():
    """``universe`` is the joint that Pinocchio begins with; another of that name is refused."""
    table = DHTable((DHRow(a=1.0, name="universe"),), "standard")
    with pytest.raises(TableError, match="'universe' is taken"):
        dh2urdf.Robot.from_dh(table)


@hostile(name=NAMES, source=NAMES)
def test_a_written_urdf_has_the_name_or_is_refused(name, source):
    """The file holds the name and the table, or the name holds what XML forbids."""
    table = table_of(name, source)
    got = outcome(verified_urdf, table)
    if isinstance(got, TableError):
        assert "XML forbids" in str(got) or name == "universe"
        assert name == "universe" or re.search("[^\t\n\r\x20-\ufffd\U00010000-\U0010ffff]", name)
        return
    root = etree.fromstring(got[0].encode())
    assert root.get("name") == name
    assert root.find("joint").get("name") == name
    assert parse_table(root.findtext("dh2urdf"), "json").table == table


@pytest.mark.parametrize(
    "format", ["rtb", "matlab", "matlab-rst", "latex", "yaml", "toml", "json", "csv", "markdown"]
)
def test_code_in_a_urdf_stays_a_name(format, tmp_path, run):
    """A robot whose name is a line of Python is extracted in every format, and runs in none."""
    name = "r\nimport os; os.system('touch X') #"
    dh2urdf.write_urdf(table_of(name, name), "r.urdf")
    assert embedded_table("r.urdf").name == name
    for more in ([], ["--no-embedded"]):
        assert run("extract", "r.urdf", "--format", format, "-o", "x.txt", "--force", *more)[0] == 0
        text = (tmp_path / "x.txt").read_text()
        assert not any(line.startswith(("import os", "os.")) for line in text.splitlines())
        if format == "rtb":
            assert all(not isinstance(s, ast.Expr) for s in ast.parse(text).body)


@pytest.mark.parametrize(
    "name", ["$\\frac$ {x}", "\u673a \U0001f600", "a\nb\tc", "$x$", "<b>&\x85"]
)
def test_a_figure_shows_the_name(name):
    """A name in a figure is text: no formula, no missing sign, no markup in the SVG."""
    pytest.importorskip("matplotlib")
    from dh2urdf.figures.style import picture_bytes
    from dh2urdf.figures.workspaces.workspace import workspace_figure

    robot = dh2urdf.Robot.from_dh(
        DHTable((DHRow(a=0.4, name=name), DHRow(a=0.3)), "standard", name)
    )
    for picture in (robot.figure(), workspace_figure(robot)):
        tree = etree.fromstring(picture_bytes(picture, "svg"))
        texts = ["".join(element.itertext()) for element in tree.iter("{*}text")]
        start = shown(name)[0]
        assert any(start in text or "\N{WHITE SQUARE}" in text for text in texts)


@pytest.mark.parametrize("format", ["yaml", "toml", "json", "csv", "markdown"])
def test_a_joint_called_like_a_missing_cell_keeps_its_name(format):
    """``n/a`` is a name where it is quoted."""
    table = table_of("n/a", "n/a")
    assert parse_table(table_to_text(table, format), format).table == table
