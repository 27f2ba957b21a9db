"""xacro as makers ship it, without ROS: arguments, packages, and what an argument may be.

What runs is the package xacro in a process of its own (`apart`): its expressions are held to
arithmetic there, and time and memory are bounded.
"""

import glob
import os
import re
from collections.abc import Iterable, Mapping
from html import unescape
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

from dh2urdf.bounds import CELL_CHARACTERS, ROBOT_BYTES, XACRO_ARGS
from dh2urdf.conversions.read.packages import find_package, package_of
from dh2urdf.dh_io.cells.schema import did_you_mean
from dh2urdf.doors import found
from dh2urdf.exceptions import ArgumentError, Dh2UrdfError, UrdfError

_FIND = re.compile(r"\$\(find\s+([\w.-]+)\s*\)")
_DECLARED = re.compile(r"<xacro:arg\b[^>]*?\bname\s*=\s*[\"']([^\"']+)[\"']")
_USED = re.compile(r"\$\(arg\s+([\w.-]+)\s*\)")
_SHOWN = 12
_ABOVE = 4
"""Folders above a xacro in which the parts of a package of another name are looked for."""

_FILES = 200
"""xacro files of a package in which values of an argument are looked for."""


class Xacro(NamedTuple):
    """What a xacro is given: arguments by name, folders of packages by name."""

    args: dict[str, str]
    packages: dict[str, str]


NOTHING = Xacro({}, {})


def xacro_given(
    xacro_args: Mapping[str, object] | None, packages: Mapping[str, str | os.PathLike[str]] | None
) -> Xacro:
    """Arguments and packages, checked: texts, numbers and truths; folders that are there."""
    return Xacro(_texts(xacro_args, "xacro_args"), _texts(packages, "packages"))


def _texts(values: Mapping[str, object] | None, what: str) -> dict[str, str]:
    if values is None:
        return {}
    if not isinstance(values, Mapping) or len(values) > XACRO_ARGS:
        raise ArgumentError(f"{what}: expected at most {XACRO_ARGS} names, got {found(values)}")
    out: dict[str, str] = {}
    for name, value in values.items():
        text = os.fspath(value) if isinstance(value, os.PathLike) else value
        text = str(text).casefold() if isinstance(text, bool) else text
        if not isinstance(name, str) or not isinstance(text, str | int | float):
            raise ArgumentError(f"{what}: expected a text, got {found(value)} for {found(name)}")
        if len(str(text)) > 10 * CELL_CHARACTERS:
            raise ArgumentError(f"{what}: {found(name)}: over {10 * CELL_CHARACTERS} characters")
        out[name] = str(text)
    return out


def expand(source: str, given: Xacro) -> str:
    """Text of the URDF that a xacro stands for; called in a process of its own."""
    import xacro
    from xacro import substitution_args

    def find(name: str) -> str:
        try:
            return str(find_package(name, Path(source), given.packages))
        except UrdfError as error:
            raise UrdfError(f"{error}{seen.perhaps(name)}") from None

    def named(spec: str) -> str:
        scheme, mark, rest = spec.partition("://")
        if mark and scheme == "package":
            name, _, inside = rest.lstrip("/").partition("/")
            return os.path.join(find(name), inside)
        return str(absolute(rest if mark and scheme == "file" else spec))

    absolute = xacro.abs_filename_spec
    xacro.abs_filename_spec = named
    substitution_args._eval_find = substitution_args._eval_dict["find"] = find
    seen = _Files(Path(source), given)
    try:
        args = {**seen.defaults_of_the_root(), **given.args}
        text = str(xacro.process_file(source, mappings=args).toprettyxml(indent="  "))
    except Exception as error:
        if (why := seen.explain(error, xacro)) is None:
            raise
        raise Dh2UrdfError(why) from None
    seen.refuse_unknown(xacro)
    return text


