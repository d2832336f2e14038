"""Writes the measured figures of README.md and docs/*.md from results/.

    python3 bench/figures [--results DIR] [--pages DIR] write|check|list|files

A mark in a page names a query and its arguments; the text between its two ends is the figure:

    <!-- figure NAME ARGUMENT... -->TEXT<!-- /figure -->

  NAME       a number of results.py, or a table or line of tables.py
  ratio A / B         the quotient of two numbers, each a NAME with its arguments
  percent A / B       the same in percent
  more A / B          how many percent A is above B; less: how many percent it is below
  digits=N            significant digits of a number (3); places=N: digits after the point
  scale=X             the number is multiplied by X

`write` replaces every figure. `check` changes nothing. It prints a line for each figure that is out of date and for each
mark that it does not understand. In a page with marks it also reports each number with a unit that is outside of all
marks and not in allowed.txt. It exits with 1 if it printed a line. `list` prints every mark,
`files` every file of results/ that a mark reads.
"""

import argparse
import glob
import os
import re
import sys

sys.dont_write_bytecode = True
import results  # noqa: E402
import tables  # noqa: E402

MARK = re.compile(r"<!-- figure (.*?) -->(.*?)<!-- /figure -->", re.S)
UNITS = (
    r"ns|µs|us|ms|%|percent|times|fps|Mpix/s|Mtri/s|kdraw/s|GB/s|thousand million|million|seconds?|minutes?|hours?"
)
FIGURE = re.compile(r"(?<![\w.#/-])[-−]?\d[\d,.]*(?: to \d[\d,.]*)? ?(?:" + UNITS + r")(?![\w/-])")


def format_number(value, options):
    if isinstance(value, int) and not options:
        return f"{value:,}"
    value *= float(options.get("scale", 1))
    if "places" in options:
        return f"{value:,.{int(options['places'])}f}"
    return tables.significant(value, int(options.get("digits", 3)))


def value_of(words):
    if not words or words[0] not in results.numbers:
        raise KeyError(f"no figure has the name {words[0] if words else ''}")
    return results.numbers[words[0]](*words[1:])


def quotient_of(words):
    at = words.index("/")
    return value_of(words[:at]) / value_of(words[at + 1 :])


QUOTIENTS = {
    "ratio": lambda quotient: quotient,
    "percent": lambda quotient: 100 * quotient,
    "more": lambda quotient: 100 * (quotient - 1),
    "less": lambda quotient: 100 * (1 - quotient),
}


def figure(mark):
    """The text of a figure; raises KeyError, TypeError or ValueError if the mark is wrong."""
    words = [word for word in mark.split() if "=" not in word]
    options = dict(word.split("=", 1) for word in mark.split() if "=" in word)
    if words and words[0] in tables.texts:
        return tables.texts[words[0]](*words[1:])
    if words and words[0] in QUOTIENTS:
        return format_number(QUOTIENTS[words[0]](quotient_of(words[1:])), options)
    return format_number(value_of(words), options)


def replace(page, text, problems):
    """The page's text with every figure written; appends to problems what is wrong or out of date."""

    def one(match):
        line = text.count("\n", 0, match.start()) + 1
        try:
            new = figure(match[1])
        except (KeyError, TypeError, ValueError, IndexError, FileNotFoundError, ZeroDivisionError) as error:
            problems.append(f"{page}:{line}: figure {match[1]}: {error!r}")
            return match[0]
        if new != match[2]:
            problems.append(f"{page}:{line}: figure {match[1]}: the page and results/ disagree")
        return f"<!-- figure {match[1]} -->{new}<!-- /figure -->"

    return MARK.sub(one, text)


def read_allowed():
    """allowed.txt: a page and a text in it per line, the text holding numbers that are not measured."""
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "allowed.txt")
    with open(path, encoding="utf-8") as file:
        return [line.rstrip("\n").split(": ", 1) for line in file if line.strip() and line[0] != "#"]


def unmarked(page, text, allowed, used):
    """The numbers with a unit that are outside of marks and code blocks and are not allowed, a line each."""
    blank = lambda match: re.sub(r"[^\n]", " ", match[0])  # noqa: E731
    text = MARK.sub(blank, text)
    text = re.sub(r"^```.*?^```", blank, text, flags=re.S | re.M)
    text = re.sub(r"^    .*$", blank, text, flags=re.M)
    text = re.sub(r"\s+", " ", text)
    for entry in allowed:
        if entry[0] == page and entry[1] in text:
            used.add(tuple(entry))
            text = text.replace(entry[1], "")
    for match in FIGURE.finditer(text):
        yield f"{page}: '{match[0]}' is outside of all marks (bench/figures/allowed.txt lists definitions)"


def pages_of(folder):
    found = [os.path.join(folder, "README.md")] + sorted(glob.glob(os.path.join(folder, "docs", "*.md")))
    found.append(os.path.join(folder, "results", "fuzz.md"))
    return [path for path in found if os.path.exists(path)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--results", default="results", metavar="DIR")
    parser.add_argument("--pages", default=".", metavar="DIR")
    parser.add_argument("action", choices=["write", "check", "list", "files"])
    arguments = parser.parse_args()
    results.folder = arguments.results
    problems, allowed, used = [], read_allowed(), set()
    for path in pages_of(arguments.pages):
        page = os.path.relpath(path, arguments.pages)
        with open(path, encoding="utf-8") as file:
            text = file.read()
        before = len(problems)
        new = replace(page, text, problems)
        if arguments.action == "list":
            for match in MARK.finditer(text):
                print(f"{page}: {match[1]}")
        elif arguments.action == "check" and MARK.search(text) and not page.startswith("results"):
            problems.extend(unmarked(page, text, allowed, used))
        elif arguments.action == "write" and new != text:
            problems[before:] = [each for each in problems[before:] if not each.endswith("disagree")]
            with open(path, "w", encoding="utf-8") as file:
                file.write(new)
            print(f"{page}: written")
    if arguments.action == "check":
        for page, text in allowed:
            if (page, text) not in used:
                problems.append(f"bench/figures/allowed.txt: {page} does not contain '{text}'")
    if arguments.action == "list":
        return 0
    if arguments.action == "files":
        print(*results.read_files(), sep="\n")
        return 0
    for problem in problems:
        print(problem, file=sys.stderr)
    return 1 if problems else 0


sys.exit(main())
