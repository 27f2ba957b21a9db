"""Licences of what the package depends on, read from what is installed.

``python tests/helpers/licences.py`` prints them, one distribution a line.
"""

import re
import tomllib
from collections.abc import Iterable
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path
from typing import NamedTuple

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

PROJECT = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())["project"]

PERMISSIVE = {
    *("0BSD", "Apache-2.0", "BSD", "BSD-2-Clause", "BSD-3-Clause", "BSL-1.0", "CC0-1.0", "ISC"),
    *("MIT", "MIT-CMU", "PSF-2.0", "Python-2.0", "Qhull", "Unlicense", "Zlib"),
}
"""Licences that ask for their notice to be kept, and of works beside them for nothing."""

BY_FILE = {"MPL-2.0"}
"""Licences that hold for changed copies of their own files, and not for works beside them."""

WORDS = {
    "Apache": "Apache-2.0",
    "BSD License": "BSD",
    "BSD 3-Clause": "BSD-3-Clause",
    "ISC License": "ISC",
    "MIT License": "MIT",
    "Mozilla Public License 2.0": "MPL-2.0",
    "Python Software Foundation": "PSF-2.0",
    "Redistribution and use in source and binary forms": "BSD",
    "Permission is hereby granted, free of charge": "MIT",
    "Qhull": "Qhull",
}
"""How classifiers and texts of licences begin, of those that give no expression."""


class Licence(NamedTuple):
    """Of one distribution: its name, its licence by SPDX, and what asks for it."""

    name: str
    version: str
    licence: str
    needed_by: str

    @property
    def compatible(self) -> bool:
        """Whether all its parts go with a package under BSD-3-Clause that asks for it."""
        return bool(self.licence) and set(_parts(self.licence)) <= PERMISSIVE | BY_FILE


def licences(*extras: str) -> list[Licence]:
    """Of everything that an installation with these extras brings and that is installed here."""
    todo = [(Requirement(line), "dh2urdf") for line in asked(extras)]
    found: dict[tuple[str, frozenset[str]], Licence] = {}
    while todo:
        need, by = todo.pop(0)
        name = canonicalize_name(need.name)
        key = name, frozenset(need.extras)
        if key in found:
            continue
        try:
            of = distribution(name)
        except PackageNotFoundError:
            continue
        found[key] = Licence(name, of.version, licence_of(of), by)
        todo += [(more, name) for more in _needs(of, need.extras)]
    named = {entry.name: entry for entry in reversed(found.values())}
    return [named[name] for name in sorted(named)]


def asked(extras: Iterable[str]) -> list[str]:
    """What the project asks for with some of its extras, and with those that they name."""
    lines, more = list(PROJECT["dependencies"]), list(extras)
    for extra in more:
        for line in PROJECT["optional-dependencies"][extra]:
            need = Requirement(line)
            own = need.name == PROJECT["name"]
            lines += [] if own else [line]
            more += sorted(need.extras - set(more)) if own else []
    return lines


def _needs(of: Distribution, extras: set[str]) -> list[Requirement]:
    """What a distribution asks for here, with some of its extras."""
    lines = map(Requirement, of.requires or [])
    told = [{"extra": extra} for extra in ("", *extras)]
    return [r for r in lines if r.marker is None or any(map(r.marker.evaluate, told))]


def licence_of(of: Distribution) -> str:
    """The expression that a distribution gives, else what its classifiers or texts begin with."""
    meta = of.metadata
    given = meta.get("License-Expression") or meta.get("License") or ""
    if given and set(_parts(given)) <= PERMISSIVE | BY_FILE:
        return given
    files = [f for f in of.files or [] if re.search(r"(?i)licen[cs]e|copying", f.name)]
    texts = [str(path.locate()) for path in files]
    read = [Path(path).read_text(errors="replace") for path in texts if Path(path).is_file()]
    classes = [c for c in meta.get_all("Classifier") or [] if c.startswith("License ::")]
    for text in (" ".join(classes), given, *read):
        if "GNU" in text and text not in read:
            break
        for word, name in WORDS.items():
            if word in text:
                return name
    return given.partition("\n")[0] or " ".join(classes)


def _parts(expression: str) -> list[str]:
    return [part for part in re.split(r"[\s()]+|\bAND\b|\bOR\b", expression) if part]


if __name__ == "__main__":
    for entry in licences(*PROJECT["optional-dependencies"]):
        mark = "" if entry.compatible else "  NOT KNOWN TO BE COMPATIBLE"
        print(f"{entry.name} {entry.version}: {entry.licence} (for {entry.needed_by}){mark}")