class _Files:
    """The texts of a xacro and of those in its package, and what its arguments may be."""

    def __init__(self, source: Path, given: Xacro) -> None:
        self.source, self.given = source, given

    def defaults_of_the_root(self) -> dict[str, str]:
        """Defaults of arguments that ``<robot name="$(arg name)">`` uses before their lines."""
        text = _read(self.source)
        head = re.search(r"<robot\b[^>]*>", text)
        used = set(_USED.findall(head[0])) if head else set()
        given = re.findall(r"<xacro:arg\s+name=\"([^\"]+)\"\s+default=\"([^\"$]*)\"", text)
        return {name: unescape(default) for name, default in given if name in used}

    def perhaps(self, name: str) -> str:
        """The folder above that holds what the file wants of a package, for a message."""
        text = _read(self.source)
        wanted = re.findall(rf"\$\(find\s+{re.escape(name)}\s*\)/([^\"'$]+)", text)
        for folder in self.source.resolve().parents[:_ABOVE] if wanted else ():
            if all((folder / inside).exists() for inside in wanted):
                return f"; {folder} holds what is wanted: --package {name}={folder}"
        return ""

    def explain(self, error: Exception, xacro: Any) -> str | None:
        """What to give, where an argument or a file is missing; None for other errors."""
        from xacro.substitution_args import ArgException

        while not isinstance(error, ArgException | OSError | Dh2UrdfError):
            inner = getattr(error, "exc", None)
            if not isinstance(inner, Exception):
                return None
            error = inner
        if isinstance(error, Dh2UrdfError):
            return str(error)
        if isinstance(error, ArgException):
            name = str(error)
            values = self.values(name, xacro)
            one = f", one of {_listed(values)}" if values else ""
            return f"the argument {name!r} has no default; give --xacro-arg {name}:=VALUE{one}"
        path = str(error.filename)
        message = f"{path}: {error.strerror}"
        for name, value in xacro.substitution_args_context.get("arg", {}).items():
            values = self.values(name, xacro)
            if value and value in path and values and value not in values:
                message += f"; --xacro-arg {name}:=VALUE is one of {_listed(values)}, not {value}"
        return message

    def refuse_unknown(self, xacro: Any) -> None:
        """No argument is given that the files do not know."""
        texts = [_read(path) for path in (self.source, *map(Path, xacro.all_includes))]
        each = (re_.findall(text) for text in texts for re_ in (_DECLARED, _USED))
        known = {name for names in each for name in names}
        for name in self.given.args:
            if name not in known:
                hint = did_you_mean(name, sorted(known))
                has = f"it has {_listed(sorted(known))}" if known else "it has none"
                raise Dh2UrdfError(f"no argument {name!r}; {hint and hint + ' '}{has}")

    def values(self, name: str, xacro: Any) -> list[str]:
        """Values that an argument may have: those it is compared with, or that name files."""
        paths = [self.source, *map(Path, xacro.all_includes)]
        if folder := package_of(self.source):
            paths += islice(folder.rglob("*.xacro"), _FILES)
        out: set[str] = set()
        for path in dict.fromkeys(paths):
            text = _read(path)
            out |= self._compared(name, text) | self._paths(name, text, path.parent)
        return sorted(out, key=lambda value: [(len(p), p) for p in re.split(r"(\d+)", value)])

    def _compared(self, name: str, text: str) -> set[str]:
        """Texts with which the argument, or a property that holds it, is compared."""
        arg = rf"\$\(arg\s+{re.escape(name)}\s*\)"
        holds = re.findall(rf"<xacro:property\s+name=\"(\w+)\"\s+value=\"{arg}\"", text)
        names = "|".join([rf"[\"']?{arg}[\"']?", *(rf"\b{h}\b" for h in (name, *holds))])
        same = re.findall(rf"(?:{names})\s*==\s*[\"'&;quotapos]*?([\w.-]+)[\"'&]", text)
        lists = re.findall(rf"(?:{names})\s+(?:not\s+)?in\s+[\[(]([^\])]*)[\])]", text)
        words = {word for inside in lists for word in re.findall(r"[\"']([\w.-]+)[\"']", inside)}
        truth = re.search(rf"<xacro:(?:if|unless)\s+value=\"{arg}\"", text)
        return {*same, *words, *(("true", "false") if truth else ())}

    def _paths(self, name: str, text: str, folder: Path) -> set[str]:
        """Names of files and folders in place of the argument in a path."""
        out: set[str] = set()
        arg = rf"\$\(arg\s+{re.escape(name)}\s*\)"
        for before, after in re.findall(rf"[\"']([^\"']*){arg}([^\"']*)[\"']", text):
            try:
                start = _FIND.sub(lambda m: str(self._package(m[1])), before)
            except Dh2UrdfError:
                continue
            if "$" in start + after or "/" not in before + after:
                continue
            pattern = os.path.join(folder, glob.escape(start) + "*" + glob.escape(after))
            lead = len(os.path.join(folder, start))
            for match in islice(glob.iglob(pattern), _FILES):
                middle = match[lead : len(match) - len(after)]
                out |= {middle} if middle and "/" not in middle else set()
        return out

    def _package(self, name: str) -> Path:
        return find_package(name, self.source, self.given.packages)


def _read(path: Path) -> str:
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            return file.read(ROBOT_BYTES)
    except OSError:
        return ""


def _listed(values: Iterable[str]) -> str:
    every = list(values)
    more = f", ... ({len(every)} in all)" if len(every) > _SHOWN else ""
    return ", ".join(every[:_SHOWN]) + more
