"""The registry: chapters, experiments, claims and figures from bench/claims/*.claims. docs/claims.md has the format.

A record begins with one of the words of RECORDS and the record's name; its fields follow, a word and a text a line. An indented
line continues the field above it. # begins a comment line.
"""

import glob
import os
import re

import rule
from expression import BadExpression, Expression

RECORDS = ("chapter", "experiment", "claim", "figure")
FIELDS = {  # of each record; + may be repeated, ! must be there
    "chapter": {"title": "!", "source": "!"},
    "experiment": {"about": "!", "takes": "!", "run": "!+"},
    "claim": {
        "source": "!",
        "kind": "!",
        "words": "!",
        "value": "+",
        "holds": "",
        "part": "",
        "reasons": "",
        "shows": "+",
        "needs": "",
        "cannot": "",
    },
    "figure": {"title": "!", "plot": "", "column": "+", "image": "+"},
}
KINDS = ("speed", "size", "build", "qual", "listing", "design", "future")
VALUE = re.compile(r"([a-z_]\w*)\s+(\S+)(?:\s+(-?[\d.]+)\.\.(-?[\d.]+)?)?\s*=\s*(.*)", re.S)
NAMED = re.compile(r"([A-Za-z_]\w*)\s*=\s*(.*)", re.S)
IMAGE = re.compile(r"(.*?)\s*=\s*\{\s*([\w.-]+)\s*\}")
RUN = re.compile(r"([\w-]+):\s*(.*)", re.S)


class BadRegistry(Exception):
    """One line: where, what, expected."""


class Record:
    """The fields of a record as text; `where` is for messages."""

    def __init__(self, kind, name, where):
        self.kind, self.name, self.where = kind, name, where
        self.fields = {}

    def fail(self, reason):
        raise BadRegistry(f"{self.where}: {self.kind} {self.name}: {reason}")

    def one(self, field, default=None):
        return self.fields[field][0] if field in self.fields else default

    def all(self, field):
        return self.fields.get(field, [])

    def check(self):
        for field, flags in FIELDS[self.kind].items():
            if "!" in flags and field not in self.fields:
                self.fail(f"there is no field {field}")
            if "+" not in flags and len(self.all(field)) > 1:
                self.fail(f"the field {field} is there {len(self.all(field))} times, expected once")


# --- Reading ------------------------------------------------------------------------------------------------


