"""A triangle, its edges and the pixels that Triptych draws, as an SVG picture; after figures 8 and 9 of the thesis.

    python3 bench/claims/tools/triangle.py draw          the picture
    python3 bench/claims/tools/triangle.py count NUMBER  NUMBER random triangles: {"triangles", "pixels", "wrong"}

The program evaluates three edge functions at the centre of each pixel in whole numbers. A pixel is inside if all three are
positive; a centre on an edge is inside if the edge is a top or a left one. `wrong` is the number of pixels that Triptych
draws and the edge functions do not, or the reverse. Triptych's window coordinates have 8 bits after the point, so corners are
multiples of 1/16.
"""

import json
import random
import struct
import subprocess
import sys
import zlib

SIDE, UNIT, SCALE = 24, 16, 26  # pixels of the target, corners' units a pixel, SVG units a pixel


def stream(corners):
    """Positions in pixels of the target. Pixel centres are at whole numbers plus a half, as in the edge functions below."""
    rows = "\n".join(f"    {x / UNIT:.6f} {y / UNIT:.6f} 0 1  {color}" for (x, y), color in zip(corners, COLORS))
    return (
        f"triptych 1\ntarget {SIDE} {SIDE}\nstate cullmode none\nstate lighting false\nstate zenable false\n"
        f"vertices corners positiont:float4 diffuse:color {{\n{rows}\n}}\nbind vertices corners\n"
        "clear color 0 0 0 0 depth 1\ndraw triangles 0 1\n"
    )


COLORS = ("ffe04030", "ff30b060", "ff3060e0")


def rendered(corners):
    """The pixels as rows of (r, g, b, a), through a PNG picture."""
    run = subprocess.run(
        ["triptych", "render", "-", "--format", "png", "--out", "-"], input=stream(corners).encode(), capture_output=True, check=False
    )
    if run.returncode:
        sys.exit(f"triangle.py: {run.stderr.decode().strip()}")
    return rows_of(run.stdout)


def rows_of(png):
    at, data = 8, b""
    while at < len(png):
        length, kind = struct.unpack_from(">I4s", png, at)
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack_from(">IIBB", png, at + 8)
        if kind == b"IDAT":
            data += png[at + 8 : at + 8 + length]
        at += length + 12
    if (depth, color) != (8, 6):
        sys.exit(f"triangle.py: the picture has {depth} bits and colour type {color}, expected 8 and 6")
    lines, step, above = zlib.decompress(data), 4 * width, bytes(4 * width)
    rows = []
    for y in range(height):
        begin = y * (step + 1)
        above = unfiltered(lines[begin], lines[begin + 1 : begin + 1 + step], above)
        rows.append([tuple(above[4 * x : 4 * x + 4]) for x in range(width)])
    return rows


def unfiltered(kind, line, above):
    """A line of a PNG picture after its filter (PNG specification, section 9)."""
    result = bytearray(line)
    for i, byte in enumerate(line):
        a, b, c = (result[i - 4] if i > 3 else 0), above[i], (above[i - 4] if i > 3 else 0)
        p = a + b - c
        nearest = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
        result[i] = (byte + (0, a, b, (a + b) // 2, nearest)[kind]) & 255
    return bytes(result)


# --- Edge functions -------------------------------------------------------------------------------------------


def edges(corners):
    """(a, b, c) of each edge: a x + b y + c is positive inside; corners in any winding."""
    (x0, y0), (x1, y1), (x2, y2) = corners
    turned = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
    order = corners if turned > 0 else corners[::-1]
    result = []
    for (xa, ya), (xb, yb) in zip(order, order[1:] + order[:1]):
        a, b = ya - yb, xb - xa
        result.append((a, b, -(a * xa + b * ya)))
    return result if turned else []


def inside(functions, x, y):
    """At the centre of pixel (x, y)."""
    centre = (UNIT * x + UNIT // 2, UNIT * y + UNIT // 2)
    for a, b, c in functions:
        value = a * centre[0] + b * centre[1] + c
        top_or_left = a > 0 or a == 0 and b > 0
        if value < 0 or value == 0 and not top_or_left:
            return False
    return bool(functions)


def random_corners(source):
    return [(source.randrange(-4 * UNIT, (SIDE + 4) * UNIT), source.randrange(-4 * UNIT, (SIDE + 4) * UNIT)) for _ in range(3)]


def count(number):
    source, pixels, wrong = random.Random(7), 0, 0
    for _ in range(number):
        corners = random_corners(source)
        functions, rows = edges(corners), rendered(corners)
        for y in range(SIDE):
            for x in range(SIDE):
                expected = inside(functions, x, y)
                pixels += expected
                wrong += expected != (rows[y][x][3] != 0)
    print(json.dumps({"triangles": number, "pixels": pixels, "wrong": wrong}))


# --- The picture ----------------------------------------------------------------------------------------------


def svg(corners):
    rows, functions, side = rendered(corners), edges(corners), SIDE * SCALE
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{side}" height="{side}" viewBox="0 0 {side} {side}">',
        f'<rect width="{side}" height="{side}" fill="#fff"/>',
    ]
    for y in range(SIDE):
        for x in range(SIDE):
            r, g, b, a = rows[y][x]
            fill = f"rgb({r},{g},{b})" if a else "#f2f4f6"
            parts.append(f'<rect x="{x * SCALE}" y="{y * SCALE}" width="{SCALE}" height="{SCALE}" fill="{fill}" stroke="#d8dee4"/>')
            dot = "#1c2733" if inside(functions, x, y) else "#b8c1c9"
            parts.append(f'<circle cx="{(x + 0.5) * SCALE}" cy="{(y + 0.5) * SCALE}" r="2.4" fill="{dot}"/>')
    for i in range(0, SIDE + 1, 4):
        parts.append(f'<path d="M{i * SCALE} 0V{side}M0 {i * SCALE}H{side}" stroke="#7b8792" stroke-width="1.6"/>')
    outline = " ".join(f"{x * SCALE / UNIT:.2f},{y * SCALE / UNIT:.2f}" for x, y in corners)
    parts.append(f'<polygon points="{outline}" fill="none" stroke="#c23b2e" stroke-width="2.5"/></svg>')
    return "".join(parts)


def main():
    if sys.argv[1:2] == ["count"]:
        count(int(sys.argv[2]))
    else:
        print(svg([(38, 44), (340, 130), (120, 356)]))


main()
