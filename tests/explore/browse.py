#!/usr/bin/env python3
"""Uses pages of `triptych explore` in a headless Chromium, as a reader would: `make check-explore`.

    browse.py TRIPTYCH            prints `ok NAME` or `FAIL NAME` for each test
    browse.py TRIPTYCH FOLDER     writes the pictures of docs/explorer.md into the folder
"""
import json
import pathlib
import subprocess
import sys
import tempfile

from browser import Browser, Failure

TEAPOT, SHADED = "bench/streams/teapot-bilinear.tri", "tests/data/shading/fractals.tri"
HOSTILE = """triptych 1
target 16 16
vertices square position:float3 {
    -1 1 0
    1 1 0
    1 -1 0
    -1 -1 0
}
shader plain {
vs_2_0
dcl_position v0
mov oPos, v0
}
shader hostile {
ps_2_0
def c0, 1, 0, 0.5, 1 ; </script><script>document.title = "taken"</script><img src=x onerror=alert(1)>
mov oC0, c0
}
state cullmode none
state zenable false
bind vertices square
vertexshader plain
pixelshader hostile
draw fan 0 2
"""


class Pages:
    """Pages in a temporary folder, made once."""

    def __init__(self, program):
        self.program, self.made = program, {}
        self.folder = tempfile.TemporaryDirectory()

    def path(self, stream, *options):
        key = (stream, *options)
        if key not in self.made:
            path = pathlib.Path(self.folder.name) / f"{len(self.made)}.html"
            subprocess.run([self.program, "explore", stream, *options, "--out", path], check=True,
                           stdout=subprocess.DEVNULL)
            self.made[key] = path
        return self.made[key]

    def hostile(self):
        stream = pathlib.Path(self.folder.name) / "<img src=x onerror=alert(2)>.tri"
        stream.write_text(HOSTILE)
        return self.path(str(stream), "--engines", "batch")


def model_of(path):
    text = path.read_text()
    begin = text.index('id="model">') + len('id="model">')
    return json.loads(text[begin:text.index("</script>", begin)])


def pane_of(model, name):
    return next(pane for pane in model["panes"] if pane["id"] == name)


def expect(condition, reason):
    if not condition:
        raise Failure(reason)


def same(what, got, wanted):
    expect(got == wanted, f"{what}: {got!r}, expected {wanted!r}")


def count(browser, selector):
    return browser.evaluate(f"document.querySelectorAll({json.dumps(selector)}).length")


def column(number):
    return f".column:nth-child({number}) .body"


def text_of(browser, selector):
    return browser.evaluate(f"document.querySelector({json.dumps(selector)})?.textContent")


# --- The tests ---

def a_page_opens_without_errors_and_requests(browser, pages):
    for stream in (TEAPOT, SHADED):
        seconds = browser.open(pages.path(stream))
        same("problems", browser.problems(), [])
        same("columns", count(browser, ".column"), 3)
        expect(stream in browser.evaluate("document.title"), "the title is not that of the stream")
        expect(seconds < 10, f"the page opens in {seconds:.1f} s")


def pointing_at_an_instruction_marks_its_kin_in_all_columns(browser, pages):
    path = pages.path(TEAPOT)
    model = model_of(path)
    code = pane_of(model, "specialize/code")["lines"]
    at = next(n for n, line in enumerate(code) if line[0] and sum(o[0] == line[0] for o in code) == 1)
    origin = code[at][0]
    file, line, _, _ = model["places"][model["place"][origin]]
    browser.open(path, "#show=record,spec,specialize/code")
    browser.point(f"{column(3)} .line:nth-child({at + 1})")
    same("the line", count(browser, f"{column(3)} .line.cursor"), 1)
    same("kin in the code", count(browser, f"{column(3)} .line.kin"), 1)
    same("kin in the recording", text_of(browser, f"{column(1)} .line.kin .n"), str(origin))
    same("kin in the specification", text_of(browser, f"{column(2)} .line.kin .n"), str(line))
    expect(count(browser, f"{column(2)} .line.via") >= 1, "no calling line is marked")
    expect(f"%{origin} " in text_of(browser, "#status"), "the status does not name the operation")
    expect(model["files"][file]["path"].split("/", 1)[1] in text_of(browser, "#status"), "nor its file")


