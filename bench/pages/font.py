"""Text of pages: shaped by HarfBuzz (hb-shape), drawn by FreeType into an atlas of coverage."""

import json
import os
import subprocess

import freetype

FOLDER = "/usr/share/fonts/truetype/dejavu"  # Debian's fonts-dejavu-core
FACES = {
    "sans": "DejaVuSans.ttf",
    "bold": "DejaVuSans-Bold.ttf",
    "serif": "DejaVuSerif.ttf",
    "mono": "DejaVuSansMono.ttf",
}
PHASES = 4  # positions of a glyph within a pixel, as browsers have them


class Face:
    def __init__(self, name):
        self.path = os.path.join(FOLDER, FACES[name])
        self.face = freetype.Face(self.path)
        self.units = self.face.units_per_EM
        self.shaped = {}

    def shape(self, text, size):
        """The glyphs of a line: number, first letter, place of the pen and advance in pixels."""
        if text not in self.shaped:
            done = subprocess.run(
                ["hb-shape", "--no-glyph-names", "--output-format=json", "--font-file", self.path, "--text", text],
                capture_output=True, text=True, check=True,
            )  # fmt: skip
            self.shaped[text] = json.loads(done.stdout)
        scale, pen, glyphs = size / self.units, 0, []
        for each in self.shaped[text]:
            glyphs.append((each["g"], each["cl"], (pen + each["dx"]) * scale, -each["dy"] * scale, each["ax"] * scale))
            pen += each["ax"]
        return glyphs

    def width(self, text, size):
        return sum(each[4] for each in self.shape(text, size))


class Atlas:
    """Coverage of glyphs in rows of one texture, one texel between them. A subpixel atlas has that of three stripes."""

    def __init__(self, side=512, subpixel=False):
        self.side, self.subpixel = side, subpixel
        self.bytes = bytearray(side * side * (4 if subpixel else 1))
        self.places, self.x, self.y, self.row = {}, 1, 1, 0
        self.faces = {name: Face(name) for name in FACES}

    def glyph(self, name, size, number, phase):
        """x, y, width, height in the atlas and the offset of the bitmap from the pen; null for an empty glyph."""
        key = name, size, number, phase
        if key not in self.places:
            self.places[key] = self.draw(*key)
        return self.places[key]

    def draw(self, name, size, number, phase):
        face = self.faces[name].face
        face.set_char_size(size * 64)
        face.set_transform(freetype.Matrix(0x10000, 0, 0, 0x10000), freetype.Vector(phase * 64 // PHASES, 0))
        target = freetype.FT_LOAD_TARGET_LCD if self.subpixel else freetype.FT_LOAD_TARGET_NORMAL
        face.load_glyph(number, freetype.FT_LOAD_RENDER | freetype.FT_LOAD_NO_HINTING | target)
        bitmap, step = face.glyph.bitmap, 3 if self.subpixel else 1
        width, height = bitmap.width // step, bitmap.rows
        if not width or not height:
            return None
        if self.x + width + 1 > self.side:
            self.x, self.y, self.row = 1, self.y + self.row + 1, 0
        if self.y + height + 1 > self.side:
            raise SystemExit("pages: the atlas is full")
        for y in range(height):
            row = bytes(bitmap.buffer[y * bitmap.pitch :][: width * step])
            self.put(self.x, self.y + y, row)
        place = self.x, self.y, width, height, face.glyph.bitmap_left, face.glyph.bitmap_top
        self.x, self.row = self.x + width + 1, max(self.row, height)
        return place

    def put(self, x, y, row):
        if self.subpixel:  # A8R8G8B8 in memory; alpha is the mean
            row = b"".join(bytes((row[i + 2], row[i + 1], row[i], sum(row[i : i + 3]) // 3)) for i in range(0, len(row), 3))
        at = (y * self.side + x) * (4 if self.subpixel else 1)
        self.bytes[at : at + len(row)] = row


def lines(face, text, size, width):
    """The text in lines that are not wider, broken at spaces."""
    found, begin, last = [], 0, None
    glyphs = face.shape(text, size)
    start = 0.0
    for _, letter, x, _, advance in glyphs:
        if text[letter] == " ":
            last = letter
        elif x + advance - start > width and last is not None and last > begin:
            found.append(text[begin:last])
            begin = last + 1
            start = next(each[2] for each in glyphs if each[1] >= begin)
            last = None
    return [*found, text[begin:]]
