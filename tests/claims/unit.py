"""Tests of bench/claims: numbers, expressions, rules, verdicts. Prints a line "ok NAME" or "FAIL NAME" for each."""

import os
import sys

sys.dont_write_bytecode = True
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "bench", "claims"))
import number  # noqa: E402
import rule  # noqa: E402
import verdict  # noqa: E402
from expression import BadExpression, Expression, items_at  # noqa: E402
from number import NoValue, Number  # noqa: E402

BENCH = {
    "streams": [
        {
            "stream": "first",
            "engines": [
                {"engine": "slow", "ms": 8, "runs": [8.0, 8.1, 7.9, 8.2, 8.05, 7.95], "same": True},
                {"engine": "fast", "ms": 2, "runs": [2.0, 2.1, 1.9, 2.05, 1.95, 2.02], "same": False},
            ],
        },
        {"stream": "second", "engines": [{"engine": "slow", "ms": 18}, {"engine": "fast", "ms": 2}]},
    ]
}
TEXT = "  1 vaddps ymm1\n  2 vmulps ymm2\n  3 vaddps ymm3\ncost: 2.5\ncost: 4\n"


def read(output, path):
    if path is None:
        return [TEXT]
    return items_at(BENCH, path)


def value(text):
    return Expression(text).number(read).value


def refused(error, call, *words):
    try:
        call()
    except error as reason:
        lines = str(reason).splitlines()
        return len(lines) == 1 and all(word in lines[0] for word in words)
    return False


# --- Expressions ------------------------------------------------------------------------------------------------


def test_a_path_leads_through_members_elements_and_filters():
    assert value("{b: streams[stream=second].engines[engine=slow].ms}") == 18
    assert value("sum({b: streams[*].engines[*].ms})") == 30
    assert value("{b: streams[-1].engines[0].ms}") == 18
    assert value("count({b: streams[*].engines[ms>=8].ms})") == 2
    assert value("count({b: streams[stream~^f].engines[*].ms})") == 2
    assert value("count({b: streams[*].engines[engine!=slow].ms})") == 2


def test_a_path_leads_back_to_the_object_around():
    items = Expression("{b: streams[*].engines[engine=fast].^.stream}").items(read)
    assert items == ["first", "second"], items


def test_truth_is_one_and_zero():
    assert value("sum({b: streams[0].engines[*].same})") == 1


def test_lists_are_combined_item_by_item():
    quotient = "{b: streams[*].engines[engine=slow].ms} / {b: streams[*].engines[engine=fast].ms}"
    assert value(f"least({quotient})") == 4 and value(f"most({quotient})") == 9
    assert abs(value(f"geomean({quotient})") - 6) < 1e-9
    assert value(f"sum({quotient} >= 5)") == 1


def test_lists_of_different_lengths_have_no_value():
    wrong = Expression("sum({b: streams[*].engines[*].ms} / {b: streams[*].engines[engine=fast].ms})")
    assert refused(NoValue, lambda: wrong.number(read), "4", "2")


def test_a_missing_member_has_no_value():
    missing = Expression("{b: streams[0].engines[0].nothing}")
    assert refused(NoValue, lambda: missing.number(read), "0 items")
    assert refused(NoValue, lambda: Expression("mean({b: streams[0].nothing})").number(read), "empty")


def test_texts_are_counted_and_searched():
    assert value('lines({t}, "vaddps")') == 2
    assert value('sum(captured({t}, "^cost: ([0-9.]+)"))') == 6.5


def test_expressions_with_errors_are_refused_in_one_line():
    for text in ("1 +", "open('x')", "{b: streams[}", "{b: [a b]}", "[1, 2]", "x.y", "2 ** 3", "not 1", "1 < 2 < 3"):
        assert refused(BadExpression, lambda: Expression(text)), text  # noqa: B023


def test_an_expression_uses_earlier_values():
    assert Expression("a / 2").number(read, {"a": Number(6)}).value == 3
    assert refused(NoValue, lambda: Expression("b / 2").number(read, {"a": Number(6)}), "b")


# --- Numbers ----------------------------------------------------------------------------------------------------


def test_ranks_of_mann_and_whitney_are_those_of_the_tables():
    # Critical values of U for a two-sided test of 5 %: 2 for 5 and 5, 23 for 10 and 10, 64 for 15 and 15.
    assert number.mann_whitney_rank(5, 5) == 3
    assert number.mann_whitney_rank(10, 10) == 24
    assert number.mann_whitney_rank(15, 15) == 65
    assert number.mann_whitney_rank(3, 3) == 0


def test_ranks_of_the_sign_test_are_those_of_the_tables():
    assert number.sign_rank(5) == 0 and number.sign_rank(6) == 1 and number.sign_rank(15) == 4


def test_quotients_of_runs_have_an_interval():
    path = "{b: streams[0].engines[engine=%s].runs}"
    quotient = Expression(f"{path % 'slow'} / {path % 'fast'}").number(read)
    assert 3.6 < quotient.low < quotient.value < quotient.high < 4.5, quotient
    same = Expression(f"{path % 'slow'} / {path % 'slow'}").number(read)
    assert same.low < 1 < same.high


def test_ends_of_intervals_are_combined():
    a, b = Number(2, 1, 3), Number(4, 2, 5)
    assert (number.OPERATIONS["-"](a, b).low, number.OPERATIONS["-"](a, b).high) == (-4, 1)
    assert (number.OPERATIONS["/"](a, b).low, number.OPERATIONS["/"](a, b).high) == (0.2, 1.5)


