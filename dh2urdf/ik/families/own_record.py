"""Records of an arm that kernels work in: none is shared between threads."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray


class OwnRecord:
    """A solver whose kernel works in a copy of its plan."""

    plan: Any
    _idle: list[NDArray[np.void]]

    @contextmanager
    def record(self) -> Iterator[NDArray[np.void]]:
        """A copy of the plan that no other thread has meanwhile."""
        try:
            arm = self._idle.pop()
        except IndexError:
            arm = self.plan.copy()
        yield arm
        self._idle.append(arm)
