"""Writes two draw streams of 2000 small rectangles, with one kind of blending and with a change before each.

    python3 bench/claims/tools/blending.py FOLDER

same.tri, changing.tri: each rectangle is a draw; in the second, two kinds of blending take turns.
"""

import os
import sys

COUNT = 2000
HEAD = """triptych 1
target 512 512
convention depthrange minus
state lighting false
state cullmode none
state zenable false
state texturefactor 0x80c04080
stage 0 colorop selectarg1
stage 0 colorarg1 tfactor
stage 0 alphaop selectarg1
stage 0 alphaarg1 tfactor
state alphablendenable true
state srcblend srcalpha
state destblend invsrcalpha
vertices corners position:float4 {
"""


def corners(i):
    """Strip of rectangle i: 8 x 8 pixels of the 512 x 512."""
    x, y = -1 + (i % 50) * 0.04, -1 + (i // 50) * 0.045
    return "".join(f"    {x + a * 0.03125:.6f} {y + b * 0.03125:.6f} 0 1\n" for b in (0, 1) for a in (0, 1))


def stream(changing):
    lines = [HEAD + "".join(corners(i) for i in range(COUNT)) + "}\nbind vertices corners\nclear color 0 0 0 1\n"]
    for i in range(COUNT):
        if changing:
            lines.append(f"state destblend {('invsrcalpha', 'one')[i % 2]}\n")
        lines.append(f"draw strip {4 * i} 2\n")
    return "".join(lines)


def main():
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    for name, changing in (("same", False), ("changing", True)):
        with open(os.path.join(folder, name + ".tri"), "w", encoding="utf-8") as file:
            file.write(stream(changing))


main()