def pointing_at_a_line_of_the_shader_marks_what_it_records(browser, pages):
    path = pages.path(SHADED)
    shader = model_of(path)["shader"]
    line = next(n for n in shader["line"] if n)
    browser.open(path, "#show=shader,record")
    browser.point(f"{column(1)} .line:nth-child({line})")
    same("kin in the recording", count(browser, f"{column(2)} .line.kin"), shader["line"].count(line))
    expect(shader["lines"][line - 1].strip() in text_of(browser, "#status"), "the status does not have the line")


def pointing_at_a_field_of_the_key_marks_the_operations_that_it_causes(browser, pages):
    path = pages.path(TEAPOT)
    fields = pane_of(model_of(path), "key")["lines"]
    at = next(n for n, field in enumerate(fields) if field[0] == "filter")
    caused = sum(last - first + 1 for first, last in zip(fields[at][3][::2], fields[at][3][1::2]))
    browser.open(path, "#show=key,record")
    browser.point(f"{column(1)} tbody tr:nth-child({at + 1})")
    same("kin in the recording", count(browser, f"{column(2)} .line.kin"), caused)


def a_click_keeps_the_marks_until_escape(browser, pages):
    browser.open(pages.path(TEAPOT), "#show=record,specialize/code")
    browser.click(f"{column(1)} .line:nth-child(20)")
    browser.point(f"{column(1)} .line:nth-child(30)")
    same("the line after moving away", text_of(browser, ".line.cursor .n"), "20")
    browser.press("Escape")
    same("marks after Escape", count(browser, ".kin, .cursor, .via"), 0)
    browser.point(f"{column(1)} .line:nth-child(31)")
    same("the line that is pointed at then", text_of(browser, ".line.cursor .n"), "31")


def removed_operations_are_struck_out(browser, pages):
    path = pages.path(TEAPOT)
    model = model_of(path)
    runs = pane_of(model, "specialize/passes")["lines"]
    at = next(n for n, run in enumerate(runs, 1) if run[1] == "dead" and run[3])
    browser.open(path, f"#show=specialize/run-{at},record")
    same("removed lines", count(browser, f"{column(1)} .line.removed"), runs[at - 1][3])
    style = browser.evaluate("getComputedStyle(document.querySelector('.line.removed .t')).textDecorationLine")
    same("their decoration", style, "line-through")
    browser.click(".bar button")
    visible = browser.evaluate("[...document.querySelectorAll('.column:nth-child(1) .line')]"
                               ".filter((line) => line.getClientRects().length).length")
    same("lines of only the changes", visible, sum(runs[at - 1][3:6]))


def two_passes_and_two_engines_are_beside_each_other(browser, pages):
    path = pages.path(TEAPOT, "--engines", "specialize-8,stitch-operation,batch")
    browser.open(path, "#show=specialize-8/run-2,specialize-8/final,stitch-operation/code,batch/schedule")
    same("columns", count(browser, ".column"), 4)
    number = browser.evaluate("[...panes.get('batch/schedule').lines].map((line) => line[0]).find((kin) => "
                              "columns[1].view.byKin.has(kin) && columns[2].view.byKin.has(kin))")
    browser.evaluate(f"pin(columns[3].view.byKin.get({number})[0])")
    for at in (1, 2, 3, 4):
        expect(count(browser, f"{column(at)} .kin") >= 1, f"column {at} has no kin of %{number}")


def a_row_of_passes_opens_its_result(browser, pages):
    browser.open(pages.path(TEAPOT), "#show=specialize/passes,record")
    browser.click(f"{column(1)} tbody tr:not(.idle)")
    expect("/run-" in browser.evaluate("columns[1].id"), "the second column is not the result of a pass")


