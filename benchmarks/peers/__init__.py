"""One adapter a peer, and the list of them; a peer that is not installed is named and left out."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from importlib import import_module

from benchmarks.arms import Arm
from benchmarks.contestant import IKContestant, NotCoveredError
from benchmarks.marker import at_work
from benchmarks.results import Results

__all__ = ["IK_PEERS", "Entry", "contestants"]


@dataclass(frozen=True)
class Entry:
    """Where a solver's adapter is."""

    name: str
    module: str
    cls: str
    slow: bool = False
    """Building takes seconds and is done once a process."""

    def load(self) -> type[IKContestant]:
        """Import the adapter and with it the peer."""
        found: type[IKContestant] = getattr(
            import_module(f"benchmarks.peers.{self.module}"), self.cls
        )
        return found


IK_PEERS = (
    Entry("dh2urdf", "ours", "Ours"),
    Entry("EAIK", "eaik", "Eaik"),
    Entry("ik-geo", "ik_geo", "IkGeo"),
    Entry("py-ikgeo", "py_ikgeo", "PyIkgeo"),
    Entry("py-opw", "py_opw", "PyOpw"),
    Entry("spherical-wrist", "spherical_wrist", "SphericalWristRust"),
    Entry("ur-analytic-ik", "ur_analytic", "UrAnalytic"),
    Entry("ssik prebuilt", "ssik", "SsikPrebuilt"),
    Entry("ssik from_axes", "ssik", "SsikAxes"),
    Entry("crx-kinematics", "crx", "CrxKinematics"),
    Entry("ikdh", "ikdh", "Ikdh"),
    Entry("frankik", "frankik", "Frankik"),
    Entry("roboticstoolbox C", "toolbox_analytic", "ToolboxC", slow=True),
    Entry("roboticstoolbox analytic", "toolbox_analytic", "ToolboxAnalytic", slow=True),
    Entry("roboticstoolbox search", "toolbox", "ToolboxSearch"),
)
"""All solvers of inverse kinematics, ours first."""


def contestants(
    arm: Arm, results: Results, *, only: str | None = None, slow: bool = True
) -> Iterator[IKContestant]:
    """Solvers built for an arm, or one; ``left_out`` has those that are not there or refuse."""
    for entry in IK_PEERS:
        if entry.name in results.excluded or only not in (None, entry.name):
            continue
        if entry.slow and not slow:
            continue
        at_work(entry.name)
        try:
            yield entry.load()(arm)
        except NotCoveredError as reason:
            results.left_out[f"{entry.name}, {arm.key}"] = str(reason)
        except ImportError as error:
            if entry is IK_PEERS[0]:
                raise
            results.left_out[entry.name] = f"not installed ({error})"
