"""Coverage of smooth straight edges at many angles beside exact areas, as JSON:

    python3 bench/claims/tools/smooth.py FOLDER

A frame has a triangle whose edge from vertex 0 to 1 crosses the target; only this edge is smooth, and the others are far
away. "largest" is the largest difference of a pixel from the area of its square inside of the edge, in 255ths; "plain" is
the same without smooth edges. "wide" is the number of pixels beyond the squares that the edge touches that are not 0 or
255. TRIPTYCH is the command; by default it is in the path.
"""

import json
import math
import os
import struct
import subprocess
import sys
import zlib

SIDE, ANGLES = 64, 72
HEAD = f"""triptych 1
target {SIDE} {SIDE} depth none
state lighting false
state cullmode none
stage 0 colorop selectarg2
stage 0 alphaop selectarg2
stage 0 colorarg2 tfactor
stage 0 alphaarg2 tfactor
state texturefactor 0xffffffff
state alphablendenable true
state srcblend one
state destblend invsrcalpha
state coveragetarget color
"""


def edge(number):
    """Two points far outside of the target on a line near its middle, in pixels of 1/256."""
    angle = 2 * math.pi * (number + 0.37) / ANGLES
    x, y = 32 + 5 * math.cos(3 * angle), 32 + 5 * math.sin(5 * angle)
    dx, dy = math.cos(angle), math.sin(angle)
    return [(round(256 * (x + s * dx)) / 256, round(256 * (y + s * dy)) / 256) for s in (-200, 200)]


def third(points):
    """A point to the right of the edge, so far that the two other edges miss the target."""
    (ax, ay), (bx, by) = points
    return ((ax + bx) / 2 - 2 * (by - ay), (ay + by) / 2 + 2 * (bx - ax))


def stream(smooth):
    text = HEAD + f"state edgeantialias {1 if smooth else 0}\n"
    for i in range(ANGLES):
        points = edge(i)
        rows = [f"    {2 * x / SIDE - 1:.9g} {1 - 2 * y / SIDE:.9g}\n" for x, y in (*points, third(points))]
        text += f"vertices corners{i} position:float2 {{\n{''.join(rows)}}}\n"
    for i in range(ANGLES):
        text += f"clear color 0 0 0 0\nbind vertices corners{i}\ndraw triangles 0 1\nframe\n"
    return text


def area(points, x, y):
    """The part of the square of the pixel to the right of the line."""
    (ax, ay), (bx, by) = points
    inside = [(px, py, (bx - ax) * (py - ay) - (by - ay) * (px - ax)) for px, py in ((x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1))]
    kept = []
    for (px, py, p), (qx, qy, q) in zip(inside, inside[1:] + inside[:1]):
        if p >= 0:
            kept.append((px, py))
        if (p >= 0) != (q >= 0):
            kept.append((px + (qx - px) * p / (p - q), py + (qy - py) * p / (p - q)))
    return sum(px * qy - qx * py for (px, py), (qx, qy) in zip(kept, kept[1:] + kept[:1])) / 2


def red(path):
    """The first channel of the pixels of a PNG with 8 bits a channel."""
    data, at, packed = open(path, "rb").read(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            width, height, channels = *struct.unpack(">2I", body[:8]), {0: 1, 2: 3, 6: 4}[body[9]]
        packed += body if kind == b"IDAT" else b""
        at += 12 + length
    raw, stride, above, rows = zlib.decompress(packed), width * channels, bytes(width * channels), []
    for y in range(height):
        form, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1 :][:stride])
        for i in range(stride):
            left, up, corner = (line[i - channels], above[i], above[i - channels]) if i >= channels else (0, above[i], 0)
            near = min((left, up, corner), key=lambda value: abs(left + up - corner - value))
            line[i] = line[i] + (0, left, up, (left + up) // 2, near)[form] & 255
        rows.append(line[::channels])
        above = bytes(line)
    return rows


def measure(folder, smooth):
    name = os.path.join(folder, "smooth" if smooth else "plain")
    with open(name + ".tri", "w", encoding="utf-8") as file:
        file.write(stream(smooth))
    command = [os.environ.get("TRIPTYCH", "triptych"), "render", name + ".tri", "--frames", "all", "--out", name + "%d.png"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    largest, wide, partly = 0, 0, 0
    for i in range(ANGLES):
        rows, points = red(f"{name}{i}.png"), edge(i)
        for y in range(SIDE):
            for x in range(SIDE):
                exact = 255 * area(points, x, y)
                largest = max(largest, abs(rows[y][x] - exact))
                partly += 0 < rows[y][x] < 255
                wide += exact in (0, 255) and rows[y][x] != exact
    return largest, wide, partly


def main():
    os.makedirs(sys.argv[1], exist_ok=True)
    largest, wide, partly = measure(sys.argv[1], True)
    plain = measure(sys.argv[1], False)[0]
    json.dump({"largest": largest, "plain": plain, "wide": wide, "partly": partly, "angles": ANGLES}, sys.stdout, indent=1)


main()