def intervals_have_a_bar_for_each_value_in_a_register(browser, pages):
    path = pages.path(SHADED, "--engines", "specialize-4")
    pane = pane_of(model_of(path), "specialize-4/intervals")
    browser.open(path, "#show=specialize-4/intervals,specialize-4/final")
    same("bars", count(browser, ".span"), len(pane["lines"]))
    same("marks of loops", count(browser, "svg .loop"), len(pane["loops"]))
    browser.point(".span:nth-of-type(5)")
    expect(count(browser, f"{column(2)} .line.kin") >= 1, "a bar has no kin")


def the_graph_moves_to_the_operation_that_is_clicked(browser, pages):
    browser.open(pages.path(TEAPOT), "#show=specialize/final,graph")
    expect(count(browser, ".node") > 4 and count(browser, ".edge") > 3, "the graph is empty")
    before = text_of(browser, ".node.center text")
    browser.click(".node:not(.center)")
    after = text_of(browser, ".node.center text")
    expect(before != after, "the graph did not move")
    same("kin in the program", text_of(browser, f"{column(1)} .line.kin .n"), after.split()[0][1:])


def nothing_moves_under_the_pointer(browser, pages):
    for panes in ("specialize/final,graph", "record,spec,specialize/code,specialize/run-2"):
        browser.open(pages.path(TEAPOT), "#show=" + panes)
        tops = "columns.map((column) => column.body.getBoundingClientRect().top).join()"
        before = browser.evaluate(tops)
        browser.point(f"{column(1)} .line:nth-child(20)")
        expect(count(browser, ".kin") > 0, "nothing is marked")
        same("the columns' tops", browser.evaluate(tops), before)


def everything_can_be_reached_with_keys(browser, pages):
    browser.open(pages.path(TEAPOT))
    browser.press("2")
    same("the second layout", browser.evaluate("columns.map((column) => column.id).join()"), "key,spec,record")
    browser.press("Tab")
    browser.evaluate("document.activeElement.blur()")
    browser.press("ArrowDown", "ArrowDown")
    same("the line", text_of(browser, ".cursor td"), "depth_write")
    browser.press("ArrowRight", "ArrowRight")
    same("the column", browser.evaluate("active"), 2)
    expect(text_of(browser, f"{column(3)} .cursor .n"), "no line of the recording is reached")
    browser.press("g")
    same("the last column", browser.evaluate("columns[2].id"), "graph")
    browser.press("[")
    expect(browser.evaluate("columns[2].id") != "graph", "the pane did not change")
    browser.press("-", "+", "+")
    same("columns", count(browser, ".column"), 4)
    browser.press("?")
    expect(browser.evaluate("document.getElementById('help').open"), "the keys are not shown")


def a_text_is_found(browser, pages):
    browser.open(pages.path(TEAPOT), "#show=record,specialize/code")
    browser.press("/")
    browser.call("Input.insertText", text="gather")
    wanted = browser.evaluate("[...recording.values()].filter((line) => line.text.includes('gather')).length")
    same("found in the recording", count(browser, f"{column(1)} .found"), wanted)
    browser.press("Enter")
    expect("gather" in text_of(browser, ".line.cursor .t"), "Enter does not go to the first place")


def a_link_shows_the_same_line(browser, pages):
    path = pages.path(TEAPOT)
    browser.open(path, "#show=record,specialize/code")
    browser.click(f"{column(1)} .line:nth-child(60)")
    fragment = browser.evaluate("location.hash")
    browser.open(path, fragment)
    same("the line", text_of(browser, ".line.cursor .n"), "60")


def texts_of_streams_are_never_elements(browser, pages):
    browser.open(pages.hostile())
    same("problems", browser.problems(), [])
    expect("<img" in browser.evaluate("document.title"), "the title is not the path")
    same("images", count(browser, "img"), 0)
    same("scripts", count(browser, "script"), 2)
    expect("<script>" in text_of(browser, f"{column(1)}"), "the comment of the shader is not shown")