def test_means_combine_independent_intervals_in_quadrature():
    mean = number.SUMMARIES["mean"]([Number(10, 7, 13), Number(20, 16, 24)])
    assert (mean.value, mean.low, mean.high) == (15, 12.5, 17.5)
    geomean = number.SUMMARIES["geomean"]([Number(4, 2, 8)] * 4)
    assert abs(geomean.value - 4) < 1e-12 and abs(geomean.low - 8**0.5) < 1e-12 and abs(geomean.high - 32**0.5) < 1e-12
    exact = number.SUMMARIES["geomean"]([Number(2), Number(8)])
    assert exact.exact() and abs(exact.value - 4) < 1e-12
    assert refused(NoValue, lambda: number.SUMMARIES["geomean"]([Number(0)]), "positive")


def test_division_by_an_interval_with_zero_has_no_value():
    assert refused(NoValue, lambda: number.OPERATIONS["/"](Number(1), Number(1, -1, 2)), "zero")


# --- Rules ------------------------------------------------------------------------------------------------------


def true(text, **values):
    return rule.Rule(text).true(values)


def test_a_comparison_is_true_only_of_the_whole_interval():
    wide = Number(5, 4, 6)
    assert true("x >= 4", x=wide) and not true("x >= 4.5", x=wide) and not true("x > 4", x=wide)
    assert true("x <= 6", x=wide) and not true("x <= 5.5", x=wide) and not true("x < 6", x=wide)
    assert not true("x == 5", x=wide) and true("x == 5", x=Number(5)) and not true("x == 5", x=Number(4))
    assert true("x != 7", x=wide) and not true("x != 4", x=wide)


def test_comparisons_are_joined():
    assert true("x >= 1 and y < 2", x=Number(1), y=Number(1)) and not true("x >= 1 and y < 2", x=Number(1), y=Number(2))
    assert true("x > 1 or y < 2", x=Number(1), y=Number(1)) and not true("x > 1 or y < 2", x=Number(1), y=Number(2))


def test_two_values_are_compared():
    assert true("x < y", x=Number(1), y=Number(2)) and not true("x < y", x=Number(1, 0, 2), y=Number(2))


def test_rules_with_errors_are_refused_in_one_line():
    for text in ("", "x", "x >", "x >= 1 and", "x >= 1 and y < 2 or y > 3", "3 > x", "x => 3"):
        assert refused(rule.BadRule, lambda: rule.Rule(text)), text  # noqa: B023


def checked(holds, part="", **ranges):
    rule.check(rule.Rule(holds), rule.Rule(part) if part else None, ranges)


ANY = (0, float("inf"))


def test_a_rule_that_cannot_fail_is_refused():
    for text in ("x >= 0", "x > 5 or x <= 5", "x != -1", "x >= -3"):
        assert refused(rule.BadRule, lambda: checked(text, x=ANY), "cannot fail"), text  # noqa: B023
    assert refused(rule.BadRule, lambda: checked("x >= 4", "x >= 0", x=ANY), "cannot fail")
    assert refused(rule.BadRule, lambda: checked("x <= 100", x=(0, 100)), "cannot fail")


def test_a_rule_that_cannot_be_true_is_refused():
    for text in ("x < 0", "x > 5 and x < 4", "x > 3 and x < 3"):
        assert refused(rule.BadRule, lambda: checked(text, x=ANY), "cannot be true"), text  # noqa: B023


def test_a_weaker_rule_must_be_weaker():
    assert refused(rule.BadRule, lambda: checked("x >= 4", "x >= 5", x=ANY), "adds nothing")
    checked("x >= 4", "x >= 2", x=ANY)
    checked("x < y", "x < z", x=ANY, y=ANY, z=ANY)


def test_a_rule_of_an_unknown_value_is_refused():
    assert refused(rule.BadRule, lambda: checked("y >= 4", x=ANY), "y")


# --- Verdicts ---------------------------------------------------------------------------------------------------


class AnyClaim:
    def __init__(self, holds, part, expression, most=float("inf")):
        self.cannot = self.needs = ""
        self.holds, self.part = rule.Rule(holds), rule.Rule(part) if part else None
        self.values = [type("Value", (), {"name": "x", "least": 0, "most": most, "expression": Expression(expression)})]


def decided(*arguments):
    return verdict.Verdict(AnyClaim(*arguments), read)


def test_rules_decide_the_verdict():
    assert decided("x >= 4", "x >= 2", "5").text == verdict.HOLDS
    assert decided("x >= 4", "x >= 2", "3").text == verdict.PART
    assert decided("x >= 4", "x >= 2", "1").text == verdict.FAILS
    assert decided("x >= 4", "", "3").text == verdict.FAILS


def test_a_missing_value_is_no_verdict():
    none = decided("x >= 4", "", "{b: streams[0].nothing}")
    assert none.text == verdict.NONE and "expected one number" in none.problem


def test_a_value_outside_of_its_range_is_no_verdict():
    assert decided("x >= 4", "", "101", 100).text == verdict.NONE


def test_three_digits_are_written():
    written = [verdict.significant(each) for each in (0, 0.012345, 4.0, 62.15, 12345.6)]
    assert written == ["0", "0.0123", "4", "62.1", "12,346"] or written[3] == "62.2", written


failed = 0
for name, test in list(globals().items()):
    if name.startswith("test_"):
        try:
            test()
            print("ok", name[5:].replace("_", " "))
        except AssertionError as error:
            print("FAIL", name[5:].replace("_", " "))
            print(error, file=sys.stderr)
            failed = 1
sys.exit(failed)
