"""The roads of the made-up pass, laid by `route` on the made-up ground."""

from landforms import GORGE, LARGE_VOID
from network import Network, length_of, offset
from noise import catmull_rom, nearest_on_line
from route import Ground, simplify, smooth
from terrain import CELL_M, EXTENT_M, MAIN_VALLEY, centres

EDGE = EXTENT_M - 15.0
RIVER = [(float(x), float(y)) for x, y, *_ in MAIN_VALLEY]
MOTORWAY_AXIS = [
    (15, 1720), (1600, 1570), (2600, 1800), (3400, 1985), (4300, 1975), (5000, 2150), (5500, 2150),
    (6200, 1985), (7000, 2110), (7800, 2000), (8650, 1870), (9400, 2010), (EDGE, 2210),
]  # fmt: skip
TRUNK_AXIS = [
    (15, 1400), (1400, 1235), (2500, 1420), (3400, 1690), (4300, 1520), (5300, 1340), (6200, 1540),
    (7000, 1790), (7900, 1620), (8650, 1560), (9300, 1700), (EDGE, 1890),
]  # fmt: skip


def curve(points, tolerance_m=1.0):
    """A smooth road axis through hand-set points."""
    return simplify([(float(x), float(y)) for x, y in catmull_rom(points, 24)], tolerance_m)


def laid(ground, start, goals, easy, steep, turn_m, aim=None, tolerance_m=1.5):
    """A routed and smoothed line from `start`, ending on a cell of `goals`."""
    path = ground.route(start, goals, easy, steep, turn_m, aim)
    return simplify(smooth([start, *path[1:]]), tolerance_m)


def lead(ground, network, start, goal, **price):
    """A line between two given points, whose ends stay exact."""
    line = laid(ground, start, {ground.cell(goal)}, aim=goal, **price)
    return [*line[:-1], goal]


def join(ground, network, start, **price):
    """A line from `start` to wherever the network is reached most cheaply."""
    line = laid(ground, start, network.cells(ground.cell), **price)
    return [*line[:-1], network.attach(line[-1])]


def fast_roads(network, z):
    """Motorway as two carriageways with a tunnel, trunk road, and the slip roads between."""
    axis = curve(MOTORWAY_AXIS)
    for side, name in ((-1, "west"), (1, "east")):
        line = offset(axis, 11.0 * side)
        line = line[::-1] if side < 0 else line
        index = network.add(
            line, highway="motorway", name="Talautobahn", ref="A 7", oneway="yes", surface="asphalt",
            lanes=2, destination="Unterau" if side < 0 else "Oberau",
        )  # fmt: skip
        inside, s = [], 0.0
        for a, b in zip(line[:-1], line[1:]):
            n = max(int(length_of([a, b]) / 5.0), 1)
            for k in range(n):
                x, y = (a[i] + k / n * (b[i] - a[i]) for i in (0, 1))
                if z[int(y / CELL_M), int(x / CELL_M)] > 958.0 and 4300 < x < 6300:
                    inside.append(s + k / n * length_of([a, b]))
            s += length_of([a, b])
        tunnel = {"tunnel": "yes", "layer": "-1", "lit": "yes", "name": "Spornwaldtunnel"}
        network.cut(index, [(inside[0], inside[-1], tunnel)])
    network.add(curve(TRUNK_AXIS), highway="trunk", name="Talstrasse", ref="B 171", surface="asphalt")


