"""The report: RESULTS/report/index.html with everything in it, the figures' data beside it, and index.pdf if it is requested."""

import base64
import csv
import html
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

from expression import BadExpression
from number import NoValue, Number
from verdict import ALL, CANNOT, FAILS, HOLDS, NONE, NOT_YET, PART, counts, written

HERE = os.path.dirname(os.path.abspath(__file__))
CLASSES = {HOLDS: "holds", PART: "part", FAILS: "fails", CANNOT: "cannot", NOT_YET: "later", NONE: "none"}
MEANINGS = {
    HOLDS: "the rule of the claim is true of the whole interval that was measured",
    PART: "a weaker rule, also written before the run, is true",
    FAILS: "neither rule is true",
    CANNOT: "this project has no means to test the claim; the reason is given",
    NOT_YET: "an experiment is possible, and needs something that the project does not have yet",
    NONE: "an experiment failed or its output had no such value",
}
KINDS = {
    "speed": "speed",
    "size": "size",
    "build": "time to build",
    "qual": "quality",
    "listing": "listing or derivation",
    "design": "design",
    "future": "prediction",
}


def text(content):
    return html.escape(str(content), quote=False)


def rich(content):
    """Text with `code` between backticks."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", text(content))


def badge(verdict):
    return f'<span class="badge {CLASSES[verdict]}">{verdict}</span>'


# --- Figures --------------------------------------------------------------------------------------------------


def table_of(figure, read):
    """The columns of a figure by name. A number's ends are columns NAME_low and NAME_high if they differ from it."""
    columns = {}
    for name, expression in figure.columns.items():
        items = expression.items(read)
        columns[name] = [each.value if isinstance(each, Number) else each for each in items]
        if any(isinstance(each, Number) and not each.exact() for each in items):
            columns[name + "_low"] = [each.low for each in items]
            columns[name + "_high"] = [each.high for each in items]
    lengths = {len(column) for column in columns.values()}
    if len(lengths) != 1:
        raise NoValue(f"the columns of the figure {figure.name} have {sorted(lengths)} items, expected the same number")
    return columns


def write_table(path, columns):
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*columns.values()))


def draw(folder, registry, figure, laboratory):
    """The figure as HTML, or a line why there is none."""
    if figure.images:
        return pictures_of(figure, laboratory)
    try:
        columns = table_of(figure, laboratory.read)
    except (NoValue, BadExpression) as error:
        return "", str(error)
    table = os.path.join(folder, figure.name + ".csv")
    write_table(table, columns)
    return plot(folder, registry, figure, table) if figure.plot else (data_table(columns), "")


def plot(folder, registry, figure, table):
    picture = os.path.join(folder, figure.name + ".svg")
    template = os.path.join(registry.folder, "figures", figure.plot + ".gnuplot")
    try:
        run = subprocess.run(["gnuplot", "-c", template, table, picture], capture_output=True, text=True, check=False)
    except FileNotFoundError:
        return "", "gnuplot is not installed"
    if run.returncode or not os.path.exists(picture):
        return "", f"gnuplot: {(run.stderr.strip().splitlines() or ['no picture'])[0]}"
    with open(picture, encoding="utf-8") as file:
        return inline(file.read(), figure.name), ""


def pictures_of(figure, laboratory):
    """The pictures of experiments, inside of the page."""
    parts = []
    for title, output in figure.images.items():
        try:
            content = laboratory.bytes(output)
        except NoValue as error:
            return "", str(error)
        kind = "png" if content[:4] == b"\x89PNG" else "svg+xml"
        data = base64.b64encode(content).decode()
        parts.append(f'<div><img src="data:image/{kind};base64,{data}" alt="{html.escape(title)}"><p>{rich(title)}</p></div>')
    return f'<div class="pictures">{"".join(parts)}</div>', ""


def cell(item):
    if isinstance(item, str):
        return f"<td>{rich(item)}</td>"
    return f'<td class="number">{item:,.4g}</td>' if abs(item) < 10000 else f'<td class="number">{item:,.0f}</td>'


def data_table(columns):
    head = "".join(f"<th>{text(name.replace('_', ' '))}</th>" for name in columns)
    rows = ("".join(cell(item) for item in row) for row in zip(*columns.values()))
    return f"<table><tr>{head}</tr>{''.join(f'<tr>{row}</tr>' for row in rows)}</table>"