CONTRAST = """(() => {
    const rgb = (text) => text.match(/[\\d.]+/g).slice(0, 3).map(Number);
    const light = (c) => c.map((v) => v / 255).map((v) => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
        .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
    const style = getComputedStyle(document.documentElement), sample = document.createElement("i");
    document.body.append(sample);
    const of = (name) => { sample.style.color = style.getPropertyValue(name); return light(rgb(getComputedStyle(sample).color)); };
    const pairs = [];
    for (const back of ["--pane", "--kin", "--via"])
        for (const ink of ["--ink", "--dim", "--removed", "--altered", "--added", "--operand", "--number", "--keyword"]) {
            const [a, b] = [of(ink), of(back)].sort((x, y) => y - x);
            pairs.push([ink + " on " + back, (a + 0.05) / (b + 0.05)]);
        }
    sample.remove();
    return pairs;
})()"""


def text_is_readable_in_light_and_dark(browser, pages):
    browser.open(pages.path(TEAPOT))
    backs = set()
    for scheme in ("light", "dark"):
        browser.prefer(scheme)
        backs.add(browser.evaluate("getComputedStyle(document.body).backgroundColor"))
        low = [(name, round(ratio, 2)) for name, ratio in browser.evaluate(CONTRAST) if ratio < 4.5]
        same(f"pairs of colours with a contrast below 4.5, {scheme}", low, [])
    browser.prefer("light")
    same("backgrounds", len(backs), 2)


TESTS = [value for value in list(globals().values()) if callable(value) and getattr(value, "__code__", None)
         and value.__code__.co_varnames[:2] == ("browser", "pages")]


def run_tests(pages):
    failures = 0
    with Browser(1280, 640) as browser:
        for test in TESTS:
            name = test.__name__.replace("_", " ")
            try:
                test(browser, pages)
                print(f"ok {name}", flush=True)
            except Failure as failure:
                failures += 1
                print(f"FAIL {name}\n     {failure}", flush=True)
    return failures != 0


# --- The pictures of the documentation ---

def keep(browser, number, line):
    browser.evaluate(f"pin(columns[{number - 1}].view.lines[{line}]), columns[{number - 1}].scrollTo(focused)")


def take_pictures(pages, folder):
    """By name: the stream, its options, the layout, and what is done before the picture is taken."""
    teapot, both = pages.path(TEAPOT), pages.path(TEAPOT, "--engines", "specialize-8,stitch-operation")
    shaded = pages.path(SHADED)
    pictures = [
        ("overview", shaded, "shader,spec,specialize/code", "light",
         lambda browser: browser.click(f"{column(1)} .line:nth-child(24)")),
        ("key", teapot, "key,spec,record", "light",
         lambda browser: browser.click(f"{column(1)} tbody tr:nth-child(8)")),
        ("passes", teapot, "specialize/passes,specialize/run-2,specialize/run-6", "dark",
         lambda browser: browser.click(f"{column(3)} .line.removed")),
        ("registers", shaded, "specialize/final,specialize/intervals,specialize/code", "light",
         lambda browser: keep(browser, 2, 27)),
        ("graph", teapot, "specialize/final,graph", "light", lambda browser: browser.click(".node:nth-of-type(8)")),
        ("engines", both, "specialize-8/code,record,stitch-operation/code", "light",
         lambda browser: keep(browser, 2, 165)),
    ]
    pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
    with Browser(1280, 640) as browser:
        for name, page, panes, scheme, act in pictures:
            browser.prefer(scheme)
            browser.open(page, "#show=" + panes)
            act(browser)
            browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=1, y=1)
            browser.picture(pathlib.Path(folder) / f"{name}.png")


def main(arguments):
    pages = Pages(arguments[0])
    if len(arguments) > 1:
        return take_pictures(pages, arguments[1])
    return run_tests(pages)


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except Failure as reason:
        sys.exit(f"browse.py: {reason}")
