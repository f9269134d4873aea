"""Road lines that meet in shared points: joining, crossing, bridges and tunnels."""

import bisect
import math


def length_of(points):
    """Length of a polyline in metres."""
    total = 0.0
    for a, b in zip(points[:-1], points[1:]):
        dx, dy = b[0] - a[0], b[1] - a[1]
        total += math.sqrt(dx * dx + dy * dy)
    return total


def crossing(a, b, c, d):
    """Fractions along a–b and c–d where the two properly cross, or None."""
    ux, uy, vx, vy = b[0] - a[0], b[1] - a[1], d[0] - c[0], d[1] - c[1]
    det = ux * vy - uy * vx
    if det == 0.0:
        return None
    wx, wy = c[0] - a[0], c[1] - a[1]
    s, t = (wx * vy - wy * vx) / det, (wx * uy - wy * ux) / det
    return (s, t) if 0.0 < s < 1.0 and 0.0 < t < 1.0 else None


def offset(points, by_m):
    """The line moved `by_m` to its right (y grows south)."""
    out = []
    for k, (x, y) in enumerate(points):
        ax, ay = points[max(k - 1, 0)]
        bx, by = points[min(k + 1, len(points) - 1)]
        dx, dy = bx - ax, by - ay
        length = math.sqrt(dx * dx + dy * dy)
        out.append((x - dy / length * by_m, y + dx / length * by_m))
    return out


class Network:
    """Roads in the order they were built; each is a tag table and a list of points."""

    def __init__(self):
        self.roads = []

    def add(self, points, **tags):
        """A new road."""
        self.roads.append(({k.rstrip("_"): str(v) for k, v in tags.items()}, [tuple(p) for p in points]))
        return len(self.roads) - 1

    def attach(self, point, among=None):
        """The point of an existing road nearest to `point`: a vertex within 12 m, else a new one."""
        best = None
        for r in among if among is not None else range(len(self.roads)):
            tags, points = self.roads[r]
            if tags["highway"].startswith("motorway") and among is None:
                continue
            for k, (a, b) in enumerate(zip(points[:-1], points[1:])):
                dx, dy = b[0] - a[0], b[1] - a[1]
                t = ((point[0] - a[0]) * dx + (point[1] - a[1]) * dy) / (dx * dx + dy * dy)
                t = min(max(t, 0.0), 1.0)
                x, y = a[0] + t * dx, a[1] + t * dy
                d = (x - point[0]) * (x - point[0]) + (y - point[1]) * (y - point[1])
                if best is None or d < best[0]:
                    best = (d, r, k, (x, y))
        _, r, k, at = best
        points = self.roads[r][1]
        for end in (points[k], points[k + 1]):
            if (end[0] - at[0]) ** 2 + (end[1] - at[1]) ** 2 < 144.0:
                return end
        points.insert(k + 1, at)
        return at

    def cells(self, cell_of):
        """The routing cells that roads run through, motorways aside."""
        out = set()
        for tags, points in self.roads:
            if tags["highway"].startswith("motorway"):
                continue
            for a, b in zip(points[:-1], points[1:]):
                n = int(length_of([a, b]) / 15.0) + 1
                for k in range(n + 1):
                    t = k / n
                    out.add(cell_of((a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]))))
        return out

    def cut(self, index, spans):
        """Splits a road at distances `spans` = [(from, to, tags)]; the pieces within get those tags."""
        tags, points = self.roads[index]
        marks = [0.0]
        for a, b in zip(points[:-1], points[1:]):
            marks.append(marks[-1] + length_of([a, b]))

        def at(s):
            k = min(max(bisect.bisect_right(marks, s) - 1, 0), len(points) - 2)
            t = (s - marks[k]) / (marks[k + 1] - marks[k])
            return tuple(points[k][i] + t * (points[k + 1][i] - points[k][i]) for i in (0, 1))

        def between(s0, s1):
            inner = [p for m, p in zip(marks, points) if s0 + 1.0 < m < s1 - 1.0]
            return [points[0] if s0 <= 0 else at(s0), *inner, points[-1] if s1 >= marks[-1] else at(s1)]

        done, pieces = 0.0, []
        for s0, s1, extra in sorted(spans, key=lambda span: span[0]):
            s0, s1 = max(s0, 0.0), min(s1, marks[-1])
            if s0 - done > 2.0:
                pieces.append((tags, between(done, s0)))
            else:
                s0 = done
            pieces.append((tags | extra, between(s0, s1)))
            done = s1
        if marks[-1] - done > 2.0:
            pieces.append((tags, between(done, marks[-1])))
        self.roads[index] = pieces[0]
        self.roads += pieces[1:]

    def crossings(self, index, obstacle):
        """Distances along a road at which it crosses the polyline `obstacle`."""
        out, s = [], 0.0
        points = self.roads[index][1]
        for a, b in zip(points[:-1], points[1:]):
            d = length_of([a, b])
            for c, e in zip(obstacle[:-1], obstacle[1:]):
                if min(c[0], e[0]) <= max(a[0], b[0]) and max(c[0], e[0]) >= min(a[0], b[0]):
                    hit = crossing(a, b, c, e)
                    if hit:
                        out.append(s + hit[0] * d)
            s += d
        return sorted(out)

    def bridge_over(self, obstacles, half_m):
        """Puts every road that crosses one of `obstacles` on a bridge there."""
        for index in range(len(self.roads)):
            tags, _ = self.roads[index]
            if "tunnel" in tags or "bridge" in tags:
                continue
            spans = []
            for s in sorted(s for line in obstacles for s in self.crossings(index, line)):
                if spans and s - half_m < spans[-1][1] + 10.0:
                    spans[-1] = (spans[-1][0], s + half_m, spans[-1][2])
                else:
                    spans.append((s - half_m, s + half_m, {"bridge": "yes", "layer": "1"}))
            if spans:
                self.cut(index, spans)

    def share_crossings(self):
        """Gives two roads that cross on the ground a common point there."""
        ground = [k for k, (tags, _) in enumerate(self.roads) if "layer" not in tags]
        inserts = {k: {} for k in ground}
        for n, r in enumerate(ground):
            p = self.roads[r][1]
            box = (min(x for x, _ in p), max(x for x, _ in p), min(y for _, y in p), max(y for _, y in p))
            for q in ground[n + 1 :]:
                for j, (c, d) in enumerate(zip(self.roads[q][1][:-1], self.roads[q][1][1:])):
                    if max(c[0], d[0]) < box[0] or min(c[0], d[0]) > box[1]:
                        continue
                    if max(c[1], d[1]) < box[2] or min(c[1], d[1]) > box[3]:
                        continue
                    for i, (a, b) in enumerate(zip(p[:-1], p[1:])):
                        hit = crossing(a, b, c, d)
                        if hit:
                            at = (a[0] + hit[0] * (b[0] - a[0]), a[1] + hit[0] * (b[1] - a[1]))
                            inserts[r].setdefault(i, []).append((hit[0], at))
                            inserts[q].setdefault(j, []).append((hit[1], at))
        for r, by_segment in inserts.items():
            points = self.roads[r][1]
            for i in sorted(by_segment, reverse=True):
                points[i + 1 : i + 1] = [at for _, at in sorted(by_segment[i])]
