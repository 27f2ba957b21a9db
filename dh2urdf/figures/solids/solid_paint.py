"""Paint of solids: pale bodies with a dark outline, ghosts in one colour, the floor."""

from dataclasses import dataclass

import numpy as np

from dh2urdf.figures.canvas import Canvas
from dh2urdf.figures.projection import View
from dh2urdf.figures.solids.occlusion import occlusion
from dh2urdf.figures.solids.solids import SHEEN, Face, Part
from dh2urdf.figures.style import mix
from dh2urdf.transforms import Array


@dataclass(frozen=True)
class Paint:
    """Darkest and lightest tone of each material, and the outline."""

    tones: dict[str, tuple[str, str]]
    edge: str
    width: float = 0.8
    alpha: float = 1.0

    def tone(self, material: str, share: float) -> str:
        """A tone between the darkest (0) and the lightest (1) of a material."""
        dark, light = self.tones.get(material, self.tones["link"])
        return mix(light, share, dark)


BODY = Paint(
    {
        "base": ("#7d8798", "#a9b2c1"),
        "joint": ("#8a95a9", "#c0c8d5"),
        "link": ("#dde1e7", "#f1f3f6"),
        "rail": ("#b3bbc8", "#d8dde5"),
        "bar": ("#a3b6c1", "#cfdae1"),
    },
    "#414b5e",
)
"""The arm itself."""


def ghost_paint(colour: str) -> Paint:
    """One colour for a whole arm, paler on its links."""
    pale, middle = mix(colour, 0.28), mix(colour, 0.45)
    tones = {
        "link": (pale, mix(colour, 0.16)),
        "joint": (middle, pale),
        "base": (middle, pale),
        "rail": (pale, pale),
        "bar": (pale, pale),
    }
    return Paint(tones, mix(colour, 0.8), 0.7, 0.75)


def paint_parts(canvas: Canvas, parts: list[Part], paint: Paint) -> None:
    """Paint parts from far to near, then again what is in front where it was covered."""
    seen = occlusion(parts, canvas.view)
    faces = [part.faces(canvas.view) for part in parts]
    for k in seen.order:
        _paint_part(canvas, parts[k].material, faces[k], paint)
    for k, rings in seen.again:
        with canvas.clipped([canvas.to(ring) for ring in rings]):
            _paint_part(canvas, parts[k].material, faces[k], paint)


def _paint_part(canvas: Canvas, material: str, solids: list[list[Face]], paint: Paint) -> None:
    """All outlines first, then all fills: solids of one part share one outline."""
    for faces in solids:
        outline = canvas.to(faces[0].polygon)
        canvas.polygon(outline, paint.edge, paint.edge, 2 * paint.width, paint.alpha)
    for faces in solids:
        canvas.polygon(canvas.to(faces[0].polygon), paint.tone(material, 0.0))
    for faces in solids:
        for face in faces[1:]:
            if face.tone == 1.0 and len(solids) > 1:  # a cap between two solids
                continue
            edge = paint.edge if len(solids) == 1 and face.tone != SHEEN else "none"
            tone = paint.tone(material, face.tone)
            canvas.polygon(canvas.to(face.polygon), tone, edge, 0.7 * paint.width)


def floor_discs(view: View, centre: Array, radius: float) -> list[Array]:
    """Outlines in the picture [m] of two discs of shade on the floor, the larger first."""
    angle = np.linspace(0.0, 2 * np.pi, 72, endpoint=False)
    rim = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=1)
    return [view.flat(centre + share * radius * rim) for share in (1.0, 0.66)]


def paint_floor(canvas: Canvas, discs: list[Array]) -> None:
    """Paint the shade under the base."""
    for disc, colour in zip(discs, ("#f0f2f5", "#e4e8ed"), strict=False):
        canvas.polygon(canvas.to(disc), colour)
