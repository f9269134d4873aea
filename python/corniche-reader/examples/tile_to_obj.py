"""Lists the levels of a package, and writes the ground of one tile as OBJ.

    python tile_to_obj.py PACKAGE [Z/X/Y OUT.obj]
"""

from __future__ import annotations

import sys

from corniche_reader import Package, ReadError


def main(arguments: list[str]) -> int:
    """Runs the example; returns the exit code."""
    if len(arguments) not in (1, 3):
        print(__doc__, file=sys.stderr)
        return 2
    try:
        with Package.open(arguments[0]) as package:
            for level in package.manifest["levels"]:
                print(f"level {level['level']}: {level['tiles']} tiles, {level['triangles']} triangles, error {level['geometric_error_m']:.2f} m")
            if len(arguments) == 3:
                z, x, y = map(int, arguments[1].split("/"))
                write_obj(package, (z, x, y), arguments[2])
    except (ReadError, OSError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


def write_obj(package: Package, name: tuple[int, int, int], path: str) -> None:
    """Writes the ground, relative to its first vertex in plan."""
    tile = package.tile(*name)
    if tile.terrain is None:
        raise ValueError(f"tile {name} has no ground")
    points = tile.terrain.positions.copy()
    points[:, :2] -= points[0, :2]
    with open(path, "w", encoding="ascii") as file:
        file.writelines(f"v {x:.3f} {y:.3f} {z:.3f}\n" for x, y, z in points)
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in tile.terrain.triangles + 1)
    print(f"{path}: {len(points)} vertices, {len(tile.terrain.triangles)} triangles; the tile has {len(tile.roads)} parts of roads")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
