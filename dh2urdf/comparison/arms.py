"""An arm to be compared, whatever it is given as."""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple, Protocol, runtime_checkable

from dh2urdf.chain import SerialChain
from dh2urdf.conversions.assign import chain_to_dh
from dh2urdf.conversions.chains import following
from dh2urdf.conversions.write import dh_to_chain
from dh2urdf.dh import DHTable, Mimic
from dh2urdf.dh_io.files import shown
from dh2urdf.doors import found
from dh2urdf.exceptions import ArgumentError
from dh2urdf.extract import extract_dh
from dh2urdf.robots import load_table_file

ROBOT_SUFFIXES = (".urdf", ".xacro", ".xml", ".mjcf")


@runtime_checkable
class _Robot(Protocol):
    """What is asked of a `Robot`."""

    @property
    def chain(self) -> SerialChain: ...
    @property
    def table(self) -> DHTable | None: ...
    def followed_joints(self) -> Sequence[Mimic | None]: ...


class Arm(NamedTuple):
    """A chain, and a table of it.

    ``written`` tells that somebody wrote the table, so that its cells mean something; else frames
    were assigned. ``warnings`` are what looked odd about a file.
    """

    name: str
    chain: SerialChain
    table: DHTable
    written: bool
    warnings: tuple[str, ...] = ()


def arm_of(given: Any, base: str | None, tip: str | None) -> Arm:
    """The arm of a table, its path or name, a robot description, a `Robot` or a `SerialChain`."""
    if isinstance(given, DHTable):
        return of_table(given, given.name)
    if isinstance(given, SerialChain):
        return Arm("chain", given, chain_to_dh(given).table, written=False)
    if isinstance(given, _Robot):
        if given.table is not None:
            return of_table(given.table, given.table.name)
        name = str(getattr(given, "source", None) or "robot")
        table = following(chain_to_dh(given.chain).table, given.followed_joints())
        return Arm(name, given.chain, table, written=False)
    if not isinstance(given, (str, os.PathLike)):
        kinds = "a DHTable, a path, the name of a table that ships, a Robot or a SerialChain"
        raise ArgumentError(f"arm: expected {kinds}, got {found(given)}")
    text = isinstance(given, str) and given.lstrip().startswith("<")
    if text or Path(given).suffix.lower() in ROBOT_SUFFIXES:
        extraction = extract_dh(given, base, tip)
        name = extraction.table.name if text else shown(given)
        chain, written = dh_to_chain(extraction.table), not extraction.steps
        return Arm(name, chain, extraction.table, written, extraction.warnings)
    file = load_table_file(given)
    return of_table(file.table, shown(given))._replace(warnings=file.warnings)


def of_table(table: DHTable, name: str) -> Arm:
    """The arm of a table that somebody wrote."""
    return Arm(name, dh_to_chain(table), table, written=True)
