"""Verdicts: what the values of a claim decide by its rules."""

import math

from number import NoValue

HOLDS, PART, FAILS = "holds", "holds in part", "does not hold"
CANNOT, NOT_YET, NONE = "cannot be tested here", "not yet", "no verdict"
ALL = (HOLDS, PART, FAILS, CANNOT, NOT_YET, NONE)


class Verdict:
    """`numbers` has a Number for each value that could be computed; `problem` explains NONE."""

    def __init__(self, claim, read):
        self.claim, self.numbers, self.problem = claim, {}, ""
        if claim.cannot or claim.needs:
            self.text = CANNOT if claim.cannot else NOT_YET
            return
        try:
            self.text = self.decide(read)
        except NoValue as error:
            self.text, self.problem = NONE, str(error)

    def decide(self, read):
        for value in self.claim.values:
            number = value.expression.number(read, self.numbers)
            if not math.isfinite(number.value) or not value.least <= number.value <= value.most:
                raise NoValue(f"{value.name} is {number.value:g}, expected {value.least:g} to {value.most:g}")
            self.numbers[value.name] = number
        if self.claim.holds.true(self.numbers):
            return HOLDS
        return PART if self.claim.part and self.claim.part.true(self.numbers) else FAILS

    def as_json(self, registry):
        claim = self.claim
        result = {
            "id": claim.id,
            "chapter": claim.chapter,
            "source": claim.source,
            "kind": claim.kind,
            "words": claim.words,
            "verdict": self.text,
            "values": [self.value_json(value) for value in claim.values if value.name in self.numbers],
            "experiments": registry.experiments_of(claim),
        }
        for field in ("holds", "part"):
            if getattr(claim, field):
                result[field] = getattr(claim, field).text
        for field in ("reasons", "needs", "cannot"):
            if getattr(claim, field):
                result[field] = getattr(claim, field)
        if self.problem:
            result["problem"] = self.problem
        return result

    def value_json(self, value):
        number = self.numbers[value.name]
        return {"name": value.name, "unit": value.unit, "value": number.value, "low": number.low, "high": number.high}


def counts(verdicts):
    return {text: sum(each.text == text for each in verdicts) for text in ALL}


def significant(value):
    """Three digits, and more only before the point."""
    if value == 0 or not math.isfinite(value):
        return f"{value:g}"
    places = max(0, 2 - math.floor(math.log10(abs(value))))
    text = f"{value:,.{places}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def written(value, number):
    """A value for people: 4.1 times [3.9, 4.3]."""
    unit = "" if value.unit == "-" else " " + value.unit.replace("_", " ")
    text = significant(number.value) + unit
    return text if number.exact() else f"{text} [{significant(number.low)}, {significant(number.high)}]"
