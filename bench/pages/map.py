"""Countries of a part of the world: Natural Earth's borders (public domain) from the npm package world-atlas."""

import json
import math
import os
import subprocess
import tarfile
import tempfile

PACKAGE = "world-atlas@2.0.2"


def topology():
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["npm", "pack", PACKAGE, "--silent", "--pack-destination", folder], check=True, stdout=subprocess.DEVNULL)
        with tarfile.open(os.path.join(folder, os.listdir(folder)[0])) as archive:
            return json.load(archive.extractfile("package/countries-50m.json"))


class Map:
    """Arcs and polygons in pixels, by Mercator's projection: the window has its west, north and pixels a degree."""

    def __init__(self, west, north, scale):
        document = topology()
        self.west, self.scale = west, scale
        self.north = self.mercator(north)
        (across, down), (left, bottom) = document["transform"]["scale"], document["transform"]["translate"]
        self.arcs = []
        for arc in document["arcs"]:
            x = y = 0
            points = []
            for dx, dy in arc:
                x, y = x + dx, y + dy
                points.append(self.place(x * across + left, y * down + bottom))
            self.arcs.append(thinned(points))
        self.countries = [self.polygons(each) for each in document["objects"]["countries"]["geometries"]]

    @staticmethod
    def mercator(latitude):
        limited = max(-85.0, min(85.0, latitude))
        return math.degrees(math.log(math.tan(math.pi / 4 + math.radians(limited) / 2)))

    def place(self, longitude, latitude):
        return (longitude - self.west) * self.scale, (self.north - self.mercator(latitude)) * self.scale

    def polygons(self, geometry):
        """The outer rings of a country. Its holes are countries of their own."""
        rings = geometry["arcs"] if geometry["type"] == "MultiPolygon" else [geometry["arcs"]]
        return [self.ring(each[0]) for each in rings if each]

    def ring(self, arcs):
        points = []
        for number in arcs:
            arc = self.arcs[number] if number >= 0 else self.arcs[~number][::-1]
            points += arc if not points else arc[1:]
        return points


def thinned(points):
    """Without points that are nearer than a pixel to the last one, except for both ends."""
    kept = [points[0]]
    for point in points[1:-1]:
        if math.dist(point, kept[-1]) > 1.2:
            kept.append(point)
    return [*kept, points[-1]] if len(points) > 1 else kept


def inside(point, a, b, c):
    def side(p, q, r):
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    signs = side(a, b, point), side(b, c, point), side(c, a, point)
    return all(each >= 0 for each in signs) or all(each <= 0 for each in signs)


def cut(points, axis, limit, sign):
    """The part of a polygon on one side of a line parallel to an axis (Sutherland and Hodgman)."""
    kept = []
    for a, b in zip(points, [*points[1:], points[0]]):
        first, second = (a[axis] - limit) * sign, (b[axis] - limit) * sign
        if first >= 0:
            kept.append(a)
        if (first >= 0) != (second >= 0):
            part = first / (first - second)
            kept.append((a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part))
    return kept


def clipped(points, side, margin=8):
    for axis in (0, 1):
        for limit, sign in ((-margin, 1), (side + margin, -1)):
            points = cut(points, axis, limit, sign) if points else points
    return [p for p, q in zip(points, [*points[1:], *points[:1]]) if p != q]


def triangles(points):
    """Ears of a simple polygon, cut one after the other."""
    area = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, [*points[1:], points[0]]))
    left = list(range(len(points))) if area > 0 else list(range(len(points)))[::-1]
    found, tries = [], 0
    while len(left) > 3 and tries < len(left):
        i, j, k = left[-1], left[0], left[1]
        a, b, c = points[i], points[j], points[k]
        convex = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0
        others = (points[n] for n in left[2:-1] if points[n] not in (a, b, c))
        if convex and not any(inside(each, a, b, c) for each in others):
            found.append((i, j, k))
            left.pop(0)
            tries = 0
        else:
            left.append(left.pop(0))
            tries += 1
    return [*found, tuple(left)] if len(left) == 3 else found
