"""Hand-made broken tiles, which `check_tile` must all detect."""

import copy

from check_tile import Tile, check_tiles

CELL_EAST_M, CELL_NORTH_M = 10.0, 15.0
SIDE = 4
X0, Y0 = 534005.0, 5199995.0


def height(i, j):
    """A ground without any flat part."""
    return 900.0 + 3.0 * i - 2.0 * j + 0.75 * i * j


def made(x, void=None):
    """Tile 1/x/0 of SIDE × SIDE cells, two triangles each, with one road along its middle."""
    first = x * SIDE
    vertices, triangles, ids = [], [], {}

    def vertex(i, j):
        if (i, j) not in ids:
            ids[i, j] = len(vertices)
            vertices.append([X0 + CELL_EAST_M * i, Y0 + CELL_NORTH_M * j, height(i, j)])
        return ids[i, j]

    for i in range(first, first + SIDE):
        for j in range(SIDE):
            if (i, j) != void:
                a, b, c, d = vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)
                triangles += [[a, b, c], [a, c, d]]
    # Along y = 1.5 cells: through a–c at the middle of each cell, through b–c at its side.
    line = []
    for i in range(first, first + SIDE + 1):
        line.append([X0 + CELL_EAST_M * i, Y0 + CELL_NORTH_M * 1.5, 0.5 * (height(i, 1) + height(i, 2))])
        if i < first + SIDE:
            line.append([X0 + CELL_EAST_M * (i + 0.5), Y0 + CELL_NORTH_M * 1.5, 0.5 * (height(i, 1) + height(i + 1, 2))])
    plan = [[line[0][0] - 5.0, line[0][1]], [line[4][0], line[4][1]], [line[-1][0] + 5.0, line[-1][1]]]
    return {
        "id": f"1/{x}/0", "crs": "EPSG:32632", "cell_m": [CELL_EAST_M, CELL_NORTH_M], "max_error_m": 2.5, "geometric_error_m": 1.0,
        "bounds": [X0 + CELL_EAST_M * first, Y0, X0 + CELL_EAST_M * (first + SIDE), Y0 + CELL_NORTH_M * SIDE],
        "height_range_m": [880.0, 1000.0], "tin": {"vertices": vertices, "triangles": triangles},
        "roads_geo": [{"way_id": 7, "part": 0, "frc": 2, "line": line},
                      {"way_id": 9, "part": 0, "frc": 4, "line": line}],
        "roads_sv": [{"way_id": 7, "part": 0, "frc": 2, "line": plan},
                     {"way_id": 9, "part": 0, "frc": 4, "line": plan}],
    }  # fmt: skip


def parent():
    """Tile 0/0/0 over both tiles, coarse and without roads."""
    size = 2 * SIDE
    corners = [[X0 + CELL_EAST_M * i, Y0 + CELL_NORTH_M * j, height(i, j)] for i, j in ((0, 0), (size, 0), (size, size), (0, size))]
    return {
        "id": "0/0/0", "crs": "EPSG:32632", "cell_m": [2 * CELL_EAST_M, 2 * CELL_NORTH_M], "max_error_m": 5.0, "geometric_error_m": 9.0,
        "bounds": [X0, Y0, X0 + CELL_EAST_M * size, Y0 + CELL_NORTH_M * size], "height_range_m": [880.0, 1000.0],
        "tin": {"vertices": corners, "triangles": [[0, 1, 2], [0, 2, 3]]}, "roads_geo": [], "roads_sv": [],
    }  # fmt: skip


def flip(tiles):
    tiles[0]["tin"]["triangles"][3].reverse()


def repeat(tiles):
    tiles[0]["tin"]["triangles"].append(tiles[0]["tin"]["triangles"][5])


def overlap(tiles):
    tin = tiles[0]["tin"]
    first = len(tin["vertices"])
    tin["vertices"] += [[X0 + 12.0, Y0 + 12.0, 900.0], [X0 + 18.0, Y0 + 12.0, 900.0], [X0 + 18.0, Y0 + 18.0, 900.0]]
    tin["triangles"].append([first, first + 1, first + 2])


