"""Runs a suite of Khronos' dEQP on Triptych and on Mesa's llvmpipe, and reports both by groups of cases.

    python3 bench/gles/conformance.py --suite gles2|egl --deqp FOLDER --triptych COMMAND --results FOLDER --work FOLDER [GLOB...]

FOLDER has bin/deqp-SUITE with its data files beside it, and lists/SUITE.txt, a list of cases. Writes
conformance-SUITE.json, and in the folder --work a file SUITE-SIDE.tsv: case, status and message of each case. Exits with 1
if a threshold was missed: a case of ours crashes, hangs or does not run, or one fails without a line in reasons.txt that
explains it (`GLOB | WORDS`). Exits with 2 if the program cannot run.
"""

import argparse
import collections
import fnmatch
import os
import sys
import time

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "d3d9"))
import machine  # noqa: E402
from deqp import ADDED, GOOD, SAID, Run, read_list  # noqa: E402
from report import read_reasons, write_json  # noqa: E402

SIDES = ("triptych", "llvmpipe")
MESA = "/usr/share/glvnd/egl_vendor.d/50_mesa.json"
# The beginning of a suite's names, the strings of its driver, words in that of llvmpipe, and options of the program.
Suite = collections.namedtuple("Suite", "prefix strings mesa options")
SUITES = {
    "gles2": Suite(
        "dEQP-GLES2.", ("vendor", "renderer", "version"), ("renderer", "llvmpipe"), ("--deqp-surface-type=pbuffer",)
    ),
    "egl": Suite("dEQP-EGL.", ("vendor", "version"), ("vendor", "Mesa"), ()),
}


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("--suite", choices=SUITES, default="gles2")
    parser.add_argument("--deqp", required=True, help="a folder with bin/deqp-SUITE and lists/SUITE.txt")
    parser.add_argument("--triptych", required=True, help="the command triptych")
    parser.add_argument("--engine", default="specialize")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--limit", type=float, default=300, help="seconds of one case")
    parser.add_argument("--every", type=int, default=1, help="every n-th case only")
    parser.add_argument("--sides", default=",".join(SIDES))
    parser.add_argument("--results", default="results")
    parser.add_argument("--work", required=True, help="the folder of the files with single cases")
    parser.add_argument("globs", nargs="*", help="names of cases without dEQP-GLES2. or dEQP-EGL.")
    return parser.parse_args()


def refuse(text):
    print("conformance-gles: " + text, file=sys.stderr)
    return 2


def program_of(options):
    return os.path.join(options.deqp, "bin", "deqp-" + options.suite)


def list_of(options):
    return os.path.join(options.deqp, "lists", options.suite + ".txt")


def what_is_missing(options):
    """A sentence, or None if the folder has what is needed."""
    for path, executable in ((program_of(options), True), (list_of(options), False)):
        if not os.path.isfile(path) or (executable and not os.access(path, os.X_OK)):
            return f"{path}: not found, expected {'the program' if executable else 'the list of cases'}"
    return None


def selected(options):
    cases = read_list(list_of(options))
    if options.globs:
        wanted = [SUITES[options.suite].prefix + glob for glob in options.globs]
        cases = [case for case in cases if any(fnmatch.fnmatchcase(case, glob) for glob in wanted)]
    return cases[:: options.every]


def runs(options):
    """The command and the environment of each side."""
    program, suite = os.path.abspath(program_of(options)), SUITES[options.suite]
    threads = str(options.threads)
    ours = [os.path.abspath(options.triptych), "run", "--gl", "--engine", options.engine, "--threads", threads, program]
    mesas = {
        "__EGL_VENDOR_LIBRARY_FILENAMES": MESA,
        "LIBGL_ALWAYS_SOFTWARE": "1",
        "GALLIUM_DRIVER": "llvmpipe",
        "LP_NUM_THREADS": threads,
    }
    both = {"triptych": (ours, {}), "llvmpipe": ([program], mesas)}
    sides = [side for side in options.sides.split(",") if side == "triptych" or os.path.exists(MESA)]
    return {
        side: Run(both[side][0], {"EGL_PLATFORM": "surfaceless", **both[side][1]}, options.limit, suite) for side in sides
    }


