"""Where the instructions of a frame go: programs of OpenGL ES on Triptych, counted by class with callgrind.

    python3 bench/gles/profile.py --folder FOLDER --triptych COMMAND --results FOLDER [--mesa FOLDER] [PROGRAM...]

As bench/gles/programs.py, whose programs these are: scenes of glmark2 off-screen, all others in a window. One thread
draws. frames.so ends each frame with a call of frames_ended, at which callgrind writes a file. Counts do not depend on
other work of the machine. They are not times: an instruction that waits for memory counts as any other.

A function of Triptych belongs to the class of its folder, the table CLASSES. What it calls in other libraries, such as
memcpy, counts for its class. Generated code counts by its caller: CALLERS. The rest of a frame is the program's own.
Writes profile-gles.json; exits with 1 if a program fails. llvmpipe is counted as a whole.
"""

import collections
import concurrent.futures
import glob
import os
import re
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "d3d9"))
import machine  # noqa: E402
from programs import PACKAGES, Player, arguments, newest, programs  # noqa: E402
from report import write_json  # noqa: E402

LIMIT = 1800  # seconds of one run
FRAMES, COUNTED = 7, 4  # frames of a run; the last ones, whose mean is reported
LIBRARY = "libEGL_triptych.so"
HOTTEST = 12  # functions that the report has of each program
GENERATED = "???"  # the object of code that is in no file

# The first prefix of a file that fits.
CLASSES = (
    ("src/front/egl/", "present"),
    ("src/front/glsl/", "builds"),
    ("build/front/", "builds"),
    ("src/front/", "front end"),
    ("src/api/", "front end"),
    ("src/capture/", "front end"),
    ("src/ir/", "builds"),
    ("src/spec/", "builds"),
    ("src/engines/", "builds"),
    ("src/shader/", "builds"),
    ("src/render/texture/", "textures"),
    ("src/render/blit/", "textures"),
    ("src/render/geometry/", "bins"),
    ("src/render/raster/", "rasterizer"),
    ("src/render/tile/", "rasterizer"),
    ("asm/raster/", "rasterizer"),
    ("src/render/target/", "targets"),
    ("src/", "draws"),
)
CALLERS = {
    "batch_primitives": "vertex routines",
    "set_up_group": "setup routines",
    "run_pixels": "pixel routines",
}
PROGRAM = "program"
NAMES = (
    "program", "front end", "draws", "builds", "textures", "vertex routines", "setup routines", "bins", "rasterizer",
    "pixel routines", "targets", "present",
)  # fmt: skip


def class_of(files):
    """The class of a function, by the source file that most of its instructions come from."""
    known = [(count, each) for each, count in files.items() if each.endswith((".c", ".asm"))]
    path = max(known or [(count, each) for each, count in files.items()])[1]
    return next((name for prefix, name in CLASSES if path.startswith(prefix)), "draws")


class Function:
    def __init__(self, name, is_ours):
        self.name, self.is_ours = name, is_ours
        self.files = collections.Counter()
        self.own = 0  # instructions
        self.outside = collections.Counter()  # of calls into other objects; key: is the code generated?


def source(path):
    """The path of a source below the project's folder."""
    found = re.search(r"/((?:src|asm|build/front)/.*)", path)
    return found[1] if found else path


class Reader:
    """A file of callgrind: the functions of LIBRARY, and the sum of all instructions."""

    def __init__(self, path):
        self.names = {"ob": {}, "fl": {}, "fn": {}}  # by their numbers in the file
        self.now = {"ob": "", "fl": "", "fn": "", "cob": ""}
        self.functions, self.total = {}, 0
        self.line_file, self.calls = "", False
        with open(path, encoding="utf-8", errors="replace") as file:
            for line in file:
                self.read(line.rstrip())

    def name(self, kind, text):
        """A name is written as `(number) name` once, and then as `(number)`."""
        found = re.fullmatch(r"\((\d+)\)(?: (.*))?", text)
        if not found:
            return text
        if found[2]:
            self.names[kind][found[1]] = found[2]
        return self.names[kind].get(found[1], "")

    def function(self):
        key = (self.now["ob"], self.now["fn"])
        if key not in self.functions:
            self.functions[key] = Function(self.now["fn"], LIBRARY in self.now["ob"])
        return self.functions[key]

    def read(self, line):
        key, _, value = line.partition("=")
        if key == "ob":
            self.now["ob"] = self.name("ob", value)
        elif key in ("fl", "fi", "fe"):
            self.line_file = self.name("fl", value)
        elif key == "fn":
            self.now["fn"], self.now["cob"] = self.name("fn", value), self.now["ob"]
        elif key == "cob":
            self.now["cob"] = self.name("ob", value)
        elif key in ("cfi", "cfl"):
            self.name("fl", value)
        elif key == "cfn":
            self.name("fn", value)
        elif key == "calls":
            self.calls = True
        elif line.startswith("summary:"):
            self.total = int(line.split()[1])
        elif line and (line[0].isdigit() or line[0] in "+-*"):
            self.cost(int(line.split()[1]))

    def cost(self, count):
        function = self.function()
        if not self.calls:
            function.own += count
            function.files[source(self.line_file)] += count
        elif LIBRARY not in self.now["cob"]:
            function.outside[self.now["cob"] == GENERATED] += count
        self.calls, self.now["cob"] = False, self.now["ob"]


