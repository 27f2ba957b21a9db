"""What is said beside the result."""

from __future__ import annotations

import os
import sys

__all__ = ["note"]


def note(text: str) -> None:
    """Anything that is not the result, on stderr; where that takes nothing, nowhere."""
    try:
        sys.stderr.write(text.rstrip("\n") + "\n")
        sys.stderr.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
