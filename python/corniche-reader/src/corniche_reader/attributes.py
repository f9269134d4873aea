"""The road attributes section (section 9 of the format)."""

from __future__ import annotations

from dataclasses import dataclass

from .codes import Cursor
from .errors import PayloadError

FORMS = ("ordinary", "dual_carriageway", "link", "roundabout")
STRUCTURES = ("ground", "bridge", "tunnel")
ONEWAYS = ("no", "forward", "backward")


@dataclass(frozen=True)
class Attributes:
    """What is known of a way. An absent tag is the empty text."""

    way_id: int
    form: str
    structure: str
    layer: int
    oneway: str
    name: str
    reference: str
    surface: str


def read_attributes(data: bytes, what: str) -> list[Attributes]:
    """Decodes the section, a record of bincode."""
    cursor = Cursor(data, what)
    texts = [cursor.take(_word(cursor, 8)) for _ in range(_length(cursor))]
    steps, forms, structures, layers, oneways, *names = ([_word(cursor, width) for _ in range(_length(cursor))] for width in (8, 1, 1, 1, 1, 4, 4, 4))
    cursor.end()
    found, way = [], 0
    try:
        text = [content.decode() for content in texts]
        for step, form, structure, layer, oneway, name, reference, surface in zip(steps, forms, structures, layers, oneways, *names, strict=True):
            way += step - (step >> 63 << 64)
            tags = text[name], text[reference], text[surface]
            found.append(Attributes(way, FORMS[form], STRUCTURES[structure], layer - (layer >> 7 << 8), ONEWAYS[oneway], *tags))
    except (ValueError, IndexError) as cause:
        raise PayloadError(f"{what}: {cause}") from cause
    return found


def _word(cursor: Cursor, width: int) -> int:
    return int.from_bytes(cursor.take(width), "little")


def _length(cursor: Cursor) -> int:
    length = _word(cursor, 8)
    if length > len(cursor.data):
        raise PayloadError(f"{cursor.what}: a list is longer than the section")
    return length