def classes(path):
    """Instructions by class and by (class, function), in one file of callgrind."""
    reader, found, functions = Reader(path), collections.Counter(), collections.Counter()
    for each in reader.functions.values():
        if each.is_ours and each.files:
            name = class_of(each.files)
            found[name] += each.own + each.outside[False]
            functions[name, each.name] += each.own + each.outside[False]
            found[CALLERS.get(each.name, name)] += each.outside[True]
    found[PROGRAM] = reader.total - sum(found.values())
    return found, functions


def count(player, program, side):
    """The files of the last frames, from the process that drew them."""
    name = f"callgrind.{program.name}-{side}"
    for path in glob.glob(player.path(name + ".*")):
        os.remove(path)
    variables = {**os.environ, **program.environment, "FRAMES_COUNT": str(FRAMES)}
    command, needed = player.launch(side, 1, program.command, ["env", "LD_PRELOAD=" + player.path("frames.so")])
    options = ["--tool=callgrind", "--trace-children=yes", "--dump-before=frames_ended"]
    options.append("--callgrind-out-file=" + player.path(name + ".%p"))
    try:
        done = subprocess.run(
            ["valgrind", *options, *command], env=variables | needed, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", timeout=LIMIT, check=False,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return None
    files = glob.glob(player.path(f"{name}.*.{FRAMES}"))
    if len(files) != 1 or done.returncode:
        print(f"{program.name}, {side}: exit status {done.returncode}", *done.stdout.splitlines()[-3:], sep="\n")
        return None
    return [files[0].rsplit(".", 1)[0] + f".{frame}" for frame in range(FRAMES - COUNTED + 1, FRAMES + 1)]


def profile(player, program, sides):
    """Instructions of a frame: of each class on Triptych, and all on llvmpipe."""
    program = program.off_screen() or program
    report = {"program": program.name, "off_screen": "--off-screen" in program.command}
    for side in sides:
        files = [] if side in program.without else count(player, program, side)
        if files is None:
            return None
        if files and side == "triptych":
            found, functions = (sum(each, collections.Counter()) for each in zip(*map(classes, files)))
            report["classes"] = {name: found[name] // COUNTED for name in NAMES}
            report["functions"] = [
                {"class": name, "function": function, "instructions": count // COUNTED}
                for (name, function), count in functions.most_common(HOTTEST)
            ]
        if files:
            report[side] = sum(Reader(each).total for each in files) // COUNTED
    print(report, flush=True)
    return report


def main():
    options = arguments()
    player = Player(options)
    sides = [side for side in options.sides.split(",") if side != "llvmpipe-newest" or options.mesa]
    known = {each.name: each for each in programs(player.folder)}
    if unknown := [name for name in options.names if name not in known]:
        print(f"profile: {' '.join(unknown)}: expected some of {' '.join(known)}", file=sys.stderr)
        return 2
    names = options.names or list(known)
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        reports = dict(zip(names, pool.map(lambda name: profile(player, known[name], sides), names)))
    document = {
        "machine": machine.machine(),
        "engine": machine.engine(options.triptych, options.engine),
        "renderers": machine.renderers(*PACKAGES, "valgrind") | newest(player),
        "command": "make profile-gles",
        "frames": [FRAMES - COUNTED + 1, FRAMES],
        "programs": [each for each in reports.values() if each],
    }
    write_json(options.results, "profile-gles.json", document)
    for name in (failed := [name for name, each in reports.items() if not each]):
        print(f"PROBLEM {name}: not counted")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
