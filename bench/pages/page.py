"""A page as a browser draws it: rectangles of two triangles in batches of equal state, written as a draw stream."""

import os
import subprocess
import tempfile

SIDE = 1024

VERTEX = """vs_3_0
def c1, 0, 1, 0, 0
dcl_position v0
dcl_color v1
dcl_texcoord v2
dcl_position o0
dcl_color o1
dcl_texcoord o2.xy
mad o0.xy, v0, c0, c0.zwzw
mov o0.zw, c1.xxxy
mov o1, v1
mov o2.xy, v2"""

# Places within a rounded rectangle: x and y from its centre, its half sides less the radius, the radius and 1/2.
ROUND = VERTEX.replace("dcl_position o0", "dcl_texcoord1 v3\ndcl_texcoord2 v4\ndcl_position o0").replace(
    "mad o0", "dcl_texcoord1 o3\ndcl_texcoord2 o4.x\nmad o0"
) + "\nmov o3, v3\nmov o4.x, v4.x"

COVERAGE = """abs r1.xy, v2
sub r1.xy, r1, v2.zwzw
max r1.xy, r1, c0.x
dp2add r1.x, r1, r1, c0.y
rsq r1.y, r1.x
mad_sat r1.x, -r1.x, r1.y, v3.x"""
CORNERS = "def c0, 0, 1e-6, 0, 0\ndcl_color v0\ndcl_texcoord v1.xy\ndcl_texcoord1 v2\ndcl_texcoord2 v3.x\n"

# By name: the vertex shader, the pixel shader. Colours are multiplied by their alpha.
SHADERS = {
    "solid": ("flat", "dcl_color v0\nmov oC0, v0"),
    "image": ("flat", "dcl_color v0\ndcl_texcoord v1.xy\ndcl_2d s0\ntexld r0, v1, s0\nmul oC0, r0, v0"),
    "mask": ("flat", "dcl_color v0\ndcl_texcoord v1.xy\ndcl_2d s0\ntexld r0, v1, s0\nmul oC0, v0, r0.w"),
    "line": ("flat", "dcl_color v0\ndcl_texcoord v1.xy\nadd_sat r0.x, v1.y, -v1_abs.x\nmul oC0, v0, r0.x"),
    "rounded": ("round", CORNERS + COVERAGE + "\nmul oC0, v0, r1.x"),
    "rounded-image": (
        "round",
        CORNERS + "dcl_2d s0\ntexld r0, v1, s0\nmul r0, r0, v0\n" + COVERAGE + "\nmul oC0, r0, r1.x",
    ),
}


def color(red, green, blue, alpha=1.0):
    """A colour of 0 to 255 and its alpha, multiplied by it: AARRGGBB."""
    return "".join(f"{round(each):02x}" for each in (alpha * 255, red * alpha, green * alpha, blue * alpha))


def grey(value, alpha=1.0):
    return color(value, value, value, alpha)


WHITE = "ffffffff"


class Batch:
    """Draws of equal state: a range of the indices of flat or round vertices."""

    def __init__(self, state, kind, first):
        self.state, self.kind, self.first, self.count = state, kind, first, 0


