"""Runs Wine's Direct3D 9 tests on Triptych and on Wine's own Direct3D 9, and reports them side by side.

    python3 bench/d3d9/conformance.py --tests FOLDER --triptych COMMAND --engine E --threads N --results FOLDER [SUITE...]

The desktop (bench/d3d9/desktop.sh) runs. Writes conformance.md and conformance.json. Exits with 1 if one of ours
crashed or hung, or a threshold was missed. reasons.txt explains failures: `PLACE | WORDS`, where PLACE is FILE:LINE or
FILE FUNCTION and WORDS are words of the interface's documentation and what they mean here.
"""

import argparse
import os
import shlex
import subprocess
import sys

sys.dont_write_bytecode = True
import machine  # noqa: E402
from report import read_reasons, write_json  # noqa: E402
from suites import SUITES, Run, function_names, total  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
SIDES = ("triptych", "wine")
# Suites that test windows: what arrives when depends on the window manager, too.
REPEATED = ("d3d9ex", "device")
COLUMNS = ("checks", "failures", "todo", "better", "skipped", "milliseconds")


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tests", required=True, help="the folder of bench/d3d9/wine-tests.sh")
    parser.add_argument("--triptych", required=True, help="the command triptych")
    parser.add_argument("--engine", default="specialize")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--limit", type=float, default=300, help="seconds of one test function")
    parser.add_argument("--results", default="results")
    parser.add_argument("suites", nargs="*", default=SUITES)
    return parser.parse_args()


def reset_desktop():
    subprocess.run(["bash", "-c", f". {shlex.quote(HERE)}/desktop.sh; desktop_reset"], check=False)


def commands(options):
    """The command without the suite, and its environment, of each side."""
    program = os.path.abspath(os.path.join(options.tests, "d3d9_test.exe"))
    threads = str(options.threads)
    ours = [os.path.abspath(options.triptych), "run", "--engine", options.engine, "--threads", threads, program]
    return {
        "triptych": (ours, {}),
        "wine": (["wine", program], {"WINEDLLOVERRIDES": "d3d9=b", "LP_NUM_THREADS": threads}),
    }


def run_suites(options):
    report = []
    for suite in options.suites:
        sides, both = {}, commands(options)
        names = function_names(both["wine"][0], suite, both["wine"][1])
        for side, (command, environment) in both.items():
            folder = os.path.join(options.tests, side)
            os.makedirs(folder, exist_ok=True)
            reset_desktop()
            run = sides[side] = Run(command, environment, folder, options.limit)
            run.suite(suite, names, reset_desktop)
            if suite in REPEATED:
                run.repeat(suite, reset_desktop)
            print(f"{suite:10} {side:8} {summary_line(run.functions)}", flush=True)
        report.append(suite_report(suite, names, sides))
    return report


def summary_line(functions):
    counts = ", ".join(f"{total(functions, name):,} {name}" for name in COLUMNS[:-1])
    stopped = [f"{name} ({each['result']})" for name, each in functions.items() if each["result"] != "end"]
    return f"{counts}, {total(functions, 'milliseconds') / 1000:.1f} s" + "".join(f", {each}" for each in stopped)


def suite_report(suite, names, sides):
    return {
        "suite": suite,
        "functions": [{"name": name, **{side: sides[side].functions[name] for side in SIDES}} for name in names],
        "failures": {side: grouped(sides[side].failures) for side in SIDES},
    }


def grouped(failures):
    """One entry for each place that failed: its count and the first message."""
    places = {}
    for each in failures:
        key = (each["function"], each["file"], each["line"])
        places.setdefault(key, {**each, "count": 0})["count"] += 1
    return list(places.values())


def explain(report):
    """Gives each of our failures its reason, or None."""
    known = read_reasons(os.path.join(HERE, "reasons.txt"))
    for suite in report:
        for each in suite["failures"]["triptych"]:
            places = (f"{each['file']}:{each['line']}", f"{each['file']} {each['function']}")
            each["reason"] = next((known[place] for place in places if place in known), None)


def side_of(suite, side):
    return {each["name"]: each[side] for each in suite["functions"]}


def violations(suite):
    """The thresholds that a suite misses, as sentences."""
    ours, wines = side_of(suite, "triptych"), side_of(suite, "wine")
    name, found = suite["suite"], []
    for function, each in ours.items():
        if each["result"] != "end":
            found.append(f"{name}: {function}: {each['result']}")
    failures, theirs, executed = total(ours, "failures"), total(wines, "failures"), total(wines, "checks")
    share = 100 * (total(ours, "checks") - failures) / max(executed, 1)
    unexplained = sum(each["reason"] is None for each in suite["failures"]["triptych"])
    if name == "stateblock" and failures:
        found.append(f"{name}: {failures} failures, expected none")
    if name == "visual" and failures > theirs:
        found.append(f"{name}: {failures} failures, Wine's own has {theirs}")
    least = {"visual": 95, "device": 97}.get(name, 0)
    if share < least:
        found.append(f"{name}: {share:.2f} % of the {executed:,} checks of Wine's own pass, expected {least} %")
    if name in ("device", "d3d9ex") and unexplained:
        found.append(f"{name}: {unexplained} failing places without a reason in bench/d3d9/reasons.txt")
    return found