def group_of(case):
    """dEQP-GLES2.functional.fbo.api.valid_objects is in functional.fbo."""
    words = case.split(".")[1:]
    return ".".join(words[: 2 if words[0] == "functional" else 1])


def counts(results):
    found = collections.Counter(result.status for result in results)
    return {status: found[status] for status in (*SAID, *ADDED) if found[status]}


def reason_of(case, known):
    return next((words for glob, words in known.items() if fnmatch.fnmatchcase(case.removeprefix("dEQP-"), glob)), None)


def failures(run, known):
    bad = [(case, result) for case, result in run.results.items() if result.status not in GOOD]
    return [{"case": case, **result._asdict(), "reason": reason_of(case, known)} for case, result in bad]


def write_cases(path, run):
    with open(path, "w", encoding="utf-8") as file:
        for case, result in run.results.items():
            file.write("\t".join([case, result.status, result.message.replace("\t", " ")]) + "\n")


def run_side(side, run, cases, options):
    """Runs the cases. Returns what the report has of the side, or None if the program cannot run."""
    driver, begin = run.driver(), time.monotonic()
    name = f"{options.suite}, {side}"
    if not run.all(cases, lambda done: print(f"{name}: {done:,} of {len(cases):,} cases", flush=True)):
        return None
    write_cases(os.path.join(options.work, f"{options.suite}-{side}.tsv"), run)
    seconds = time.monotonic() - begin
    print(f"{name}: {driver['vendor']}, {driver['version']}: {counts(run.results.values())}, {seconds:.0f} s", flush=True)
    return {"driver": driver, "seconds": round(seconds, 1), "counts": counts(run.results.values()), "outside": run.outside}


def groups(cases, sides):
    """Counts of each group, in the order of the list."""
    members = collections.defaultdict(list)
    for case in cases:
        members[group_of(case)].append(case)
    return [
        {"group": group, "cases": len(names)}
        | {side: counts(run.results[case] for case in names) for side, run in sides.items()}
        for group, names in members.items()
    ]


def strangers(sides, suite):
    """A sentence for each side where another implementation answered."""
    expected = {"triptych": ("vendor", "Triptych"), "llvmpipe": SUITES[suite].mesa}
    for side, each in sides.items():
        field, words = expected[side]
        if words not in each["driver"][field]:
            yield f"the {field} that answers is '{each['driver'][field]}', expected {words}"


def violations(run, bad):
    """The thresholds that Triptych misses, as sentences."""
    found = [f"the program ended with {end} outside of its cases" for end in run.outside]
    for each in bad:
        if each["status"] in ADDED or not each["reason"]:
            found.append(f"{each['case']}: {each['status']} ({each['message']})")
    return found


def report(options, cases):
    sides, document = runs(options), {}
    known = read_reasons(os.path.join(HERE, "reasons.txt"))
    for side, run in sides.items():
        document[side] = run_side(side, run, cases, options)
        if not document[side]:
            return None
    bad = {side: failures(run, known) for side, run in sides.items()}
    ours = sides.get("triptych")
    return {
        "suite": options.suite,
        "machine": machine.machine(),
        "engine": machine.engine(options.triptych, options.engine),
        "threads": options.threads,
        "renderers": machine.renderers("libgl1-mesa-dri", "libegl-mesa0"),
        "command": "make conformance-gles",
        "cases": len(cases),
        "missed": [*strangers(document, options.suite), *(violations(ours, bad["triptych"]) if ours else [])],
        "sides": document,
        "groups": groups(cases, sides),
        "failures": bad,
    }


def main():
    options = arguments()
    if missing := what_is_missing(options):
        return refuse(missing)
    cases = selected(options)
    if not cases:
        return refuse(f"no case of {list_of(options)} has a name like {' '.join(options.globs)}")
    os.makedirs(options.work, exist_ok=True)
    document = report(options, cases)
    if not document:
        return refuse(f"{program_of(options)} begins no case, expected one that the EGL of {MESA} can run")
    write_json(options.results, f"conformance-{options.suite}.json", document)
    for each in document["missed"]:
        print("MISSED " + each)
    return 1 if document["missed"] else 0


sys.exit(main())
