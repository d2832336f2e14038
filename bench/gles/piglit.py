"""Runs piglit's tests of the OpenGL ES Shading Language 1.00 on Triptych and on Mesa's llvmpipe, and compares them.

    python3 bench/gles/piglit.py --triptych COMMAND --results FOLDER [--piglit FOLDER] [--sides LIST]

FOLDER is that of Debian's package piglit. Its shaders (*.vert, *.frag) of version 1.00 are compiled, and its programs
(*.shader_test) that require no more than OpenGL ES 2 are linked, drawn and probed. Writes conformance-piglit.json. Exits
with 1 if a test fails on Triptych without a line in reasons.txt, crashes or hangs, and with 2 without the package.
"""

import argparse
import collections
import os
import re
import subprocess
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "d3d9"))
import fnmatch  # noqa: E402
import machine  # noqa: E402
from report import read_reasons, write_json  # noqa: E402

SIDES = ("triptych", "llvmpipe")
LIMIT = 60  # seconds of one test
CONFIG = re.compile(r"\[config\](.*?)\[end config\]", re.S)
REQUIRED = re.compile(r"\[require\](.*?)(?:\n\[|\Z)", re.S)
SAID = re.compile(r'PIGLIT: \{"result": "(\w+)"')
FINE = ("pass", "skip")


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("--triptych", required=True, help="the command triptych")
    parser.add_argument("--engine", default="specialize")
    parser.add_argument("--piglit", default="/usr/lib/x86_64-linux-gnu/piglit")
    parser.add_argument("--sides", default=",".join(SIDES))
    parser.add_argument("--results", default="results")
    return parser.parse_args()


def compiled(folder, path, text):
    """The command that compiles a shader of version 1.00, or None."""
    config = CONFIG.search(text)
    fields = dict(re.findall(r"(\w+):[ \t]*([^\n]*)", config[1])) if config else {}
    if fields.get("glsl_version", "").strip() != "1.00":
        return None
    program = os.path.join(folder, "bin", "glslparsertest_gles2")
    return [program, path, fields["expect_result"].strip(), "1.00", *fields.get("require_extensions", "").split()]


def drawn(folder, path, text):
    """The command that runs a program of OpenGL ES 2, or None."""
    required = REQUIRED.search(text)
    versions = re.findall(r"^(?:GL|GLSL) ES >= ([\d.]+)", required[1] if required else "", re.M)
    if not versions or max(map(float, versions)) > 2:
        return None
    return [os.path.join(folder, "bin", "shader_runner_gles2"), path, "-auto", "-fbo"]


def tests(folder):
    """The command of each test, by the test's name."""
    kinds, found = {".vert": compiled, ".frag": compiled, ".shader_test": drawn}, {}
    for top in ("tests", "generated_tests"):
        for place, _, names in os.walk(os.path.join(folder, top)):
            for path in (os.path.join(place, name) for name in names):
                kind = kinds.get(os.path.splitext(path)[1])
                if kind:
                    with open(path, encoding="utf-8", errors="replace") as file:
                        command = kind(folder, path, file.read())
                    if command:
                        found[os.path.relpath(path, folder)] = command
    return dict(sorted(found.items()))


def run(options, side, command):
    """The result of a test, and what it printed last."""
    variables = {**os.environ, "PIGLIT_PLATFORM": "surfaceless_egl", "PIGLIT_SOURCE_DIR": options.piglit}
    if side == "triptych":
        command = [os.path.abspath(options.triptych), "run", "--gl", "--engine", options.engine, *command]
    else:
        variables |= {"LIBGL_ALWAYS_SOFTWARE": "1", "GALLIUM_DRIVER": "llvmpipe"}
    try:
        done = subprocess.run(
            command, env=variables, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace",
            timeout=LIMIT, check=False,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return "hang", f"no end after {LIMIT} s"
    said = SAID.search(done.stdout)
    return said[1] if said else "crash", (done.stderr or done.stdout).strip()[-400:]


def group_of(name):
    """tests/spec/glsl-es-1.00/compiler/x.frag is in spec/glsl-es-1.00."""
    return "/".join(name.split("/")[1:3])


def counts(results):
    return dict(collections.Counter(result for result, _ in results))


def groups(names, results):
    members = collections.defaultdict(list)
    for name in names:
        members[group_of(name)].append(name)
    return [
        {"group": group, "tests": len(each)} | {side: counts(found[name] for name in each) for side, found in results.items()}
        for group, each in members.items()
    ]


def failures(results, known):
    return [
        {
            "test": name,
            "result": result,
            "said": said,
            "reason": next((words for glob, words in known.items() if fnmatch.fnmatchcase("piglit." + name, glob)), None),
        }
        for name, (result, said) in results.items()
        if result not in FINE
    ]


def main():
    options = arguments()
    commands = tests(options.piglit)
    if not commands:
        print(f"conformance-piglit: {options.piglit} has no tests, expected Debian's package piglit", file=sys.stderr)
        return 2
    results = {}
    for side in options.sides.split(","):
        results[side] = {name: run(options, side, command) for name, command in commands.items()}
        print(f"{side}: {counts(results[side].values())}", flush=True)
    known = read_reasons(os.path.join(HERE, "reasons.txt"))
    bad = {side: failures(found, known) for side, found in results.items()}
    missed = [f"{each['test']}: {each['result']}: {each['said']}" for each in bad.get("triptych", ()) if not each["reason"]]
    document = {
        "machine": machine.machine(),
        "engine": machine.engine(options.triptych, options.engine),
        "renderers": machine.renderers("piglit", "libgl1-mesa-dri", "libegl-mesa0"),
        "command": "make conformance-piglit",
        "tests": len(commands),
        "missed": missed,
        "sides": {side: counts(found.values()) for side, found in results.items()},
        "groups": groups(commands, results),
        "failures": bad,
    }
    write_json(options.results, "conformance-piglit.json", document)
    for each in missed:
        print("MISSED " + each)
    return 1 if missed else 0


sys.exit(main())
