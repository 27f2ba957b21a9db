"""What is said beside the result."""

import os
import sys


def note(text: str) -> None:
    """Anything that is not the result, on stderr; where that takes nothing, nowhere."""
    try:
        sys.stderr.write(text.rstrip("\n") + "\n")
        sys.stderr.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
