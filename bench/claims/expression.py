"""Expressions: how a value follows from the outputs of experiments.

    geomean({streams: streams[*].engines[engine=emulate].samples.frame_ms} / {streams: ...})

A reference in braces names an output and a path in it. The path is a sequence of steps with dots between them:

  name                a member of an object
  [*]                 every element of a list
  [name=text]         the elements whose member has this text; also != and ~ (a regular expression)
  [name>=number]      also <=, >, <
  [number]            the element of this index, from 0; negative: from the end
  ^                   the object or the list around it, without the list's own step

It has one item for each place that it leads to: a number, a text, or a list of runs. {output} without a path is the
output's text. Operators + - * / and comparisons work item by item; an operand of one item is used for each of the
other's. Functions of number.py make one number of a list. Functions of texts are below.
"""

import ast
import re

from number import COMPARISONS, OPERATIONS, SUMMARIES, NoValue, Number, compared, of_runs

REFERENCE = re.compile(r"\{\s*([\w.-]+)\s*(?::\s*(.*?))?\s*\}")
STEP = re.compile(r"(?P<name>[A-Za-z_][\w-]*)|(?P<up>\^)|\[(?P<filter>[^]]*)\]")
FILTER = re.compile(r"([\w-]+)\s*(!=|>=|<=|=|~|>|<)\s*(.*)")
TESTS = {
    "=": lambda item, text: as_text(item) == text,
    "!=": lambda item, text: as_text(item) != text,
    "~": lambda item, text: re.search(text, as_text(item)) is not None,
    ">=": lambda item, text: float(item) >= float(text),
    "<=": lambda item, text: float(item) <= float(text),
    ">": lambda item, text: float(item) > float(text),
    "<": lambda item, text: float(item) < float(text),
}


class BadExpression(Exception):
    """An expression that cannot be understood: one line that explains it."""


def as_text(item):
    return str(item).lower() if isinstance(item, bool) else str(item)


# --- Paths --------------------------------------------------------------------------------------------------


def steps_of(path):
    steps, at = [], 0
    while at < len(path):
        match = STEP.match(path, at)
        if not match:
            raise BadExpression(f"the path {path} has '{path[at:]}', expected a name, ^ or [...]")
        steps.append(step_of(match))
        at = match.end()
        if at < len(path) and path[at] == ".":
            at += 1
    return steps


def step_of(match):
    if match["name"]:
        return member(match["name"])
    if match["up"]:
        return lambda place: [place[:-1]]
    text = match["filter"]
    if text == "*":
        return elements
    if re.fullmatch(r"-?\d+", text):
        return lambda place: elements(place)[int(text) :][:1]
    found = FILTER.fullmatch(text)
    if not found:
        raise BadExpression(f"the filter [{text}] is unknown, expected *, a number, or a name, an operator, a text")
    return filtered(*found.groups())


def member(name):
    def step(place):
        item = place[-1]
        return [place + (item[name],)] if isinstance(item, dict) and name in item else []

    return step


def elements(place):
    """A place is the tuple of the objects from the root to the item. A list's elements replace it there."""
    return [place[:-1] + (each,) for each in place[-1]] if isinstance(place[-1], list) else []


def filtered(name, comparison, text):
    def step(place):
        places = elements(place) if isinstance(place[-1], list) else [place]
        return [each for each in places if name in each[-1] and TESTS[comparison](each[-1][name], text)]

    return step


def items_at(root, path):
    places = [(root,)]
    for step in steps_of(path):
        places = [after for place in places for after in step(place)]
    return [item_of(place[-1]) for place in places]


def item_of(item):
    if isinstance(item, bool):
        return Number(int(item))
    if isinstance(item, (int, float)):
        return Number(item)
    if isinstance(item, str):
        return item
    if isinstance(item, list) and all(isinstance(each, (int, float)) for each in item):
        return of_runs(item)
    raise NoValue("a path leads to an object, expected a number, a text or a list of numbers")


# --- Functions of texts -----------------------------------------------------------------------------------------


def lines(text, pattern):
    """The number of lines that match."""
    return Number(sum(1 for line in only_text(text).splitlines() if re.search(pattern, line)))


def captured(text, pattern):
    """The numbers that the pattern's group matches."""
    return [Number(float(each)) for each in re.findall(pattern, only_text(text), re.M)]


def only_text(items):
    if len(items) != 1 or not isinstance(items[0], str):
        raise NoValue("expected one text")
    return items[0]


TEXTS = {"lines": lines, "captured": captured}


# --- Functions of groups ----------------------------------------------------------------------------------------


def plain(item):
    return item.value if isinstance(item, Number) else item


def names(items):
    """The different items, in the order of their first places."""
    return list({plain(each): each for each in reversed(as_list(items))}.values())[::-1]