def inline(svg, name):
    """Without the XML declaration, and with identifiers that are the figure's own."""
    svg = svg[svg.index("<svg") :]
    return re.sub(r"(id='|id=\"|url\(#|href='#|href=\"#)", rf"\1{name}-", svg)


# --- Parts of the page ----------------------------------------------------------------------------------------


def bar(verdicts):
    total = len(verdicts)
    parts = [
        f'<span class="{CLASSES[name]}" style="width:{100 * count / total:.3f}%" title="{count} {name}"></span>'
        for name, count in counts(verdicts).items()
        if count
    ]
    return f'<div class="bar">{"".join(parts)}</div>'


def index(registry, verdicts):
    used = [name for name in ALL if counts(verdicts)[name]]
    head = "".join(f'<th class="number">{name}</th>' for name in used)
    rows = []
    for name, chapter in registry.chapters.items():
        inside = [each for each in verdicts if each.claim.chapter == name]
        if inside:
            link = f'<a href="#{name}">{text(chapter.one("title"))}</a>'
            rows.append(index_row(link, inside, used))
    rows.append(index_row("<b>all</b>", verdicts, used))
    return f'<table><tr><th>chapter</th><th class="number">claims</th>{head}</tr>{"".join(rows)}</table>'


def index_row(title, verdicts, used):
    cells = "".join(f'<td class="number">{counts(verdicts)[name] or ""}</td>' for name in used)
    return f'<tr><td>{title}</td><td class="number">{len(verdicts)}</td>{cells}</tr>'


def legend(verdicts):
    rows = [f"<tr><td>{badge(name)}</td><td>{text(MEANINGS[name])}</td></tr>" for name in ALL if counts(verdicts)[name]]
    return f"<table>{''.join(rows)}</table>"


def claim_card(registry, verdict):
    claim = verdict.claim
    parts = [
        f'<article class="claim {CLASSES[verdict.text]}" id="{claim.id}">',
        f'<header><b>{claim.id}</b><span class="source">{text(claim.source)} · {KINDS[claim.kind]}</span>',
        f"{badge(verdict.text)}</header>",
        f'<p class="words">{rich(claim.words)}</p>',
    ]
    if verdict.numbers:
        parts.append(values_table(verdict))
    for line in (verdict.problem, claim.reasons, claim.needs and f"Needs {claim.needs}", claim.cannot):
        if line:
            parts.append(f"<p>{rich(line)}</p>")
    if claim.holds:
        parts.append(f'<p class="rule">{rules(claim)} {experiment_links(registry, claim)}</p>')
    return "".join(parts) + "</article>"


def values_table(verdict):
    rows = [
        f"<tr><td>{text(value.name.replace('_', ' '))}</td><td>{text(written(value, verdict.numbers[value.name]))}</td></tr>"
        for value in verdict.claim.values
        if value.name in verdict.numbers
    ]
    return f'<table class="values">{"".join(rows)}</table>'


def rules(claim):
    line = f"Holds if <code>{text(claim.holds.text)}</code>"
    return line + (f", in part if <code>{text(claim.part.text)}</code>." if claim.part else ".")


def experiment_links(registry, claim):
    links = [f'<a href="#experiment-{name}">{name}</a>' for name in registry.experiments_of(claim)]
    return "Experiments: " + ", ".join(links) + "."


def chapter_section(registry, name, verdicts, pictures):
    chapter, shown = registry.chapters[name], []
    parts = [f'<h2 id="{name}">{text(chapter.one("title"))}</h2>', f'<p class="soft">{text(chapter.one("source"))}</p>']
    for verdict in verdicts:
        parts.append(claim_card(registry, verdict))
        for figure in verdict.claim.figures:
            if figure not in shown and figure in pictures:
                parts.append(pictures.pop(figure))
                shown.append(figure)
    return "".join(parts)


def figure_block(figure, svg, problem):
    body = svg or f"<p>No figure: {text(problem)}.</p>"
    data = "" if figure.images else f' Data: <a href="{figure.name}.csv">{figure.name}.csv</a>.'
    caption = rich(figure.title) + data
    return f'<figure id="figure-{figure.name}">{body}<figcaption>{caption}</figcaption></figure>'