def table(heads, rows):
    line = lambda cells: "| " + " | ".join(cells) + " |"  # noqa: E731
    rule = ["---"] + ["---:"] * (len(heads) - 1)
    return "\n".join([line(heads), line(rule), *map(line, rows)])


def cells(functions):
    """The cells of one side: the first tells a function that did not reach its end."""
    results = {each["result"] for each in functions.values()} - {"end"}
    if len(functions) == 1 and results:
        return [f"**{results.pop()}**"] + [""] * (len(COLUMNS) - 1)
    return [f"{total(functions, name):,}" for name in COLUMNS[:-1]] + [f"{total(functions, 'milliseconds') / 1000:.1f}"]


def row(name, ours, wines):
    """Pairs of columns: Triptych's value, Wine's value."""
    return [name] + [cell for pair in zip(cells(ours), cells(wines)) for cell in pair]


def function_row(each):
    name = f"`{each['name']}`" + (f" ({each['triptych']['runs']} runs)" if each["triptych"].get("runs", 1) > 1 else "")
    return row(name, {"": each["triptych"]}, {"": each["wine"]})


HEADS = ("checks", "failures", "todo", "better", "skipped", "s")
BOTH = [head for each in HEADS for head in (each, "Wine")]


def place_line(each, side):
    text = f"- `{each['file']}:{each['line']}` {each['function']}, {each['count']} times: {each['message']}"
    if side == "triptych":
        text += f"\n  {each['reason']}" if each["reason"] else "\n  **unexplained**"
    return text


def suite_section(suite):
    parts = [f"## {suite['suite']}", table(["test function", *BOTH], map(function_row, suite["functions"]))]
    for side, title in (("triptych", "Failures of Triptych"), ("wine", "Failures of Wine's own Direct3D 9")):
        failures = suite["failures"][side]
        parts.append(f"{title}: {'none' if not failures else ''}".rstrip() + ("." if not failures else ""))
        parts += ["\n".join(place_line(each, side) for each in failures)] if failures else []
    return parts


def page(document):
    host, engine = document["machine"], document["engine"]
    head = f"""# Wine's Direct3D 9 tests

Written by `{document['command']}`. {document['tests']}; Triptych: engine {engine['engine']}, {engine['lanes']} lanes
({engine['instruction_set']}), {document['threads']} threads, commit {host['commit']}; compared with Wine's own Direct3D 9 on
llvmpipe ({', '.join(' '.join(each) for each in document['renderers'].items())}), in the same run. {host['cpu']}, {host['cores']} cores,
{host['date']}.

"todo" are checks that the tests expect to fail on Wine and that fail; "better" are those of them that pass. Both are
part of "checks"; neither is a failure. In the suites {' and '.join(REPEATED)}, the messages that a window receives also
depend on the window manager's timing: a function that fails there, on either side, runs up to two more times, and the
run with the fewest failures is reported. Each failing place of Triptych has its reason from bench/d3d9/reasons.txt."""
    rows = [row(each["suite"], side_of(each, "triptych"), side_of(each, "wine")) for each in document["suites"]]
    missed = [f"- {each}" for each in document["missed"]]
    verdict = "Every threshold is met." if not missed else "Missed:\n\n" + "\n".join(missed)
    sections = [part for suite in document["suites"] for part in suite_section(suite)]
    return "\n\n".join([head, table(["suite", *BOTH], rows), verdict, *sections]) + "\n"


def main():
    options = arguments()
    suites = run_suites(options)
    explain(suites)
    with open(os.path.join(options.tests, "version"), encoding="utf-8") as file:
        version = file.read().strip()
    document = {
        "machine": machine.machine(),
        "engine": machine.engine(options.triptych, options.engine),
        "threads": options.threads,
        "tests": f"Tests of Debian's source package {version}",
        "renderers": machine.renderers(*machine.WINE),
        "command": "make conformance-d3d9",
        "missed": [each for suite in suites for each in violations(suite)],
        "suites": suites,
    }
    write_json(options.results, "conformance.json", document)
    with open(os.path.join(options.results, "conformance.md"), "w", encoding="utf-8") as file:
        file.write(page(document))
    for each in document["missed"]:
        print("MISSED " + each)
    return 1 if document["missed"] else 0


sys.exit(main())
