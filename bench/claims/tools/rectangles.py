"""Writes the draw streams of claims G4, G6 and G7 into a folder:

    python3 bench/claims/tools/rectangles.py FOLDER

whole.tri, partial.tri: 64 rectangles of a picture, blended, whose edges are those of blocks of 4x4 pixels, and within blocks.
words.tri, bytes.tri: the same rectangles, half of them below others, in a target of four bytes and of one byte a pixel.
masked.tri, drawn.tri: a rectangle below a mask at a place and in a box, and the rectangle that should remain.
outside.tri, nothing.tri: the box is beside the mask, and nothing is drawn. empty.tri, plain.tri: the box is empty, and no mask.
"""

import os
import sys

SIDE = 512
HEAD = f"""triptych 1
target {SIDE} {SIDE} depth d24x8
convention depthrange minus
state lighting false
state cullmode none
texture picture 2d A8R8G8B8 64 64 gradient
"""
STATES = """stage 0 colorop modulate
stage 0 alphaop modulate
stage 0 colorarg2 tfactor
stage 0 alphaarg2 tfactor
state texturefactor 0x80804020
state alphablendenable true
state srcblend one
state destblend invsrcalpha
clear color 0.25 0.5 0.75 1 depth 1
"""


def rectangle(left, top, width, height, depth):
    """Two triangles in pixels, as a strip, with a texel a pixel."""
    rows = []
    for y in (top, top + height):
        for x in (left, left + width):
            place = f"{2 * x / SIDE - 1:.9g} {1 - 2 * y / SIDE:.9g} {depth} 1"
            rows.append(f"    {place}   {(x - left) / 64:.9g} {(y - top) / 64:.9g}\n")
    return "".join(rows)


def grid(offset, size, before="", after="", depth="0.5"):
    """64 rectangles, each in a cell of 64 pixels; every second one is nearer with `depth` "both"."""
    places = []
    for i in range(64):
        nearer = "0.25" if depth == "both" and i % 2 else "0.5"
        places.append(rectangle(i % 8 * 64 + offset, i // 8 * 64 + offset, size, size, nearer))
    draws = "".join(f"draw strip {4 * i} 2\n" for i in list(range(1, 64, 2)) + list(range(64)))
    corners = "vertices corners position:float4 texcoord:float2 {\n" + "".join(places) + "}\n"
    return HEAD + corners + before + "bind vertices corners\nbind texture picture\n" + STATES + draws + after


def masked(mask, color, scissor=""):
    """A rectangle over the whole target in one colour, which is multiplied by its alpha."""
    corners = "vertices corners position:float4 texcoord:float2 {\n" + rectangle(0, 0, SIDE, SIDE, "0.5") + "}\n"
    states = STATES.replace("modulate", "selectarg2").replace("0x80804020", color)
    texture = "texture mask 2d A8 200 100 checker 1 80000000 80000000\n"
    return HEAD + texture + corners + "bind vertices corners\n" + states + mask + scissor + "draw strip 0 2\n"


BYTES = (
    "texture shape 2d R8 512 512 empty\nattach color shape depthformat d24x8\n",
    "attach none\nclear color 0 0 0 1\nstate alphablendenable false\nbind texture shape\n"
    "stage 0 colorop selectarg1\nstage 0 alphaop selectarg1\nbind vertices whole\ndraw strip 0 2\n",
)
WHOLE = "vertices whole position:float4 texcoord:float2 {\n" + rectangle(0, 0, 64, 64, "0.5") + "}\n"
RED, HALF = "0xffc86432", "0x80643219"  # c8 64 32 times 128 / 255, rounded
STREAMS = {
    "whole": grid(4, 56),
    "partial": grid(3, 57),
    "words": grid(3, 58, depth="both"),
    "bytes": grid(3, 58, BYTES[0], WHOLE + BYTES[1], "both"),
    "masked": masked("clipmask mask 120 200 150 150 400 80\n", RED),
    "drawn": masked("", HALF, "scissor 150 200 170 30\nstate scissortestenable true\n"),
    "outside": masked("clipmask mask 120 200 0 0 100 512\n", RED),
    "nothing": masked("", "0x00000000"),
    "empty": masked("clipmask mask 120 200 0 0 0 0\n", RED),
    "plain": masked("", RED),
}


def main():
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    for name, text in STREAMS.items():
        with open(os.path.join(folder, name + ".tri"), "w", encoding="utf-8") as file:
            file.write(text)


main()