def experiments_section(registry, reports):
    parts = ['<h2 id="experiments">Experiments</h2><p>Each ran once, from the root of the source tree, with '
             "<code>triptych</code> in the path. <code>$OUT</code> is the file that a claim's values are read from.</p>"]
    for name, report in reports.items():
        experiment = registry.experiments[name]
        commands = "\n".join(f"{run}: {command}" for run, command in experiment.runs.items())
        state = f"failed: {report['failed']}" if report["failed"] else f"{report['seconds']:.0f} s"
        parts.append(
            f'<h3 id="experiment-{name}">{name} <span class="soft">{text(state)}, {report["date"]}, commit {report["machine"]["commit"]}</span></h3>'
            f"<p>{rich(experiment.about)}</p><pre><code>{text(commands)}</code></pre>"
        )
    return "".join(parts)


def commits_of(machine, reports):
    """The commits of the experiments, that of most experiments first."""
    found = [report["machine"]["commit"] for report in reports.values()]
    names = sorted(set(found), key=lambda name: -found.count(name))
    return ", ".join(f"{name} ({found.count(name)} experiments)" for name in names) or machine["commit"]


def machine_table(machine, reports):
    usable = [each for each in machine["engines"] if each["runs"] == "always" and each["here"] == "available"]
    lanes = ", ".join(f"{each['engine']} {each['width']}" for each in usable)
    rows = {
        "processor": f"{machine['cpu']}, {machine['cores']} threads of hardware",
        "kernel": machine["kernel"],
        "lanes": f"{lanes or '-'}; specialize {machine['widest']['lanes']} with {machine['widest']['instruction_set']}",
        "compiler": machine["compiler"],
        "commits": commits_of(machine, reports),
        "date": time.strftime("%Y-%m-%d %H:%M UTC", time.gmtime()),
        "command": "make claims",
    }
    return "<table>" + "".join(f"<tr><th>{key}</th><td>{text(value)}</td></tr>" for key, value in rows.items()) + "</table>"


def page(registry, laboratory, verdicts, pictures):
    with open(os.path.join(HERE, "report.css"), encoding="utf-8") as file:
        style = file.read()
    tested = sum(each.text in (HOLDS, PART, FAILS) for each in verdicts)
    parts = [
        f'<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>Triptych: the claims</title><style>{style}</style>',
        '<meta name="viewport" content="width=device-width, initial-scale=1"></head><body><main>',
        "<h1>The claims, tested</h1>",
        f"<p>{len(verdicts)} claims of four texts on the emulation of graphics hardware, in words of this project. {tested} have a "
        "verdict of a rule that was written before the run. A value in brackets is an interval of 95 % confidence.</p>",
        bar(verdicts),
        legend(verdicts),
        '<h2 class="first">By chapter</h2>',
        index(registry, verdicts),
        "<h3>Where and how</h3>",
        machine_table(laboratory.machine.facts, laboratory.reports),
    ]
    for name in registry.chapters:
        inside = [each for each in verdicts if each.claim.chapter == name]
        if inside:
            parts.append(chapter_section(registry, name, inside, pictures))
    parts.append(experiments_section(registry, laboratory.reports))
    return "".join(parts) + "</main></body></html>\n"


def write(folder, registry, laboratory, verdicts):
    os.makedirs(folder, exist_ok=True)
    chosen = [name for each in verdicts for name in each.claim.figures]
    pictures = {}
    for name in dict.fromkeys(chosen):
        figure = registry.figures[name]
        pictures[name] = figure_block(figure, *draw(folder, registry, figure, laboratory))
    path = os.path.join(folder, "index.html")
    with open(path + ".new", "w", encoding="utf-8") as file:
        file.write(page(registry, laboratory, verdicts, pictures))
    os.replace(path + ".new", path)


def print_pdf(results):
    """Prints the report as PDF beside it."""
    path = os.path.join(os.path.abspath(results), "report", "index.html")
    browser = shutil.which("chromium") or shutil.which("chromium-browser")
    if not browser:
        print("claims: no PDF: Chromium is not installed (make claims installs it)", file=sys.stderr)
        return
    with tempfile.TemporaryDirectory() as profile:
        command = [browser, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={profile}", "--no-pdf-header-footer"]
        target = path[: -len("html")] + "pdf"
        run = subprocess.run(
            [*command, f"--print-to-pdf={target}", "file://" + path], capture_output=True, text=True, check=False
        )
    if run.returncode:
        print(f"claims: no PDF: {(run.stderr.strip().splitlines() or ['no message'])[-1]}", file=sys.stderr)
