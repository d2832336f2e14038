"""Numbers with intervals of 95 % confidence, and operations on lists of them.

A number has a value and the ends of an interval around it. A number that was counted has an interval without width. A number
that was read from a list of runs keeps the runs: its value is their median, with the interval of the sign test. The
quotient of two such numbers is that of Hodges and Lehmann with the interval of Mann and Whitney, as in
src/command/bench/interval.h. With fewer runs than these tests need, the interval contains all values. Means combine the intervals
in quadrature; other operations combine their ends.
"""

import functools
import math
import operator

TAIL = 0.025


class Number:
    def __init__(self, value, low=None, high=None, runs=None):
        self.value = value
        self.low = value if low is None else low
        self.high = value if high is None else high
        self.runs = runs

    def exact(self):
        return self.low == self.high


class NoValue(Exception):
    """An expression has no value: one line that explains it."""


def middle(ordered):
    half = len(ordered) // 2
    return ordered[half] if len(ordered) % 2 else (ordered[half - 1] + ordered[half]) / 2


def lowest_rank(counts):
    """How many of the lowest outcomes, of these frequencies, have a probability of at most TAIL together."""
    limit, tail = sum(counts) * TAIL, 0
    for rank, count in enumerate(counts):
        tail += count
        if tail > limit:
            return rank
    return 0


@functools.cache
def sign_rank(count):
    return lowest_rank([math.comb(count, successes) for successes in range(count + 1)])


@functools.cache
def mann_whitney_rank(first, second):
    """Of the frequencies of Mann and Whitney's U: the coefficients of a Gaussian binomial."""
    counts = [1]
    for i in range(1, first + 1):
        counts += [0] * second
        for at in range(len(counts) - 1, second + i - 1, -1):
            counts[at] -= counts[at - second - i]
        for at in range(i, len(counts)):
            counts[at] += counts[at - i]
    return lowest_rank(counts)


def from_ordered(ordered, rank, runs=None):
    skip = max(rank - 1, 0)
    return Number(middle(ordered), ordered[skip], ordered[-1 - skip], runs)


def of_runs(runs):
    if not runs:
        raise NoValue("a list of runs is empty")
    return from_ordered(sorted(runs), sign_rank(len(runs)), list(runs))


def quotient_of_runs(first, second):
    if not all(value > 0 for value in first + second):
        raise NoValue("a run is not positive")
    return from_ordered(sorted(a / b for a in first for b in second), mann_whitney_rank(len(first), len(second)))


def divide(a, b):
    if a.runs and b.runs:
        return quotient_of_runs(a.runs, b.runs)
    if b.low <= 0 <= b.high:
        raise NoValue("a divisor is zero")
    return combine(operator.truediv, a, b)


def combine(operation, a, b):
    ends = [operation(x, y) for x in (a.low, a.high) for y in (b.low, b.high)]
    return Number(operation(a.value, b.value), min(ends), max(ends))


OPERATIONS = {
    "+": functools.partial(combine, operator.add),
    "-": functools.partial(combine, operator.sub),
    "*": functools.partial(combine, operator.mul),
    "/": divide,
}

COMPARISONS = {
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}


def compared(comparison, a, b):
    """Element by element; 1 where it is true of the values. Texts are compared as texts."""
    value = lambda each: each.value if isinstance(each, Number) else each  # noqa: E731
    try:
        return Number(int(COMPARISONS[comparison](value(a), value(b))))
    except TypeError:
        raise NoValue(f"'{value(a)}' and '{value(b)}' cannot be compared by {comparison}") from None


def monotone(function):
    """A function of a list that grows with every element: its ends follow from the ends of the elements."""

    def summary(numbers):
        check_numbers(numbers)
        ends = [function([getattr(each, end) for each in numbers]) for end in ("value", "low", "high")]
        return Number(*ends)

    return summary


def averaged(function, scale, back):
    """A mean. Its parts were measured independently, so the distances to their ends combine in quadrature: after `scale`, the mean's
    distance to an end is the root of the sum of the squares, divided by the number of parts."""

    def summary(numbers):
        check_numbers(numbers)
        value = function([each.value for each in numbers])
        ends = []
        for end in ("low", "high"):
            distances = [scale(getattr(each, end)) - scale(each.value) for each in numbers]
            distance = math.sqrt(sum(each * each for each in distances)) / len(numbers)
            ends.append(back(scale(value) + (distance if end == "high" else -distance)) if distance else value)
        return Number(value, *ends)

    return summary


def logarithm(value):
    if value <= 0:
        raise NoValue("a geometric mean needs positive numbers")
    return math.log(value)


def check_numbers(numbers):
    if not numbers:
        raise NoValue("a list is empty")
    for each in numbers:
        if not isinstance(each, Number):
            raise NoValue(f"'{each}' is not a number")


def quantile(values, share):
    ordered = sorted(values)
    return ordered[min(int(share * len(ordered)), len(ordered) - 1)]


SUMMARIES = {
    "mean": averaged(lambda values: sum(values) / len(values), float, float),
    "geomean": averaged(lambda values: math.exp(sum(map(logarithm, values)) / len(values)), logarithm, math.exp),
    "median": monotone(lambda values: middle(sorted(values))),
    "p90": monotone(lambda values: quantile(values, 0.9)),
    "p99": monotone(lambda values: quantile(values, 0.99)),
    "sum": monotone(sum),
    "least": monotone(min),
    "most": monotone(max),
    "list": lambda items: items,
    "count": lambda items: Number(len(items)),
    "distinct": lambda items: Number(len({each.value if isinstance(each, Number) else each for each in items})),
}
