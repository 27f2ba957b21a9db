"""Parameters of ortho-parallel arms (Brandstötter, Angerer and Hofbaur 2014), for two peers."""

from __future__ import annotations

import numpy as np

__all__ = ["MODELS"]

HALF_PI = np.pi / 2
MODELS = {
    "kuka_kr6_r700": {
        "a1": 0.025,
        "a2": -0.035,
        "c1": 0.4,
        "c2": 0.315,
        "c3": 0.365,
        "c4": 0.08,
        "offsets": (0.0, -HALF_PI, 0.0, 0.0, 0.0, 0.0),
        "flip_axes": (True, False, False, True, False, True),
    }
}
"""Parameters of the arms here; same base, tool and joints as the arm's."""