def read_records(path):
    records, texts = [], None
    with open(path, encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            where = f"{path}:{number}"
            line = line.rstrip()
            if not line or line.lstrip().startswith("#"):
                continue
            if line[0] == " ":
                if texts is None:
                    raise BadRegistry(f"{where}: an indented line continues no field")
                texts[-1] += "\n" + line.strip()
                continue
            word, _, text = line.partition(" ")
            if word in RECORDS and re.fullmatch(r"[\w.-]+", text.strip()):
                records.append(Record(word, text.strip(), where))
                texts = None
                continue
            if not records or word not in FIELDS[records[-1].kind]:
                expected = ", ".join(FIELDS[records[-1].kind] if records else RECORDS)
                raise BadRegistry(f"{where}: '{word}' is unknown here, expected one of {expected}")
            texts = records[-1].fields.setdefault(word, [])
            texts.append(text.strip())
    for record in records:
        record.check()
    return records


class Value:
    """What a claim measures: its name, its unit, the range that it can have, and its expression."""

    def __init__(self, record, text):
        match = VALUE.fullmatch(text)
        if not match:
            record.fail(f"the value '{text}' is not NAME UNIT [LEAST..MOST] = EXPRESSION")
        self.name, self.unit, least, most, expression = match.groups()
        self.least = float(least) if least else 0.0
        self.most = float(most) if most else float("inf")
        self.expression = parse(record, expression)


class Experiment:
    def __init__(self, record):
        self.name, self.about = record.name, folded(record.one("about"))
        takes = record.one("takes")
        if not takes.isdigit() or int(takes) < 1:
            record.fail(f"takes is '{takes}', expected a number of seconds")
        self.takes = int(takes)
        self.runs = dict(self.run(record, text) for text in record.all("run"))
        if len(self.runs) < len(record.all("run")):
            record.fail("two runs have the same name")

    def run(self, record, text):
        match = RUN.fullmatch(text.replace("\n", " "))
        if not match:
            record.fail(f"the run '{text}' is not NAME: COMMAND")
        return match.groups()


class Claim:
    def __init__(self, record, chapter):
        self.id, self.chapter, self.where = record.name, chapter, record.where
        self.source, self.kind = record.one("source"), record.one("kind")
        if self.kind not in KINDS:
            record.fail(f"kind is '{self.kind}', expected one of {', '.join(KINDS)}")
        self.words, self.reasons = folded(record.one("words")), folded(record.one("reasons", ""))
        self.needs, self.cannot = folded(record.one("needs", "")), folded(record.one("cannot", ""))
        self.figures = record.all("shows")
        self.values = [Value(record, text) for text in record.all("value")]
        self.holds = self.rule(record, "holds")
        self.part = self.rule(record, "part")
        self.check(record)

    def rule(self, record, field):
        try:
            return rule.Rule(folded(record.one(field))) if record.one(field) else None
        except rule.BadRule as error:
            record.fail(str(error))

    def check(self, record):
        if sum(map(bool, (self.holds, self.needs, self.cannot))) != 1:
            record.fail("expected one of the fields holds, needs and cannot")
        if self.part and not self.holds or self.holds and not self.values:
            record.fail("a rule needs the fields value and holds")
        if self.holds and not self.reasons:
            record.fail("there is no field reasons")
        if len({each.name for each in self.values}) < len(self.values):
            record.fail("two values have the same name")
        if self.holds:
            try:
                rule.check(self.holds, self.part, {each.name: (each.least, each.most) for each in self.values})
            except rule.BadRule as error:
                record.fail(str(error))


class Figure:
    """A chart of columns by a template, columns as a table, or pictures that experiments have made."""

    def __init__(self, record):
        self.name, self.where = record.name, record.where
        self.title, self.plot = folded(record.one("title")), record.one("plot")
        self.images = dict(self.image(record, text) for text in record.all("image"))
        self.columns = {}
        if bool(self.images) == bool(record.all("column")) or self.images and self.plot:
            record.fail("expected columns, with or without a plot, or images")
        for text in record.all("column"):
            match = NAMED.fullmatch(text)
            if not match:
                record.fail(f"the column '{text}' is not NAME = EXPRESSION")
            self.columns[match[1]] = parse(record, match[2])

    def image(self, record, text):
        match = IMAGE.fullmatch(folded(text))
        if not match:
            record.fail(f"the image '{text}' is not TITLE = {{EXPERIMENT.RUN}}")
        return match.groups()


def parse(record, text):
    try:
        return Expression(folded(text))
    except BadExpression as error:
        record.fail(str(error))


def folded(text):
    return " ".join(text.split())


# --- The registry -------------------------------------------------------------------------------------------


class Registry:
    def __init__(self, folder):
        self.chapters, self.experiments, self.claims, self.figures = {}, {}, {}, {}
        paths = sorted(glob.glob(os.path.join(folder, "*.claims")))
        if not paths:
            raise BadRegistry(f"{folder}: there are no files *.claims")
        self.folder = folder
        records = [record for path in paths for record in read_records(path)]
        chapter = None
        for record in records:
            if record.kind == "chapter":
                chapter = record.name
            self.add(record, chapter)
        for kind in ("claim", "figure", "experiment"):
            for record in records:
                if record.kind == kind:
                    self.check(record)
        self.claims = dict(sorted(self.claims.items(), key=lambda pair: order(pair[0])))

    def add(self, record, chapter):
        table = getattr(self, record.kind + "s")
        if record.name in table:
            record.fail("it is there twice")
        if record.kind == "claim" and chapter is None:
            record.fail("it is in no chapter")
        made = {"experiment": Experiment, "figure": Figure, "chapter": lambda each: each}
        table[record.name] = Claim(record, chapter) if record.kind == "claim" else made[record.kind](record)

    def check(self, record):
        for expression in self.expressions(record):
            for output, _ in expression.references:
                if not self.has_output(output):
                    record.fail(f"no experiment has the output {output}")
        for output in self.figures[record.name].images.values() if record.kind == "figure" else ():
            if not self.has_output(output):
                record.fail(f"no experiment has the output {output}")
        for figure in record.all("shows"):
            if figure not in self.figures:
                record.fail(f"there is no figure {figure}")
        if record.kind == "experiment" and record.name not in self.used():
            record.fail("no claim and no figure uses it")
        if record.kind == "figure" and not any(record.name in each.figures for each in self.claims.values()):
            record.fail("no claim uses it")

    def expressions(self, record):
        if record.kind == "claim":
            return [each.expression for each in self.claims[record.name].values]
        if record.kind == "figure":
            return list(self.figures[record.name].columns.values())
        return []

    def has_output(self, output):
        experiment, _, run = output.partition(".")
        return experiment in self.experiments and run in self.experiments[experiment].runs

    def used(self):
        return {name for claim in self.claims.values() for name in self.experiments_of(claim)}

    def experiments_of(self, claim):
        """The experiments that a claim and its figures need, in the order of the registry."""
        columns = [each for name in claim.figures for each in self.figures[name].columns.values()]
        expressions = [each.expression for each in claim.values] + columns
        outputs = [output for each in expressions for output, _ in each.references]
        outputs += [output for name in claim.figures for output in self.figures[name].images.values()]
        names = {output.partition(".")[0] for output in outputs}
        return [name for name in self.experiments if name in names]


def order(identifier):
    """C before S, R and G, as in docs/claims.md, then by number."""
    match = re.fullmatch(r"([A-Z])(\d+)", identifier)
    return ("CSRG".find(match[1]), int(match[2])) if match else (99, 0)
