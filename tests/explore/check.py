#!/usr/bin/env python3
"""Checks a page of `triptych explore` without a browser.

    check.py PAGE [ENGINE DUMP]

The markup is well-formed and refers to nothing outside of the page. The data in it are complete: every number
of a text, a place, a file, a line and a kin exists. With the output of `triptych dump --show all` of the same
routine and engine, every program and every instruction of the code is the same in both. Prints the first
difference and ends with 1, or a line of counts.
"""
import html.parser
import json
import re
import sys

VOID = {"meta", "input", "br"}
SAME, ADDED, ALTERED, REMOVED = range(4)


class Markup(html.parser.HTMLParser):
    """The tree of elements, and the texts of scripts and styles."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.open, self.texts, self.attributes = [], [], []
        self.feed(text)
        self.close()
        expect(not self.open, f"elements that are not closed: {self.open}")

    def handle_starttag(self, tag, attributes):
        self.attributes += [(tag, name, value) for name, value in attributes]
        if tag not in VOID:
            self.open.append(tag)
        if tag in ("script", "style"):
            self.texts.append((tag, dict(attributes), ""))

    def handle_endtag(self, tag):
        expect(self.open and self.open.pop() == tag, f"</{tag}> at {self.getpos()} closes another element")

    def handle_data(self, data):
        if self.open and self.open[-1] in ("script", "style"):
            tag, attributes, text = self.texts.pop()
            self.texts.append((tag, attributes, text + data))


def expect(condition, reason):
    if not condition:
        print(reason)
        sys.exit(1)


def check_markup(text):
    """No attribute and no style names an address. Returns the data."""
    markup = Markup(text)
    for tag, name, value in markup.attributes:
        expect(name not in ("src", "href", "srcset", "action", "data"), f"<{tag} {name}={value}>")
        expect(not name.startswith("on"), f"<{tag} {name}>")
    scripts = [entry for entry in markup.texts if entry[0] == "script"]
    styles = [entry[2] for entry in markup.texts if entry[0] == "style"]
    expect(len(scripts) == 2 and len(styles) == 1, "other than one style, the data and one script")
    expect(not re.search(r"url\(|@import", styles[0]), "the style refers to a file")
    expect(not re.search(r"\b(fetch|import|XMLHttpRequest|innerHTML|eval)\b", scripts[1][2]),
           "the script loads, or makes elements from text")
    expect("<" not in scripts[0][2] and ">" not in scripts[0][2], "the data have a bracket of HTML")
    return json.loads(scripts[0][2])


def check_sources(model):
    """Places, files and lines of the specification and the shader."""
    operations = len(model["place"])
    for number, (file, line, name, caller) in enumerate(model["places"][1:], 1):
        lines = model["files"][file]["text"].count("\n")
        expect(1 <= line <= lines, f"place {number}: line {line} of {model['files'][file]['path']}, {lines} lines")
        expect(0 <= name < len(model["texts"]) and 0 <= caller < number, f"place {number}")
    for number, place in enumerate(model["place"]):
        expect(0 <= place < len(model["places"]) and (place or not number), f"operation {number}: place {place}")
    if "shader" in model:
        expect(len(model["shader"]["line"]) == operations, "not every operation has a line of the shader, or 0")
        expect(all(0 <= line <= len(model["shader"]["lines"]) for line in model["shader"]["line"]), "a line")


def expand(model):
    """The lines of each program as [mark, number, text, origin]."""
    results = {}
    for pane in model["panes"]:
        if pane["kind"] != "ir":
            continue
        before = results.get(pane["engine"], results.get("", []))
        pane["program"] = []
        for line in pane["lines"]:
            if len(line) == 2:
                expect(line[0] + line[1] <= len(before), f"{pane['id']}: lines {line} of {len(before)}")
                pane["program"] += [[SAME] + kept[1:] for kept in before[line[0]:line[0] + line[1]]]
            else:
                pane["program"].append(line[:2] + [model["texts"][line[2]], line[3]])
                if line[0] == ALTERED:
                    expect(line[4] < len(model["texts"]), pane["id"])
        results[pane["engine"]] = [line for line in pane["program"] if line[0] != REMOVED]


def kin_of(pane):
    """The numbers of kin of all lines."""
    for line in pane["program"] if pane["kind"] == "ir" else pane["lines"]:
        if pane["kind"] == "key":
            for first, last in zip(line[3][::2], line[3][1::2]):
                yield from range(first, last + 1)
        elif pane["kind"] == "ir":
            yield line[3]
        elif pane["kind"] == "intervals":
            yield line[6]
        elif pane["kind"] in ("code", "text"):
            yield line[0]["own"] if isinstance(line[0], dict) else line[0]


def check_kin(model):
    """A number below that of recorded operations is one of them; another belongs to a line of the same pane."""
    operations = len(model["place"])
    recorded = {f"{model['files'][file]['path']}:{line}" for file, line, _, _ in model["places"]}
    for pane in model["panes"]:
        numbers = set(kin_of(pane)) - {0}
        expect(all(0 < number < model["kin"] for number in numbers), f"{pane['id']}: a kin that does not exist")
        if pane["kind"] in ("key", "ir", "intervals"):
            expect(all(number < operations for number in numbers), f"{pane['id']}: a kin of its own")
        if pane["kind"] in ("ir", "intervals", "code", "text") and pane["id"] != "external/code":
            expect(numbers, f"{pane['id']}: no line has kin")
        lines = {line[0]["line"] for line in pane["lines"] if isinstance(line[0], dict) and "line" in line[0]}
        expect(lines <= recorded, f"{pane['id']}: lines that record nothing: {lines - recorded}")
        expect(lines or pane["engine"] != "stitch-operation", f"{pane['id']}: no part has a line")
    expect({line[3] for line in panes(model)["record"]["program"]} == set(range(1, operations)),
           "the recording has other operations than the data")


def panes(model):
    return {pane["id"]: pane for pane in model["panes"]}


def sections(dump):
    """The parts of a dump: (title, lines), without the lines of shaders that precede what they become."""
    found = []
    for line in dump.split("\n"):
        if line.startswith("== "):
            found.append((line[3:], []))
        elif found and line and not line.startswith("; shader:"):
            found[-1][1].append(line)
    return found


def as_dumped(pane):
    return [f"{line[1]:5}  {line[2]}".rstrip() for line in pane["program"] if line[0] != REMOVED]


def without_place(lines):
    return [re.sub(r"    ; spec/\S+$", "", line).rstrip() for line in lines]


def same(what, got, wanted):
    for at, (g, w) in enumerate(zip(got, wanted)):
        expect(g == w, f"{what}, line {at + 1}: the page has `{g}`, the dump `{w}`")
    expect(len(got) == len(wanted), f"{what}: the page has {len(got)} lines, the dump {len(wanted)}")


def compare(model, engine, dump):
    """Every program and the code, line by line."""
    own = panes(model)
    parts = sections(dump)
    recorded = next(lines for title, lines in parts if title.startswith("record:"))
    same("the recording", as_dumped(own["record"]), without_place(recorded))
    runs = [(title, lines) for title, lines in parts if title.startswith("after ")]
    rows = own[engine + "/passes"]["lines"]
    expect(len(runs) == len(rows), f"the page has {len(rows)} runs of passes, the dump {len(runs)}")
    for at, ((title, lines), row) in enumerate(zip(runs, rows), 1):
        expect(title.startswith(f"after {row[1]}:"), f"run {at}: {row[1]}, and in the dump: {title}")
        if lines == ["nothing changed"] or row[1] == "shape":
            expect(not row[2], f"run {at} of {row[1]} changed nothing in the dump")
            estimates = re.findall(r"\b\d+\b", lines[0])
            expect(all(each in own[engine + "/passes"]["note"] for each in estimates), f"the page has not {lines[0]}")
            continue
        pane = own[f"{engine}/run-{at}"]
        same(pane["title"], as_dumped(pane), without_place(lines))
        marks = [line[0] for line in pane["program"]]
        expect(row[3:6] == [marks.count(REMOVED), marks.count(ADDED), marks.count(ALTERED)], f"counts of run {at}")
    code = next(lines for title, lines in parts if title.startswith("asm:"))
    listed = [f"{line[1]:6x}  {model['texts'][line[3]]}" for line in own[engine + "/code"]["lines"]]
    same("the code", listed, [re.sub(r" +; %\d+ .*$", "", line).rstrip() for line in code])


def main(arguments):
    with open(arguments[0], encoding="utf-8") as file:
        text = file.read()
    model = check_markup(text)
    check_sources(model)
    expand(model)
    check_kin(model)
    if len(arguments) > 1:
        with open(arguments[2], encoding="utf-8") as file:
            compare(model, arguments[1], file.read())
    print(f"{len(text) // 1024} KB, {len(model['place']) - 1} operations, {len(model['places']) - 1} places, "
          f"{len(model['panes'])} panes")


main(sys.argv[1:])