def geomeans(items, values):
    """The geometric mean of the values beside each different item, in the order of names()."""
    items, values = as_list(items), as_list(values)
    if len(items) != len(values):
        raise NoValue(f"lists of {len(items)} and {len(values)} items, expected the same number")
    groups = {plain(each): [] for each in items}
    for item, value in zip(items, values):
        groups[plain(item)].append(value)
    return [SUMMARIES["geomean"](groups[plain(each)]) for each in names(items)]


GROUPS = {"names": (names, 1), "geomeans": (geomeans, 2)}
FUNCTIONS = [*SUMMARIES, *TEXTS, *GROUPS]


# --- Expressions ------------------------------------------------------------------------------------------------


class Expression:
    """A checked expression. `references` lists its (output, path) pairs; the path is null for the whole text."""

    def __init__(self, text):
        self.text = text
        self.references = []
        prepared = REFERENCE.sub(self.reserve, text)
        try:
            self.tree = ast.parse(prepared.strip(), mode="eval").body
        except SyntaxError:
            raise BadExpression(f"the expression {text} has an error of syntax") from None
        check(self.tree, text)

    def reserve(self, match):
        output, path = match[1], match[2]
        if path is not None:
            steps_of(path)
        self.references.append((output, path))
        return f"_{len(self.references) - 1}"

    def items(self, read, named=None):
        """The list of its items. read(output, path) gives those of a reference; `named` has those of names."""
        self.read, self.named = read, named or {}
        result = self.evaluate(self.tree)
        return result if isinstance(result, list) else [result]

    def number(self, read, named=None):
        items = self.items(read, named)
        if len(items) != 1 or not isinstance(items[0], Number):
            raise NoValue(f"{self.text} has {len(items)} items, expected one number")
        return items[0]

    def evaluate(self, node):
        if isinstance(node, ast.Constant):
            return node.value if isinstance(node.value, str) else Number(node.value)
        if isinstance(node, ast.Name):
            return self.name(node.id)
        if isinstance(node, ast.BinOp):
            operation = OPERATIONS[SYMBOLS[type(node.op)]]
            return pairwise(operation, self.evaluate(node.left), self.evaluate(node.right))
        if isinstance(node, ast.Compare):
            comparison = SYMBOLS[type(node.ops[0])]
            left, right = self.evaluate(node.left), self.evaluate(node.comparators[0])
            return pairwise(lambda a, b: compared(comparison, a, b), left, right)
        return self.call(node)

    def name(self, name):
        if name[0] == "_":
            return self.read(*self.references[int(name[1:])])
        if name not in self.named:
            raise NoValue(f"no value has the name {name}")
        return self.named[name]

    def call(self, node):
        name, arguments = node.func.id, [self.evaluate(each) for each in node.args]
        if name in TEXTS:
            return TEXTS[name](*arguments)
        if name in GROUPS:
            return GROUPS[name][0](*arguments)
        return SUMMARIES[name]([item for each in arguments for item in as_list(each)])


SYMBOLS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}
SYMBOLS |= {ast.Eq: "==", ast.NotEq: "!=", ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}


def as_list(value):
    return value if isinstance(value, list) else [value]


def pairwise(operation, left, right):
    left, right = as_list(left), as_list(right)
    if len(left) == 1:
        left = left * len(right)
    if len(right) == 1:
        right = right * len(left)
    if len(left) != len(right):
        raise NoValue(f"lists of {len(left)} and {len(right)} items, expected the same number")
    return [operation(a, b) for a, b in zip(left, right)]


def check(node, text):
    """Refuses everything that evaluate() does not have."""
    if isinstance(node, ast.Call):
        if not isinstance(node.func, ast.Name) or node.func.id not in FUNCTIONS or node.keywords:
            raise BadExpression(f"{text}: unknown function, expected one of {', '.join(FUNCTIONS)}")
        children = node.args
        if node.func.id in TEXTS and (len(children) != 2 or not isinstance(children[1], ast.Constant)):
            raise BadExpression(f"{text}: {node.func.id} has a text and a pattern")
        if node.func.id in GROUPS and len(children) != GROUPS[node.func.id][1]:
            raise BadExpression(f"{text}: {node.func.id} has {GROUPS[node.func.id][1]} lists")
    elif isinstance(node, ast.BinOp) and type(node.op) in SYMBOLS:
        children = [node.left, node.right]
    elif isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in SYMBOLS:
        children = [node.left, *node.comparators]
    elif isinstance(node, ast.Name) or isinstance(node, ast.Constant) and isinstance(node.value, (int, float, str)):
        children = []
    else:
        raise BadExpression(f"{text}: expected references, numbers, + - * /, comparisons and functions")
    for child in children:
        check(child, text)


assert set(COMPARISONS) <= set(SYMBOLS.values())