def junction(network):
    """The roundabout at the mouth of the gorge, the road over the motorway, four slip roads."""
    cx, cy, r = 8650.0, 2030.0, 22.0
    ring = [
        (cx + r * u, cy + r * v)
        for u, v in [(0, -1), (-0.6, -0.8), (-0.8, -0.6), (-1, 0), (-0.8, 0.6), (-0.6, 0.8), (0, 1),
                     (0.6, 0.8), (0.8, 0.6), (1, 0), (0.8, -0.6), (0.6, -0.8)]
    ]  # fmt: skip
    network.add(
        [*ring, ring[0]], highway="primary", junction="roundabout", oneway="yes", ref="L 28", surface="asphalt"
    )
    trunk = network.attach((8650.0, 1560.0))
    neck = (8650.0, 1975.0)
    network.add(
        [trunk, (8650.0, 1640.0), (8650.0, 1790.0), (8650.0, 1935.0), neck, ring[0]],
        highway="primary", name="Zubringer", ref="L 28", surface="asphalt",
    )  # fmt: skip
    carriageways = [k for k, (tags, _) in enumerate(network.roads) if tags["highway"] == "motorway"]
    for start, bend, end, wards in (
        ((8290, 1930), (8470, 1975), ring[3], "off"),
        ((9010, 1930), (8830, 1990), ring[9], "on"),
    ):
        merge = network.attach(start, among=[k for k in carriageways if network.roads[k][0]["destination"] == "Oberau"])
        line = curve([merge, bend, end])
        network.add(
            line if wards == "off" else line[::-1],
            highway="motorway_link", oneway="yes", ref="A 7", surface="asphalt",
        )  # fmt: skip
    at = network.attach((8650.0, 1790.0))
    for start, bend, wards in (((9010, 1890), (8840, 1820), "off"), ((8290, 1890), (8470, 1830), "on")):
        merge = network.attach(start, among=[k for k in carriageways if network.roads[k][0]["destination"] == "Unterau"])
        line = curve([merge, bend, at])
        network.add(
            line if wards == "off" else line[::-1],
            highway="motorway_link", oneway="yes", ref="A 7", surface="asphalt",
        )  # fmt: skip
    return ring


def pass_road(ground, network, ring):
    """From the roundabout up the shoulder, over the gorge, past the lake, across the pass and out east."""
    price = {"easy": 0.065, "steep": 0.095, "turn_m": 40.0}
    tags = {"highway": "primary", "name": "Passstrasse", "ref": "L 28", "surface": "asphalt"}
    east_rim, west_rim = (8500.0, 3560.0), (8285.0, 3540.0)
    lake, saddle = (7780.0, 6060.0), (8250.0, 7550.0)
    network.add(lead(ground, network, ring[7], east_rim, **price), **tags)
    network.add([east_rim, west_rim], **tags | {"name": "Klammbruecke", "bridge": "yes", "layer": "1"})
    up = lead(ground, network, west_rim, lake, **price)
    network.add(up, **tags)
    network.add(lead(ground, network, lake, saddle, **price), **tags)
    network.add(lead(ground, network, saddle, (EDGE, 7440.0), **price), **tags)
    return lake, saddle


def side_valley(ground, network):
    """The western valley: a secondary road, its tertiary end, farms."""
    price = {"easy": 0.07, "steep": 0.11, "turn_m": 22.0}
    start = network.attach((2750.0, 1490.0))
    foot = (2330.0, 2120.0)
    network.add(
        [start, (2745.0, 1560.0), (2660.0, 1700.0), (2560.0, 1860.0), (2430.0, 2010.0), foot],
        highway="secondary", name="Tobelstrasse", ref="L 31", surface="asphalt",
    )  # fmt: skip
    chapel = (2310.0, 4030.0)
    network.add(
        lead(ground, network, foot, chapel, **price),
        highway="secondary", name="Tobelstrasse", ref="L 31", surface="asphalt",
    )  # fmt: skip
    end = (4130.0, 5750.0)
    network.add(
        lead(ground, network, chapel, end, **price), highway="tertiary", name="Hinterbergstrasse", surface="asphalt"
    )
    network.add(
        lead(ground, network, end, (3900.0, 7000.0), easy=0.09, steep=0.13, turn_m=14.0),
        highway="unclassified", name="Hinterbergstrasse", surface="compacted",
    )  # fmt: skip
    network.add(
        lead(ground, network, chapel, (1650.0, 5230.0), easy=0.09, steep=0.13, turn_m=14.0),
        highway="unclassified", name="Wildtal", surface="gravel",
    )  # fmt: skip