def hole(tiles):
    del tiles[0]["tin"]["triangles"][10]


def move_border_up(tiles):
    vertex = next(v for v in tiles[0]["tin"]["vertices"] if v[0] == tiles[0]["bounds"][2] and v[1] == Y0)
    vertex[2] += 1e-6


def move_inner(tiles):
    # In plan only: its own triangles follow, so the area is unchanged, but the road's edges no
    # longer fit them.
    vertex = next(v for v in tiles[0]["tin"]["vertices"] if v[:2] == [X0 + 2 * CELL_EAST_M, Y0 + CELL_NORTH_M])
    vertex[1] += 0.4


def extra_border_vertex(tiles):
    tin = tiles[0]["tin"]
    east = tiles[0]["bounds"][2]
    ends = [k for k, v in enumerate(tin["vertices"]) if v[0] == east and v[1] in (Y0, Y0 + CELL_NORTH_M)]
    for k, t in enumerate(tin["triangles"]):
        if set(ends) <= set(t):
            while t[2] in ends:
                t.append(t.pop(0))
            middle = len(tin["vertices"])
            a, b = (tin["vertices"][i] for i in t[:2])
            tin["vertices"].append([east, 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])])
            tin["triangles"][k : k + 1] = [[t[0], middle, t[2]], [middle, t[1], t[2]]]
            return


def lift_road(tiles):
    tiles[0]["roads_geo"][0]["line"] = [p[:] for p in tiles[0]["roads_geo"][0]["line"]]
    tiles[0]["roads_geo"][0]["line"][3][2] += 0.026


def skip_crossing(tiles):
    line = tiles[0]["roads_geo"][0]["line"]
    tiles[0]["roads_geo"][0]["line"] = line[:3] + line[4:]


def unsort(tiles):
    tiles[0]["roads_geo"].reverse()


def shift_plan(tiles):
    tiles[0]["roads_sv"][0]["line"] = [[x, y + 0.003] for x, y in tiles[0]["roads_sv"][0]["line"]]


def lose_road(tiles):
    del tiles[0]["roads_geo"][1]


def understate_error(tiles):
    tiles[2]["geometric_error_m"] = 0.5


BROKEN = [
    ("orientation", flip), ("manifold", repeat), ("overlap", repeat), ("overlap", overlap), ("outline", overlap),
    ("outline", hole), ("outside", hole), ("seam", move_border_up), ("seam", extra_border_vertex),
    ("outside", move_inner), ("off-plane", lift_road), ("outside", skip_crossing), ("order", unsort),
    ("plan", shift_plan), ("missing", lose_road), ("error", understate_error),
]  # fmt: skip


def check(records):
    """Findings over tile records."""
    tiles = [Tile(record) for record in records]
    return check_tiles({(tile.z, tile.x, tile.y): tile for tile in tiles})


def run():
    """Returns 0 when valid tiles pass and every broken one is detected."""
    failed = 0
    # The adjacent tile may lack ground at the border where this one has it: that is not a crack.
    for name, records in (
        ("sound tiles", [made(0), made(1), parent()]),
        ("a void inside", [made(0), made(1, void=(5, 3)), parent()]),
        ("a void's side on the border", [made(0), made(1, void=(4, 3)), parent()]),
    ):
        found = check(records)
        if found.counts:
            failed += 1
            print(f"FAILED: {name} should pass: {found.examples}")
    sound = [made(0), made(1), parent()]
    for kind, damage in BROKEN:
        records = copy.deepcopy(sound)
        damage(records)
        found = check(records)
        if not found.counts[kind]:
            failed += 1
            print(f"FAILED: {damage.__name__} should be caught as {kind}, got {dict(found.counts)}")
    print(f"check_tile: {len(BROKEN) + 3 - failed} passed, {failed} failed")
    return 1 if failed else 0
