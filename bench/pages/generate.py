"""Writes the streams of pages, bench/streams/pages/page-*.trib:

    python3 bench/pages/generate.py [--triptych COMMAND] [--folder FOLDER] [NAME...]

The pages are made of real letters and pictures, and are committed, so that nobody needs this program to draw them.
It needs these packages of Debian, and npm: libharfbuzz-bin, python3-freetype, python3-pil, fonts-dejavu-core (letters),
tango-icon-theme (icons, public domain), python3-skimage (photographs, public domain and CC0). docs/scenes.md describes
the pages.
"""

import argparse
import os
import sys

from PIL import Image, ImageDraw, ImageFilter

sys.dont_write_bytecode = True
import map as world  # noqa: E402
from font import Atlas, lines  # noqa: E402
from page import SIDE, WHITE, Page, color, grey, linear  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
PHOTOGRAPHS = "/usr/lib/python3/dist-packages/skimage/data"
ICONS = "/usr/share/icons/Tango/32x32"
NAMES = {"chelsea.png": "Chelsea", "coffee.png": "Coffee", "rocket.jpg": "Launch", "hubble_deep_field.jpg": "Deep field",
         "grass.png": "Grass", "gravel.png": "Gravel"}  # fmt: skip
SHELL = "mimetypes/text-x-generic apps/system-file-manager categories/applications-games devices/computer places/folder apps/utilities-terminal".split()
INK, FAINT, LINK = grey(32), grey(110), color(26, 90, 180)

LETTERS = "Letters: DejaVu (fonts-dejavu-core), shaped by HarfBuzz and drawn by FreeType.\n"
PHOTOS = "Photographs: python3-skimage, public domain and CC0.\n"
TANGO = "Icons: tango-icon-theme, public domain.\n"


def article():
    with open(os.path.join(HERE, "article.txt"), encoding="utf-8") as file:
        return file.read().splitlines()