class Page:
    def __init__(self, name, comment, atlas):
        self.name, self.comment, self.atlas = name, comment, atlas
        self.textures = {}
        self.vertices = {"flat": [], "round": []}
        self.indices = {"flat": [], "round": []}
        self.frames, self.damage = [], None

    # --- Textures ---

    def texture(self, name, form, width, height, data, mips=False):
        self.textures[name] = (form, width, height, bytes(data), mips)

    def picture(self, name, image, mips=False):
        """A picture of PIL, its colours multiplied by alpha."""
        data = bytearray()
        for red, green, blue, alpha in image.convert("RGBA").getdata():
            data += bytes(round(each * alpha / 255) for each in (blue, green, red)) + bytes((alpha,))
        self.texture(name, "A8R8G8B8", *image.size, data, mips)

    # --- Frames ---

    def frame(self, damage=None, move=None, clear=None):
        """Begins a frame. Only the damaged rectangle is drawn, after a copy of a part of the target: x, y, width,
        height, and the new x and y."""
        self.damage = damage
        self.frames.append({"damage": damage, "move": move, "clear": clear, "batches": []})

    def visible(self, x, y, width, height):
        left, top, wide, high = self.damage or (0, 0, SIDE, SIDE)
        return x < left + wide and left < x + width and y < top + high and top < y + height

    def batch(self, kind, *state):
        batches = self.frames[-1]["batches"]
        if not batches or batches[-1].state != state:
            batches.append(Batch(state, kind, len(self.indices[kind])))
        return batches[-1]

    def corners(self, batch, vertices, order=(0, 1, 2, 2, 1, 3)):
        kind = batch.kind
        base = len(self.vertices[kind])
        self.vertices[kind] += vertices
        self.indices[kind] += [base + i for i in order]
        batch.count += len(order)

    # --- Drawing ---

    def quad(self, shader, texture, filters, blend, x, y, width, height, colors, u=(0, 1), v=(0, 1)):
        """colors: one, or those of the corners upper left, upper right, lower left, lower right."""
        if not self.visible(x, y, width, height):
            return
        colors = [colors] * 4 if isinstance(colors, str) else colors
        batch = self.batch("flat", shader, texture, filters, blend)
        places = [(x, y), (x + width, y), (x, y + height), (x + width, y + height)]
        texels = [(u[0], v[0]), (u[1], v[0]), (u[0], v[1]), (u[1], v[1])]
        self.corners(batch, [(*place, ink, *at) for place, ink, at in zip(places, colors, texels)])

    def rectangle(self, x, y, width, height, colors):
        solid = all(each[:2] == "ff" for each in ([colors] if isinstance(colors, str) else colors))
        self.quad("solid", None, "point", not solid, x, y, width, height, colors)

    def image(self, texture, x, y, width, height, ink=WHITE, filters="linear", u=(0, 1), v=(0, 1)):
        self.quad("image", texture, filters, True, x, y, width, height, ink, u, v)

    def rounded(self, x, y, width, height, radius, ink, texture=None, filters="linear", u=(0, 1), v=(0, 1)):
        if not self.visible(x, y, width, height):
            return
        batch = self.batch("round", "rounded-image" if texture else "rounded", texture, filters, True)
        colors = [ink] * 4 if isinstance(ink, str) else ink
        half = width / 2, height / 2
        vertices = []
        for i in range(4):
            right, lower = i % 2, i // 2
            vertices.append((
                x + right * width, y + lower * height, colors[i], u[right], v[lower],
                half[0] * (2 * right - 1), half[1] * (2 * lower - 1), half[0] - radius, half[1] - radius, radius + 0.5,
            ))  # fmt: skip
        self.corners(batch, vertices)

    def shadow(self, x, y, width, height, blur, ink):
        """The texture "shadow", a blurred square of 64 texels with a border of 24, as nine parts."""
        across = [(x - blur, 0), (x + blur, 0.5), (x + width - blur, 0.5), (x + width + blur, 1)]
        down = [(y - blur, 0), (y + blur, 0.5), (y + height - blur, 0.5), (y + height + blur, 1)]
        for (top, above), (bottom, below) in zip(down, down[1:]):
            for (left, before), (right, after) in zip(across, across[1:]):
                self.quad("mask", "shadow", "linear", True, left, top, right - left, bottom - top, ink, (before, after), (above, below))

    def text(self, face, size, x, baseline, words, ink):
        """Returns the place after the text. Glyphs are drawn from the atlas, texel by texel."""
        side = self.atlas.side
        for number, _, place, down, advance in self.atlas.faces[face].shape(words, size):
            quarters = round((x + place) * 4)
            found = self.atlas.glyph(face, size, number, quarters % 4)
            if found:
                u, v, width, height, left, top = found
                at = quarters // 4 + left, round(baseline + down) - top
                self.quad("mask", "glyphs", "point", True, *at, width, height, ink,
                          (u / side, (u + width) / side), (v / side, (v + height) / side))  # fmt: skip
            end = x + place + advance
        return end

    def line(self, points, width, ink):
        """Lines of a width in pixels, a rectangle each, with edges that fade across a pixel."""
        half = width / 2 + 1
        for (ax, ay), (bx, by) in zip(points, points[1:]):
            length = ((bx - ax) ** 2 + (by - ay) ** 2) ** 0.5
            if not length or not self.visible(min(ax, bx) - half, min(ay, by) - half, abs(bx - ax) + width + 2, abs(by - ay) + width + 2):
                continue
            across = -(by - ay) / length * half, (bx - ax) / length * half
            batch = self.batch("flat", "line", None, "point", True)
            self.corners(batch, [
                (ax - across[0], ay - across[1], ink, -half, width / 2 + 0.5), (bx - across[0], by - across[1], ink, -half, width / 2 + 0.5),
                (ax + across[0], ay + across[1], ink, half, width / 2 + 0.5), (bx + across[0], by + across[1], ink, half, width / 2 + 0.5),
            ])  # fmt: skip

    def polygon(self, points, triangles, ink):
        batch = self.batch("flat", "solid", None, "point", False)
        self.corners(batch, [(*point, ink, 0, 0) for point in points], [i for each in triangles for i in each])

    # --- The stream ---

    def write(self, folder, command):
        """Writes the container FOLDER/page-NAME.trib."""
        with tempfile.NamedTemporaryFile("w", suffix=".tri") as file:
            file.write("\n".join(self.stream()) + "\n")
            file.flush()
            path = os.path.join(folder, f"page-{self.name}.trib")
            subprocess.run([command, "convert", file.name, path], check=True)
        print(f"{path}: {os.path.getsize(path)} bytes, {sum(map(len, self.indices.values())) // 3} triangles, "
              f"{[len(frame['batches']) for frame in self.frames]} draws")  # fmt: skip

    def stream(self):
        yield "triptych 1"
        yield from ("# " + line for line in self.comment.strip().splitlines())
        yield f"target {SIDE} {SIDE} depth none"
        self.texture("glyphs", "A8", self.atlas.side, self.atlas.side, self.atlas.bytes)
        used = {batch.state[1] for frame in self.frames for batch in frame["batches"]}
        for name, (form, width, height, data, mips) in self.textures.items():
            if name in used:
                yield f"texture {name} 2d {form} {width} {height} {'levels 0 mips ' if mips else ''}bytes {{"
                yield from (data[i : i + 128].hex() for i in range(0, len(data), 128))
                yield "}"
        shaders = {batch.state[0] for frame in self.frames for batch in frame["batches"]}
        for name, text in ("flat", VERTEX), ("round", ROUND):
            if any(SHADERS[each][0] == name for each in shaders):
                yield from (f"shader {name}.vertex {{", text, "}")
        for name in sorted(shaders):
            yield from (f"shader {name} {{", "ps_3_0", SHADERS[name][1], "}")
        for kind in filter(self.vertices.get, self.vertices):
            extra = " texcoord1:float4 texcoord2:float1" if kind == "round" else ""
            yield f"vertices {kind} position:float2 diffuse:color texcoord:float2{extra} {{"
            yield from (" ".join(each if isinstance(each, str) else f"{each:.6g}" for each in vertex) for vertex in self.vertices[kind])
            yield "}"
            bits = 16 if len(self.vertices[kind]) <= 65536 else 32
            yield f"indices {kind}.indices {bits} {{"
            indices = self.indices[kind]
            yield from (" ".join(map(str, indices[i : i + 60])) for i in range(0, len(indices), 60))
            yield "}"
        yield "vertexconstant 0 0.001953125 -0.001953125 -1 1"
        yield "state cullmode none"
        yield "state zenable false"
        yield "state srcblend one"
        yield "state destblend invsrcalpha"
        yield "sampler 0 addressu clamp"
        yield "sampler 0 addressv clamp"
        for frame in self.frames:
            yield from self.calls(frame)
            yield "frame"

    def calls(self, frame):
        if frame["move"]:
            x, y, width, height, left, top = frame["move"]
            yield f"copy target part {x} {y} {width} {height} to target part {left} {top} {width} {height}"
        yield f"state scissortestenable {'true' if frame['damage'] else 'false'}"
        if frame["damage"]:
            yield "scissor " + " ".join(map(str, frame["damage"]))
        if frame["clear"]:
            yield "clear color " + frame["clear"]
        now = {}
        for batch in frame["batches"]:
            shader, texture, filters, blend = batch.state
            vertex = SHADERS[shader][0]
            wanted = {
                "bind vertices": batch.kind, "bind indices": batch.kind + ".indices",
                "vertexshader": vertex + ".vertex", "pixelshader": shader,
                "state alphablendenable": "true" if blend else "false",
            }  # fmt: skip
            if texture:
                mips = self.textures[texture][4]
                filtered = "linear" if filters == "linear" else "point"
                wanted |= {
                    "bind texture": texture, "sampler 0 magfilter": filtered, "sampler 0 minfilter": filtered,
                    "sampler 0 mipfilter": "linear" if mips else "none",
                }  # fmt: skip
            yield from (f"{call} {value}" for call, value in wanted.items() if now.get(call) != value)
            now |= wanted
            yield f"draw-indexed triangles 0 {batch.first} {batch.count // 3}"
