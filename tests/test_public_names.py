"""What is public stays: names, and the parameters by which they are called.

``helpers/public_names.txt`` is what users were promised, a name and its parameters a line, kept by
hand; a line that leaves it is a removal, which docs/stability.md says how to announce.
"""

import inspect
import re
from enum import Enum
from pathlib import Path

import dh2urdf

TRANSFORMS = ("dh2urdf.transforms", "dh2urdf.poses")

HERE = Path(__file__).parent
RECORD = HERE / "helpers" / "public_names.txt"
README = (HERE.parent / "README.md").read_text(encoding="utf-8")


def public():
    """Each public name and what it is, with the parts of public classes."""
    listed = {name: getattr(dh2urdf, name) for name in dh2urdf.__all__}
    functions = {name: thing for name, thing in vars(dh2urdf.transforms).items() if
                 inspect.isfunction(thing) and thing.__module__ in TRANSFORMS}  # fmt: skip
    listed |= {f"transforms.{name}": thing for name, thing in functions.items()}
    for name, thing in listed.items():
        yield name, thing
        if inspect.isclass(thing) and not issubclass(thing, Exception | Enum):
            for part in dir(thing):
                yield f"{name}.{part}", getattr(thing, part)
        elif inspect.isclass(thing) and issubclass(thing, Enum):
            yield from ((f"{name}.{member.name}", member.value) for member in thing)


def parameters(thing):
    """Names by which what can be called is called."""
    if not callable(thing) or (inspect.isclass(thing) and issubclass(thing, Exception | Enum)):
        return []
    return list(inspect.signature(thing).parameters)


def surface():
    """Each public name with its parameters."""
    every = ((name, thing) for name, thing in public() if "._" not in f".{name}")
    return {name: parameters(thing) for name, thing in every}


def record():
    """What was recorded, in the same form."""
    lines = RECORD.read_text(encoding="utf-8").splitlines()
    return {words[0]: words[1:] for words in map(str.split, lines)}


def test_nothing_public_leaves_unannounced():
    """Every recorded name is there, with at least the recorded parameters, in their order."""
    now = surface()
    for name, parameters in record().items():
        assert name in now, name
        assert [p for p in now[name] if p in parameters] == parameters, name


def test_the_public_list_is_sorted_and_each_name_is_there():
    """``__all__`` names what ``dir`` names, in order, once."""
    assert sorted(set(dh2urdf.__all__)) == dh2urdf.__all__
    assert set(dh2urdf.__all__) <= set(dir(dh2urdf))
    assert all(hasattr(dh2urdf, name) for name in dh2urdf.__all__)


def test_the_readme_shows_public_names_only():
    """What the README writes behind ``dh2urdf.`` is public, or a module of the package."""
    package = Path(dh2urdf.__file__).parent
    modules = {path.stem for path in package.iterdir() if not path.name.startswith("_")}
    used = set(re.findall(r"\bdh2urdf\.([A-Za-z_]\w*)", README)) - {"git"}
    assert used <= {*dh2urdf.__all__, *modules}, used
    methods = set(re.findall(r"\b(?:robot|ur5|panda|puma)\.([a-z_]\w*)\(", README))
    assert methods
    assert all(hasattr(dh2urdf.Robot, name) for name in methods)