def photographs(page, width, height):
    """Each in its proportions, cut to those of the wanted size."""
    for name in NAMES:
        picture = Image.open(os.path.join(PHOTOGRAPHS, name)).convert("RGB")
        wide = min(picture.width, picture.height * width // height)
        high = wide * height // width
        left, top = (picture.width - wide) // 2, (picture.height - high) // 2
        small = picture.crop((left, top, left + wide, top + high)).resize((width, height), Image.LANCZOS)
        page.picture(name.split(".")[0], small)
    return [name.split(".")[0] for name in NAMES]


def icons(page, names):
    """One texture, an icon of 32 texels beside the other; returns u and v of each."""
    sheet = Image.new("RGBA", (256, 32 * ((len(names) + 7) // 8)))
    for i, name in enumerate(names):
        sheet.paste(Image.open(os.path.join(ICONS, name + ".png")).convert("RGBA"), (i % 8 * 32, i // 8 * 32))
    page.picture("icons", sheet)
    return [
        ((i % 8 / 8, (i % 8 + 1) / 8), (i // 8 * 32 / sheet.height, (i // 8 + 1) * 32 / sheet.height))
        for i in range(len(names))
    ]


def shadow(page):
    """A square of rounded corners in the middle of 64 texels, blurred; page.Page.shadow() stretches it."""
    square = Image.new("L", (64, 64))
    ImageDraw.Draw(square).rounded_rectangle((16, 16, 47, 47), 6, 255)
    page.texture("shadow", "A8", 64, 64, square.filter(ImageFilter.GaussianBlur(6)).tobytes())


def header(page, title):
    page.rectangle(0, 0, SIDE, 56, color(36, 52, 71))
    page.text("bold", 18, 32, 35, title, WHITE)
    x = 560.0
    for word in ("Pages", "Engines", "Results", "Download"):
        x = page.text("sans", 14, x, 34, word, grey(255, 0.8)) + 32


# --- Pages ---


def text_page(subpixel):
    atlas = Atlas(512, subpixel)
    about = "A page of text: most rectangles are letters, blended by "
    about += "the coverage of the three stripes of a pixel." if subpixel else "their coverage."
    page = Page("subpixel" if subpixel else "text", LETTERS + about, atlas)
    page.frame(clear="1 1 1 1")
    header(page, "Triptych")
    page.rectangle(0, 56, 232, SIDE - 56, color(244, 246, 248))
    page.rectangle(231, 56, 1, SIDE - 56, grey(216))
    page.rectangle(16, 128, 200, 28, color(221, 231, 243))
    page.text("bold", 13, 32, 100, "Contents", INK)
    for i, word in enumerate(["Introduction", "Readings", "Units and keys", "Pages", "Batches", "Damage", "Results", "Glossary"]):
        page.text("sans", 13, 32, 147 + 30 * i, word, INK if i == 0 else LINK)
    y = 108
    for number, paragraph in enumerate(article()):
        if len(paragraph) < 40:
            y += 18
            page.text("bold", 24, 272, y, paragraph, INK)
            page.rectangle(272, y + 12, 700, 1, grey(216))
            y += 42
            continue
        first = number < 3
        face, size, step = ("serif", 16, 25) if first else ("sans", 14, 22)
        for line in lines(atlas.faces[face], paragraph, size, 700):
            page.text(face, size, 272, y, line, INK)
            y += step
        y += 10
    return page


def gallery():
    page = Page("gallery", LETTERS + PHOTOS + "Photographs, scaled up and down, with captions.", Atlas(256))
    names = photographs(page, 160, 120)
    page.frame(clear="0.96 0.96 0.97 1")
    header(page, "Gallery")
    page.image(names[0], 32, 80, 624, 400)
    for i, name in enumerate(names[1:4]):
        page.image(name, 672, 80 + 136 * i, 320, 128, v=(0.2, 0.65))
    for i in range(24):
        name, column, row = names[(i * 5 + i // 6) % 6], i % 6, i // 6
        x, y = 32 + 162 * column, 512 + 126 * row
        page.rectangle(x, y, 150, 114, WHITE)
        page.image(name, x + 5, y + 5, 140, 86)
        page.text("sans", 11, x + 8, y + 106, f"{list(NAMES.values())[names.index(name)]} {i + 1}", FAINT)
    page.gradient(32, 400, 624, 80, linear(grey(0, 0), grey(0, 0.75), 0, 1))
    page.text("bold", 20, 52, 450, "Six photographs", WHITE)
    page.text("sans", 13, 52, 470, "A cat, a cup, a launch, galaxies, grass and gravel", grey(255, 0.85))
    return page


def cards():
    page = Page("cards", LETTERS + PHOTOS + TANGO + "Gradients, and rounded cards with shadows and clipped pictures.", Atlas(256))
    names = photographs(page, 96, 72)
    places = icons(page, SHELL)
    shadow(page)
    page.frame(clear="1 1 1 1")
    page.gradient(0, 0, SIDE, SIDE, linear(color(64, 93, 230), color(244, 33, 82), 0.75, 0.25))
    page.rounded(24, 20, SIDE - 48, 56, 28, grey(255, 0.18))
    page.text("bold", 18, 56, 54, "Dashboard", WHITE)
    for i, place in enumerate(places[:4]):
        page.image("icons", 820 + 44 * i, 32, 32, 32, filters="point", u=place[0], v=place[1])
    titles = ["Cat", "Coffee", "Launch", "Deep field", "Grass", "Gravel", "Disk", "Games", "Terminal"]
    for i, title in enumerate(titles):
        card(page, 24 + 332 * (i % 3), 100 + 304 * (i // 3), title, names, places, i)
    return page


def card(page, x, y, title, names, places, i):
    page.shadow(x, y + 6, 312, 280, 24, grey(0, 0.55))
    page.rounded(x, y, 312, 280, 16, WHITE)
    if i < 6:
        page.rounded(x + 12, y + 12, 288, 150, 10, WHITE, names[i], v=(0.15, 0.85))
    else:
        page.rounded(x + 12, y + 12, 288, 150, 10, linear(color(255, 214, 120), color(199, 90, 192), 0.25, 0.75))
    u, v = places[i % len(places)]
    page.image("icons", x + 16, y + 172, 32, 32, filters="point", u=u, v=v)
    page.text("bold", 16, x + 60, y + 194, title, INK)
    for k, line in enumerate(lines(page.atlas.faces["sans"], article()[1 + i % 3], 12, 280)[:2]):
        page.text("sans", 12, x + 16, y + 222 + 17 * k, line, FAINT)
    page.rounded(x + 16, y + 254, 280, 8, 4, grey(228))
    page.rounded(x + 16, y + 254, 40 + 26 * i, 8, 4, color(64, 140, 230))


ROW = 40


def row(page, i, y, places, lit):
    """A row of a list at a height; only what the damage shows is drawn."""
    words = article()[1 + i % 3].split()
    start = i * 7 % (len(words) - 9)
    page.rectangle(0, y, SIDE, ROW, color(219, 232, 250) if lit else color(248, 249, 250) if i % 2 else WHITE)
    page.rectangle(0, y + ROW - 1, SIDE, 1, grey(226))
    if page.visible(0, y, SIDE, ROW):
        u, v = places[i % len(places)]
        page.image("icons", 24, y + 4, 32, 32, filters="point", u=u, v=v)
        page.text("bold", 14, 72, y + 25, words[start].strip(".,:").capitalize(), INK)
        page.text("sans", 13, 240, y + 25, " ".join(words[start + 1 : start + 9]), FAINT)
        page.text("mono", 12, 840, y + 25, f"{(i * 7919) % 9973:5d} kB", FAINT)
        page.rounded(940, y + 10, 60, 20, 10, color(58, 160, 96) if i % 3 else color(200, 120, 40))
        page.text("bold", 11, 956, y + 24, "new" if i % 3 else "old", WHITE)


def listing(page, offset, lit, places):
    for i in range(60):
        y = 56 + i * ROW - offset
        if -ROW < y < SIDE:
            row(page, i, y, places, i == lit)


def bar(page):
    """The bar above the rows covers what scrolls below it."""
    page.rectangle(0, 0, SIDE, 56, color(36, 52, 71))
    page.text("bold", 18, 32, 35, "Files", WHITE)
    page.rounded(560, 14, 420, 28, 14, WHITE)
    page.text("sans", 13, 580, 33, "Search", FAINT)


def cursor(page):
    page.rectangle(582, 20, 1, 16, INK)


def whole_list(page):
    """The first frame: all that is in the window. Returns the places of the icons."""
    places = icons(page, SHELL)
    page.frame(clear="1 1 1 1")
    listing(page, 0, None, places)
    bar(page)
    return places


def scroll(page, offset, step, lit, places):
    """A frame that moves the rows up by a copy of what stays, and draws the strip that appears."""
    page.frame((0, SIDE - step, SIDE, step), move=(0, 56 + step, SIDE, SIDE - 56 - step, 0, 56))
    listing(page, offset, lit, places)


def scrolled():
    """Rows that scroll: a frame draws what it changes. The last frame is the same picture, drawn as a whole."""
    page = Page("list", LETTERS + TANGO + "A list. After the first frame only the damaged rectangle is drawn:\n"
                "a row lights up, a cursor blinks, and rows scroll by a copy and a strip. The last frame draws all again.", Atlas(256))  # fmt: skip
    places = whole_list(page)
    for lit in (5, 6):
        page.frame((0, 56 + 5 * ROW, SIDE, 2 * ROW))
        listing(page, 0, lit, places)
    page.frame((580, 18, 8, 20))
    bar(page)
    cursor(page)
    for offset in (24, 48, 72):
        scroll(page, offset, 24, 6, places)
    page.frame(clear="1 1 1 1")
    listing(page, 72, 6, places)
    bar(page)
    cursor(page)
    return page


STEPS = (4, 16, 40, 64, 128, 320)  # pixels


def scrolling():
    """Rows that scroll by more and more pixels. A frame moves what stays, and draws the strip that appears."""
    page = Page("scroll", LETTERS + TANGO + "A list that scrolls. After the first frame each moves the rows up by 4, 16, 40, 64, 128 and 320 pixels: a\n"
                "copy of what stays, and a strip below it. The last frame draws the final picture as a whole.", Atlas(256))  # fmt: skip
    places = whole_list(page)
    offset = 0
    for step in STEPS:
        offset += step
        scroll(page, offset, step, None, places)
    page.frame(clear="1 1 1 1")
    listing(page, offset, None, places)
    bar(page)
    return page


CITIES = {"Ghent": (3.72, 51.05), "Paris": (2.35, 48.86), "Berlin": (13.4, 52.52), "Vienna": (16.37, 48.21), "Prague": (14.42, 50.09),
          "London": (-0.13, 51.51), "Copenhagen": (12.57, 55.68), "Milan": (9.19, 45.46), "Warsaw": (21.01, 52.23)}  # fmt: skip
ROUTE = ("London", "Ghent", "Paris", "Milan", "Vienna", "Prague", "Berlin", "Warsaw")


def chart():
    page = Page("map", LETTERS + TANGO + "A map: countries, borders and a route as lines with soft edges, labels.\n"
                "Borders: Natural Earth, public domain (npm: world-atlas 2.0.2).", Atlas(256))  # fmt: skip
    places = icons(page, ["actions/go-home", "actions/list-add", "actions/list-remove", "actions/edit-find"])
    shadow(page)
    europe = world.Map(-4, 58, 36)
    page.frame(clear="0.67 0.8 0.9 1")
    for i, country in enumerate(europe.countries):
        for points in map(lambda each: world.clipped(each, SIDE), country):
            if len(points) > 2:
                page.polygon(points, world.triangles(points), color(235 - i * 37 % 30, 238 - i * 53 % 24, 214 - i * 71 % 30))
    for k in range(-10, 40, 5):
        page.line([europe.place(k, 30), europe.place(k, 70)], 1, grey(90, 0.25))
        page.line([europe.place(-20, 35 + k), europe.place(50, 35 + k)], 1, grey(90, 0.25))
    for arc in europe.arcs:
        page.line([point for point in arc], 1.5, color(120, 110, 140, 0.9))
    stops = [europe.place(*CITIES[name]) for name in ROUTE]
    page.line(stops, 8, color(255, 255, 255, 0.9))
    page.line(stops, 5, color(40, 110, 220))
    for name, place in CITIES.items():
        x, y = map(round, europe.place(*place))
        page.rounded(x - 6, y - 6, 12, 12, 6, WHITE)
        page.rounded(x - 4, y - 4, 8, 8, 4, color(200, 40, 40))
        for dx, dy in ((-1, 0), (1, 0), (0, -1), (0, 1)):
            page.text("bold", 13, x + 9 + dx, y + 5 + dy, name, grey(255, 0.8))
        page.text("bold", 13, x + 9, y + 5, name, INK)
    page.shadow(24, 28, 300, 48, 24, grey(0, 0.5))
    page.rounded(24, 24, 300, 48, 8, WHITE)
    page.text("sans", 14, 44, 53, "From London to Warsaw", INK)
    for i, (u, v) in enumerate(places):
        page.shadow(960, 28 + 48 * i, 40, 40, 20, grey(0, 0.4))
        page.rounded(960, 24 + 48 * i, 40, 40, 8, WHITE)
        page.image("icons", 964, 28 + 48 * i, 32, 32, filters="point", u=u, v=v)
    return page


PAGES = {"text": lambda: text_page(False), "subpixel": lambda: text_page(True), "gallery": gallery, "cards": cards, "list": scrolled, "scroll": scrolling, "map": chart}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--triptych", default="build/triptych")
    parser.add_argument("--folder", default="bench/streams/pages")
    parser.add_argument("names", nargs="*", default=list(PAGES))
    options = parser.parse_args()
    os.makedirs(options.folder, exist_ok=True)
    for name in options.names:
        if name not in PAGES:
            print(f"pages: {name}: expected one of {' '.join(PAGES)}", file=sys.stderr)
            return 2
        PAGES[name]().write(options.folder, options.triptych)
    return 0


sys.exit(main())
