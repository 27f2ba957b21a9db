"""Files that are the same for every arm but for what stands in ``@NAME@``."""

from collections.abc import Mapping
from importlib.resources import files


def filled(package: str, name: str, blanks: Mapping[str, str]) -> str:
    """The text of ``templates/NAME.in`` of a package with its blanks filled."""
    text = (files(package) / "templates" / f"{name}.in").read_text(encoding="utf-8")
    for blank, value in blanks.items():
        text = text.replace(f"@{blank}@", value)
    return text
