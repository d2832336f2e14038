"""Rules of verdicts: comparisons of values with numbers or with other values, joined by `and` or by `or`.

    speedup >= 25 and differing == 0

A comparison is true only if it is true of the whole interval of the value: of its low end for >= and >, of its high end for
<= and <, of both for == and !=. A rule is refused if no outcome within the ranges of its values would make it false, or
none would make it true.
"""

import itertools
import math
import random
import re

from number import COMPARISONS, Number

TERM = re.compile(r"\s*([a-z_][\w]*)\s*(==|!=|<=|>=|<|>)\s*([a-z_]\w*|-?[\d.]+(?:e-?\d+)?)\s*")


BY_CHANCE = 1000


class BadRule(Exception):
    """A rule that cannot be understood, or cannot fail: one line that explains it."""


class Rule:
    def __init__(self, text):
        self.text = text
        words = re.split(r"\b(and|or)\b", text)
        if len(set(words[1::2])) > 1:
            raise BadRule(f"the rule '{text}' has both `and` and `or`, expected one of them")
        self.join = any if "or" in words[1::2] else all
        self.terms = [self.term(word) for word in words[::2]]

    def term(self, text):
        match = TERM.fullmatch(text)
        if not match:
            raise BadRule(f"the rule '{self.text}' has '{text.strip()}', expected NAME COMPARISON NUMBER-OR-NAME")
        return match.groups()

    def names(self):
        return {word for left, _, right in self.terms for word in (left, right) if word[0].isalpha() or word[0] == "_"}

    def thresholds(self):
        return {float(right) for _, _, right in self.terms if not right[0].isalpha() and right[0] != "_"}

    def true(self, values):
        """`values` has a Number for each name."""
        operand = lambda word: values[word] if word in values else Number(float(word))  # noqa: E731
        return self.join(surely(comparison, operand(left), operand(right)) for left, comparison, right in self.terms)


def surely(comparison, a, b):
    test = COMPARISONS[comparison]
    return all(test(x, y) for x in (a.low, a.high) for y in (b.low, b.high))


def outcomes(rules, ranges):
    """Values to try: the ends of each range, each threshold and each end, and what is beside them. Some combinations by
    chance are first, because they nearly always have every outcome; all combinations follow."""
    marks = {end for pair in ranges.values() for end in pair if math.isfinite(end)}
    for rule in rules:
        marks |= rule.thresholds()
    nearby = sorted({mark + step for mark in marks for step in (-1e9, -1, -1e-6, 0, 1e-6, 1, 1e9)})
    names = sorted(set().union(*(rule.names() for rule in rules)))
    choices = [[value for value in nearby if ranges[name][0] <= value <= ranges[name][1]] for name in names]
    if math.prod(map(len, choices)) > 2_000_000:
        choices = [thinned(each) for each in choices]
    chance = random.Random(1)
    by_chance = (tuple(map(chance.choice, choices)) for _ in range(BY_CHANCE if all(choices) else 0))
    for values in itertools.chain(by_chance, itertools.product(*choices)):
        yield {name: Number(value) for name, value in zip(names, values)}


def thinned(values):
    return values if len(values) <= 8 else values[:: max(1, len(values) // 8)] + [values[-1]]


def check(holds, part, ranges):
    """Refuses rules that cannot decide: `ranges` has the least and the most of each value."""
    rules = [holds] + ([part] if part else [])
    for name in set().union(*(rule.names() for rule in rules)):
        if name not in ranges:
            raise BadRule(f"no value has the name {name}, which a rule uses")
    found = set()
    for values in outcomes(rules, ranges):
        found.add("holds" if holds.true(values) else "part" if part and part.true(values) else "fails")
        if len(found) == 2 + bool(part):
            return
    if "fails" not in found:
        raise BadRule(f"the rule '{(part or holds).text}' cannot fail")
    if "holds" not in found:
        raise BadRule(f"the rule '{holds.text}' cannot be true")
    if part and "part" not in found:
        raise BadRule(f"the rule '{part.text}' adds nothing to '{holds.text}'")
