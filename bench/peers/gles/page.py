"""Rewrites a stream of a page as plain arrays, for the renderers that are no Triptych (page.h):

    triptych convert PAGE.trib PAGE.tri && python3 bench/peers/gles/page.py PAGE.tri OUT.page

It reads the first frame and knows only the calls that bench/pages/page.py writes. Ends with 2 at any other one.
"""

import struct
import sys

SHADERS = ("solid", "image", "mask", "subpixel", "line", "rounded", "rounded-image")  # as page.h
ARGUMENTS = {"texture": "image", "texture_alphareplicate": "mask"}
KINDS = ("flat", "round")
SETTLED = {
    "target 1024 1024 depth none", "state destblend invsrcalpha", "state destblend invsrccolor2",
    "vertexconstant 0 0.001953125 -0.001953125 -1 1", "state cullmode none",
    "state zenable false", "state srcblend one", "sampler 0 addressu clamp",
    "sampler 0 addressv clamp", "state scissortestenable false", "stage 0 alphaop modulate",
}  # fmt: skip


class Unknown(Exception):
    pass


def block(lines):
    """The words up to the end of a block."""
    words = []
    for line in lines:
        if line.strip() == "}":
            return words
        words += line.split()
    raise Unknown("the end of the file in a block")


def texels(form, words):
    data = bytes.fromhex("".join(words))
    if form == "A8":
        return data
    swapped = bytearray(data)  # from blue, green, red, alpha
    swapped[0::4], swapped[2::4] = data[2::4], data[0::4]
    return bytes(swapped)


def vertices(kind, words):
    columns = 5 if kind == "flat" else 10  # x, y, the colour, and numbers
    out = bytearray()
    for at in range(0, len(words), columns):
        x, y, ink, *rest = words[at : at + columns]
        color = int(ink, 16)
        out += struct.pack("<2f4B", float(x), float(y), color >> 16 & 255, color >> 8 & 255, color & 255, color >> 24)
        out += struct.pack(f"<{len(rest)}f", *map(float, rest))
    return bytes(out), len(words) // columns


class Page:
    def __init__(self, text):
        self.textures, self.order = {}, []
        self.vertices, self.indices = {kind: (b"", 0) for kind in KINDS}, {kind: [] for kind in KINDS}
        self.colors = {}
        self.draws, self.clear, self.state = [], (0.0, 0.0, 0.0, 0.0), {}
        lines = iter(text.splitlines()[1:])
        for line in lines:
            if line == "frame":
                break
            self.line(line, lines)

    def line(self, line, lines):
        words = line.split()
        if line in SETTLED or not words or words[0] == "#":
            return
        if line.endswith("{"):
            self.resource(words, lines)
        elif words[:2] == ["clear", "color"]:
            self.clear = tuple(map(float, words[2:6]))
        elif words[:2] == ["draw-indexed", "triangles"]:
            self.draw(int(words[3]), int(words[4]))
        elif words[0] in ("bind", "state", "sampler", "stage", "vertexshader", "pixelshader"):
            self.state[" ".join(words[:-1])] = words[-1]
        else:
            raise Unknown(line)

    def resource(self, words, lines):
        data = block(lines)
        if words[0] == "texture" and words[2] == "2d" and words[3] in ("A8", "A8R8G8B8"):
            self.textures[words[1]] = (words[3] == "A8", int(words[4]), int(words[5]), texels(words[3], data))
            self.order.append(words[1])
        elif words[0] == "vertices" and words[1] in KINDS:
            self.vertices[words[1]] = vertices(words[1], data)
            self.colors[words[1]] = data[2 :: 5 if words[1] == "flat" else 10]
        elif words[0] == "indices" and words[2] == "16":
            self.indices[words[1].split(".")[0]] = list(map(int, data))
        elif words[0] != "shader":
            raise Unknown(" ".join(words))

    def shader(self):
        """The name of the pixel shader, or of that which the stage replaces."""
        if self.state["pixelshader"] != "none":
            return self.state["pixelshader"]
        return "solid" if self.state["stage 0 colorop"] == "disable" else ARGUMENTS[self.state["stage 0 colorarg1"]]

    def draw(self, first, triangles):
        state = self.state
        shader, kind = self.shader(), state["bind vertices"]
        sampled = shader in ("image", "mask", "subpixel", "rounded-image")
        inks = [self.colors[kind][i] for i in self.indices[kind][first : first + 3 * triangles]]
        shaded = any(len(set(inks[i : i + 3])) > 1 for i in range(0, len(inks), 3))
        self.draws.append((
            SHADERS.index(shader), self.order.index(state["bind texture"]) if sampled else 0xFFFFFFFF,
            sampled and state["sampler 0 magfilter"] == "linear", state["state alphablendenable"] == "true",
            shaded, KINDS.index(kind), first, 3 * triangles,
        ))  # fmt: skip

    def bytes(self):
        out = struct.pack("<4s3I", b"PAGE", len(self.order), len(self.draws), 0)
        out += struct.pack("<4I", *(self.vertices[kind][1] for kind in KINDS), *(len(self.indices[kind]) for kind in KINDS))
        out += struct.pack("<4f", *self.clear)
        out += b"".join(struct.pack("<8I", *each) for each in self.draws)
        out += b"".join(self.vertices[kind][0] for kind in KINDS)
        for kind in KINDS:
            indices = struct.pack(f"<{len(self.indices[kind])}H", *self.indices[kind])
            out += indices + bytes(-len(indices) % 4)
        for alpha, width, height, data in map(self.textures.get, self.order):
            out += struct.pack("<3I", alpha, width, height) + data + bytes(-len(data) % 4)
        return out


def main():
    if len(sys.argv) != 3:
        print("usage: page.py PAGE.tri OUT.page", file=sys.stderr)
        return 2
    try:
        with open(sys.argv[1], encoding="utf-8") as file:
            page = Page(file.read())
    except (Unknown, KeyError, ValueError) as error:
        print(f"page: {sys.argv[1]}: {error}: expected a stream of bench/pages", file=sys.stderr)
        return 2
    with open(sys.argv[2], "wb") as file:
        file.write(page.bytes())
    return 0


sys.exit(main())
