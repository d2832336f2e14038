"""Pictures of programs in one PNG, side by side, at half their size.

    python3 bench/gles/sheet.py OUT.png PICTURE.ppm...

A pixel is the mean of four. Pictures (binary PPM, 8 bits a channel) that are not as high as the highest one have black
below them. Ends with 2 if a file is not such a picture.
"""

import re
import struct
import sys
import zlib

HEAD = re.compile(rb"P6\s+(\d+)\s+(\d+)\s+255\s")


def read(path):
    """Rows of half the width, a bytes object of RGB each."""
    with open(path, "rb") as file:
        data = file.read()
    head = HEAD.match(data)
    if not head:
        sys.exit(print(f"sheet: {path}: expected a binary PPM with 255 levels", file=sys.stderr) or 2)
    width, height = int(head[1]), int(head[2])
    rows = [data[head.end() + 3 * width * y :][: 3 * width] for y in range(height)]
    return [halved(above, below, width) for above, below in zip(rows[::2], rows[1::2])]


def halved(above, below, width):
    wide = 6 * (width // 2)
    means = bytearray()
    for at in range(0, wide, 6):
        for c in range(at, at + 3):
            means.append((above[c] + above[c + 3] + below[c] + below[c + 3] + 2) // 4)
    return bytes(means)


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def write(path, rows):
    """Rows of RGB as a PNG without filters."""
    head = struct.pack(">IIBBBBB", len(rows[0]) // 3, len(rows), 8, 2, 0, 0, 0)
    packed = zlib.compress(b"".join(b"\0" + row for row in rows), 9)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", packed) + chunk(b"IEND", b""))


def sheet(path, pictures):
    parts = [read(picture) for picture in pictures]
    height = max(map(len, parts))
    black = [bytes(len(part[0])) for part in parts]
    write(path, [b"".join(part[y] if y < len(part) else none for part, none in zip(parts, black)) for y in range(height)])


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(print("usage: sheet.py OUT.png PICTURE.ppm...", file=sys.stderr) or 2)
    sheet(sys.argv[1], sys.argv[2:])
