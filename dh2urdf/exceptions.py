"""One tree of errors.

Every error that the package raises on purpose derives from :class:`Dh2UrdfError`,
and its text says what was wrong, where, and what is allowed::

    Dh2UrdfError
    ├── TableError (ValueError)          a DH table that cannot be meant
    │   └── TableFileError               a table file, all of its faults at once
    ├── UrdfError (ValueError)           a URDF, MJCF or model that cannot be read
    ├── VerificationError                a written result that differs from its source
    ├── PoseError (ValueError)           a target that is not in SE(3)
    ├── ConfigurationError (ValueError)  a q, seed or locked value of the wrong shape or kind
    │   └── ArgumentError                an option of the wrong kind or beyond its bounds
    ├── NameNotFoundError (LookupError)  no such table, frame or joint
    ├── NoSolutionError (LookupError)    a choice from an empty list of solutions
    ├── UnreachedError                   nothing of what was asked for is within reach
    ├── NoSolverError                    no analytic solver for this chain or task
    ├── NotOrthoParallelError (ValueError)  an arm that has no OPW parameters
    ├── OutputError (OSError)            a file that cannot be written
    │   └── OutputExistsError            a file of somebody else's in the way
    ├── ServerError (OSError)            the browser view cannot listen there
    ├── SchedulerError (OSError)         the scheduler of a cluster is out of reach
    └── MissingExtraError (ImportError)  an optional dependency is not installed
"""

from collections.abc import Iterable


class Dh2UrdfError(Exception):
    """Base of all errors raised on purpose."""


class TableError(Dh2UrdfError, ValueError):
    """A DH table that cannot be meant; ``problems`` lists every fault found."""

    def __init__(self, problems: str | Iterable[str]) -> None:
        self.problems = (problems,) if isinstance(problems, str) else tuple(problems)
        super().__init__("\n".join(self.problems))

    def __reduce__(self) -> "tuple[type[TableError], tuple[tuple[str, ...]]]":
        """Pickle by the list of problems."""
        return type(self), (self.problems,)


class TableFileError(TableError):
    """A table file with faults; each problem opens with ``file:line:column``."""


class UrdfError(Dh2UrdfError, ValueError):
    """A URDF, MJCF or Pinocchio model that cannot be read or has no such chain."""


class VerificationError(Dh2UrdfError):
    """A result that differs from its source by more than is allowed; nothing was written."""


class PoseError(Dh2UrdfError, ValueError):
    """A target that is not a rigid pose: wrong shape, NaN, or not a rotation."""


class ConfigurationError(Dh2UrdfError, ValueError):
    """A configuration, seed or locked joint of the wrong length or kind."""


class ArgumentError(ConfigurationError):
    """An option of a call of the wrong kind or beyond its bounds."""


class NameNotFoundError(Dh2UrdfError, LookupError):
    """No table, frame or joint of that name; the message lists the ones there are."""


class NoSolutionError(Dh2UrdfError, LookupError):
    """A solution was to be chosen where there is none."""


class NoSolverError(Dh2UrdfError):
    """No analytic solver covers this chain or task; the message says which classes exist."""


class NotOrthoParallelError(Dh2UrdfError, ValueError):
    """An arm of another geometry; the message has every condition that fails, and by how much."""


class UnreachedError(Dh2UrdfError):
    """Nothing of what was asked for is within reach: there is nothing to draw."""


class OutputError(Dh2UrdfError, OSError):
    """A file that cannot be written; whatever stood at its path is untouched."""


class OutputExistsError(OutputError):
    """The output path holds something that this package did not write."""


class ServerError(Dh2UrdfError, OSError):
    """A host or port on which the browser view cannot listen."""


class SchedulerError(Dh2UrdfError, OSError):
    """The scheduler of a Dask cluster is out of reach, or was lost on the way."""


class MissingExtraError(Dh2UrdfError, ImportError):
    """An optional dependency is missing; the message names the extra to install."""

    def __init__(self, extra: str, purpose: str) -> None:
        self.extra, self.purpose = extra, purpose
        super().__init__(f"{purpose} needs the extra {extra!r}: pip install 'dh2urdf[{extra}]'")

    def __reduce__(self) -> "tuple[type[MissingExtraError], tuple[str, str]]":
        """Pickle by extra and purpose."""
        return type(self), (self.extra, self.purpose)
