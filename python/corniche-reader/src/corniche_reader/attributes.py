"""Road attributes and road tags (section 9 of the format), under the names that `corniche export roads` uses."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from .codes import Cursor

FORMS = ("ordinary", "dual_carriageway", "link", "roundabout")
STRUCTURES = ("ground", "bridge", "tunnel")
#: OSM's `oneway`: open in both directions, only along the line, only against it.
ONEWAYS = ("no", "yes", "-1")
#: The columns of the section of tags.
TAGS = ("highway", "maxspeed", "sac_scale", "tracktype", "lanes", "width")


@dataclass(frozen=True)
class Attributes:
    """The attributes of a way. Names and values are those of exports; an absent tag is None."""

    way_id: int
    #: OSM's `highway`; None in packages of the first programs, which did not store it.
    highway: str | None
    form: str
    name: str | None
    ref: str | None
    bridge: bool
    tunnel: bool
    layer: int
    oneway: str
    surface: str | None
    #: The number of lanes in both directions together.
    lanes: int | None
    #: Width in metres.
    width: float | None
    #: A number is in km/h, `30 mph` in miles per hour; other values are as tagged.
    maxspeed: str | None
    sac_scale: str | None
    tracktype: str | None


def read_attributes(data: bytes, what: str, tags: bytes | None, tags_what: str) -> list[Attributes]:
    """Decodes the section of attributes, a bincode record, and the section of tags."""
    cursor = Cursor(data, what)
    texts = [cursor.take(cursor.word(8)) for _ in range(_length(cursor))]
    steps, forms, structures, layers, oneways, *names = (_words(cursor, width) for width in (8, 1, 1, 1, 1, 4, 4, 4))
    cursor.end()
    found, way = [], 0
    of_tags = _read_tags(tags, len(steps), tags_what) if tags is not None else [dict.fromkeys(TAGS)] * len(steps)
    columns = zip(steps, forms, structures, layers, oneways, *names, of_tags, strict=True)
    try:
        text = [content.decode() or None for content in texts]
        for step, form, structure, layer, oneway, name, reference, surface, tagged in columns:
            way += step - (step >> 63 << 64)
            lies = STRUCTURES[structure]
            found.append(
                Attributes(
                    way_id=way,
                    form=FORMS[form],
                    name=text[name],
                    ref=text[reference],
                    bridge=lies == "bridge",
                    tunnel=lies == "tunnel",
                    layer=layer - (layer >> 7 << 8),
                    oneway=ONEWAYS[oneway],
                    surface=text[surface],
                    **tagged,
                )
            )
    except (ValueError, IndexError) as cause:
        raise cursor.error(str(cause)) from cause
    return found


def _read_tags(data: bytes, ways: int, what: str) -> list[dict[str, Any]]:
    """Decodes the section of tags: the tags of each of `ways` ways."""
    cursor = Cursor(data, what)
    count = cursor.varint()
    if count > len(data):
        raise cursor.error("more texts than the section has bytes")
    contents = [cursor.take(cursor.varint()) for _ in range(count)]
    if not all(contents) or any(one >= other for one, other in pairwise(contents)):
        raise cursor.error("texts are empty or not sorted")
    columns = [cursor.planes(ways) for _ in range(6)]
    cursor.end()
    try:
        texts = [None, *(content.decode() for content in contents)]
        named = [[texts[index] for index in column] for column in columns[:4]]
    except (ValueError, IndexError) as cause:
        raise cursor.error(str(cause)) from cause
    lanes, widths = columns[4:]
    if max(lanes, default=0) > 255 or max(widths, default=0) >= 1 << 32:
        raise cursor.error("lanes or a width beyond their limits")
    numbers = [one or None for one in lanes], [one / 1000 if one else None for one in widths]
    return [dict(zip(TAGS, of_way, strict=True)) for of_way in zip(*named, *numbers, strict=True)]


def _words(cursor: Cursor, width: int) -> list[int]:
    return np.frombuffer(cursor.take(width * _length(cursor)), dtype=f"<u{width}").tolist()


def _length(cursor: Cursor) -> int:
    length = cursor.word(8)
    if length > len(cursor.data):
        raise cursor.error("a list is longer than the section")
    return length