def settlement(network):
    """Innerau: a bent grid of residential streets beside the trunk road."""
    left, top, dx, dy = 2960.0, 1395.0, 115.0, 72.0

    def corner(i, j):
        return left + dx * i + 6.0 * ((i * 7 + j * 3) % 3), top + dy * j + 0.024 * dx * i + 5.0 * ((i + 2 * j) % 3)

    names = ["Oberdorf", "Kirchgasse", "Schulstrasse", "Wiesenweg"]
    for j, name in enumerate(names[:3]):
        kind = "living_street" if name == "Kirchgasse" else "residential"
        network.add([corner(i, j) for i in range(8)], highway=kind, name=name, surface="paving_stones" if j == 1 else "asphalt")
    for i in range(0, 8, 1):
        low = [corner(i, j) for j in range(3)]
        if i in (1, 4, 6):
            low.append(network.attach((low[-1][0] + 4.0, low[-1][1] + 120.0)))
        kind = "tertiary" if i == 4 else "residential"
        network.add(low, highway=kind, name="Bahnhofstrasse" if i == 4 else f"Gasse {i + 1}", surface="asphalt")
    for i in (0, 2, 5):
        a = network.attach((corner(i, 0)[0] + 50.0, corner(i, 0)[1] + 2.0))
        network.add([a, (a[0] + 3.0, a[1] + 34.0)], highway="service", service="driveway")
    a, b = network.attach((corner(3, 0)[0] + 55.0, corner(3, 0)[1])), corner(3, 0)
    network.add([a, (a[0] + 2.0, b[1] - 38.0)], highway="footway", surface="asphalt")
    c, d = network.attach((corner(6, 1)[0] + 40.0, corner(6, 1)[1])), network.attach((corner(6, 2)[0] + 42.0, corner(6, 2)[1]))
    network.add([c, d], highway="steps", surface="stone")
    cycle = offset(RIVER, -55.0)[::-1]
    network.add(
        simplify([p for p in cycle if 1200 < p[0] < 6900], 1.0), highway="cycleway", name="Talradweg", surface="compacted"
    )


def lake_hamlet(network, lake):
    """A few houses on the moraine: residential, service to the shore, a parking lane."""
    network.add([lake, (7735.0, 5990.0), (7690.0, 5940.0), (7620.0, 5925.0)], highway="residential", name="Am See", surface="asphalt")
    network.add([(7690.0, 5940.0), (7665.0, 5975.0), (7640.0, 5985.0)], highway="service", service="parking_aisle", surface="gravel")


def alps(ground, network):
    """Tracks to the alps and farms, and paths over the ridges; one track runs into the void."""
    for k, (x, y) in enumerate(
        [(1250, 2750), (3300, 2900), (5650, 2700), (9300, 3200), (9500, 4750), (6700, 6050), (6350, 7500),
         (9000, 8300), (3100, 5700), (5150, 8400), (1700, 700), (4600, 700), (6600, 800), (8900, 900), (9600, 1000)]
    ):  # fmt: skip
        line = join(ground, network, (float(x), float(y)), easy=0.11, steep=0.17, turn_m=12.0)
        kind = {"highway": "unclassified", "surface": "asphalt"} if k in (0, 11) else {
            "highway": "track", "tracktype": f"grade{2 + k % 4}", "surface": ("gravel", "ground", "grass")[k % 3]
        }  # fmt: skip
        network.add(line[::-1], name=f"Alpweg {k + 1}", **kind)
    # The survey lost the upper part of this slope, not its track.
    start = (LARGE_VOID[0] + 60.0, LARGE_VOID[1] - 30.0)
    network.add(
        join(ground, network, start, easy=0.12, steep=0.2, turn_m=12.0)[::-1],
        highway="track", tracktype="grade4", surface="ground", name="Alpweg 16",
    )  # fmt: skip
    for k, (a, b) in enumerate(
        [((3300, 2900), (4480, 4280)), ((5150, 8400), (6130, 8560)), ((6700, 6050), (6020, 5150)),
         ((1700, 5200), (700, 6400)), ((8250, 7550), (8560, 7120))]
    ):  # fmt: skip
        start = network.attach((float(a[0]), float(a[1])))
        line = lead(ground, network, start, (float(b[0]), float(b[1])), easy=0.3, steep=0.5, turn_m=3.0)
        network.add(line, highway="path", name=f"Steig {k + 1}", sac_scale="mountain_hiking", surface="rock")


def build(z, lake):
    """All roads over heights without voids `z` and the lake's mask."""
    from_gorge, _ = nearest_on_line(*centres(z.shape[0]), GORGE)
    ground, network = Ground(z, CELL_M, lake | (from_gorge < 40.0)), Network()
    fast_roads(network, z)
    ring = junction(network)
    side_valley(ground, network)
    settlement(network)
    shore, _ = pass_road(ground, network, ring)
    lake_hamlet(network, shore)
    alps(ground, network)
    motorways = [p for tags, p in network.roads if tags["highway"] == "motorway" and "tunnel" not in tags]
    network.bridge_over([RIVER, *motorways], 32.0)
    network.share_crossings()
    return network
