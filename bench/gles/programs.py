"""Programs of OpenGL ES on Triptych and on Mesa's llvmpipe: pictures compared, frames per second, recordings.

    python3 bench/gles/programs.py --folder FOLDER --triptych COMMAND --results FOLDER [--mesa FOLDER] [PROGRAM...]

DISPLAY is a display of X11. FOLDER has frames.so, fixed and compile (bench/gles/*.c). Writes programs-gles.json. Exits
with 1 if a program fails, a picture differs, or a recording differs between engines. A slower program is no failure:
the times are in the report. Also writes programs-gles.png, pictures of some programs.
"""

import argparse
import os
import re
import statistics
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "d3d9"))
import machine  # noqa: E402
from compilation import compilation  # noqa: E402
from player import FRAMES, difference, load  # noqa: E402
from report import write_json  # noqa: E402
from sheet import sheet  # noqa: E402

# llvmpipe is that of this system's Mesa, llvmpipe-newest that of bench/mesa.sh.
SIDES = ("triptych", "llvmpipe", "llvmpipe-newest")
# As in bench/d3d9/programs.py: this share of the pixels differs by more than 16 of 255, the mean of the largest ones.
FAR_PERCENT, MEAN = 1.0, 2.0
# Scenes with a reason to differ more, and their limits: docs/opengles.md, "Programs".
WIDER = {"refract": (10.0, 6.0), "terrain": (FAR_PERCENT, 3.0)}
PROCESSOR = re.compile(r" cpu ([\d.]+)")
THREADS = (1, 2)
SHEET = ("weston", "quick", "fixed", "gears")  # the programs whose pictures docs/opengles.md shows
PICTURE, RECORDED = 20, 6  # the frame that is compared; the frames that are recorded
LIMIT = 300  # seconds of one run
PACKAGES = (
    "libgl1-mesa-dri", "libegl-mesa0", "glmark2-es2-x11", "mesa-utils-bin", "libsdl2-tests", "libqt5quick5-gles", "weston",
)  # fmt: skip
SDL_TESTS = "/usr/libexec/installed-tests/SDL2"

# llvmpipe computes mediump with half floats, Triptych with binary32; OpenGL ES allows both. Iterated noise
# then differs, so these scenes declare highp, with which both compute in binary32.
HIGH = ":fragment-precision=default,high,default,default"

SCENES = {
    "build": ("build", "a lit model, indices and vertices in buffers"),
    "texture": ("texture:texture-filter=mipmap", "a cube with mipmaps"),
    "shading": ("shading:shading=phong", "a model, lit for each pixel"),
    "bump": ("bump:bump-render=height", "normals from the heights of a texture"),
    "effect2d": ("effect2d:kernel=1,1,1,1,1;1,1,1,1,1;1,1,1,1,1;", "a filter of 15 texels"),
    "pulsar": ("pulsar:quads=5:texture=true:light=false", "blended quads with textures"),
    "desktop-blur": ("desktop:effect=blur:windows=4", "windows over a blurred picture, framebuffer objects"),
    "desktop-shadow": ("desktop:effect=shadow:windows=4", "windows with shadows"),
    "buffer-map": ("buffer:update-method=map:columns=50", "vertices written in mapped buffers"),
    "buffer-subdata": ("buffer:update-method=subdata:columns=50", "vertices written by glBufferSubData"),
    "ideas": ("ideas:speed=duration", "the logo, a camera's flight, shadows by stencil"),
    "jellyfish": ("jellyfish", "a mesh that its vertex shader moves"),
    "terrain": ("terrain" + HIGH, "a height map read by the vertex shader, noise, bloom"),
    "shadow": ("shadow", "a shadow map"),
    "refract": ("refract" + HIGH, "refraction by the depth of two sides"),
    "conditionals": ("conditionals:fragment-steps=5:vertex-steps=5" + HIGH, "branches in both shaders"),
    "function": ("function:fragment-complexity=medium:fragment-steps=5" + HIGH, "calls of functions"),
    "loop": ("loop:fragment-loop=true:fragment-steps=5:vertex-steps=5" + HIGH, "loops in both shaders"),
}


class Program:
    """A command, its variables, and the frames that are measured. If it draws by the time, its pictures are taken and
    not compared. Sides of `without` cannot run it."""

    def __init__(self, name, command, description, frames=60, environment=None, timed=False, without=()):
        self.name = name
        self.command = command
        self.description = description
        self.frames = frames
        self.environment = environment or {}
        self.timed = timed
        self.without = without

    def off_screen(self):
        """The same, drawn to a framebuffer object; null if the program cannot do that."""
        if self.command[0] != "glmark2-es2":
            return None
        return Program(self.name, [*self.command, "--off-screen"], "", self.frames, {"FRAMES_FINISH": "1"})


def scene(name):
    settings, description = SCENES[name]
    command = ["glmark2-es2", "--size", "800x600", "--benchmark", f"{settings}:nframes=1000000"]
    return Program(name, command, "glmark2: " + description)


def own(folder):
    """Programs with files of this folder."""
    here = os.path.dirname(os.path.abspath(__file__))
    fixed = Program(
        "fixed",
        [os.path.join(folder, "fixed")],
        "OpenGL ES 1.1 (bench/gles/fixed.c): lights, fog, two textures, a clip plane, point sprites",
        without=("llvmpipe-newest",),  # Debian 13 builds Mesa without OpenGL ES 1
    )
    quick = Program(
        "quick",
        ["/usr/lib/qt5/bin/qmlscene", os.path.join(here, "quick.qml")],
        "qmlscene of Qt 5: Qt Quick, blended shapes and a layer",
        environment={"FRAMES_CLOCK": "system", "QT_QPA_PLATFORM": "xcb", "QSG_RENDER_LOOP": "basic"},
    )
    backend = ["--backend=x11-backend.so", "--width=640", "--height=480", "--socket=triptych"]
    weston = Program(
        "weston",
        ["weston", *backend, "--config=" + os.path.join(here, "weston.ini"), "--log=" + os.path.join(folder, "weston.log")],
        "weston, a compositor of Wayland, with a client that draws into shared memory",
        environment={"FRAMES_CLOCK": "system", "XDG_RUNTIME_DIR": folder},
        timed=True,
    )
    return [fixed, quick, weston]


def programs(folder):
    gears = Program("gears", ["es2gears_x11.x86_64-linux-gnu"], "es2gears of Mesa: three lit gears")
    cube = Program(
        "cube",
        [os.path.join(SDL_TESTS, "testgles2")],
        "testgles2 of SDL: a cube with colours",
        environment={"SDL_OPENGL_ES_DRIVER": "1", "SDL_VIDEODRIVER": "x11"},
    )
    return [gears, cube, *own(folder), *map(scene, SCENES)]


def others(programs):
    """Those that are no scenes of glmark2."""
    return [each for each in programs if each.command[0] != "glmark2-es2"]


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("--folder", required=True)
    parser.add_argument("--triptych", required=True)
    parser.add_argument("--engine", default="specialize")
    parser.add_argument("--passes", type=int, default=3)
    parser.add_argument("--results", default="results")
    parser.add_argument("--sides", default=",".join(SIDES), help="only one, to try a program")
    parser.add_argument("--mesa", help="the folder of bench/mesa.sh, for the side llvmpipe-newest")
    parser.add_argument("names", nargs="*")
    return parser.parse_args()


class Player:
    def __init__(self, options):
        self.folder = os.path.abspath(options.folder)
        self.triptych = os.path.abspath(options.triptych)
        self.engine = options.engine
        self.mesa = options.mesa and os.path.abspath(options.mesa)

    def launch(self, side, threads, command, preload=()):
        """The command and the variables that start a program on a side; preload sets a variable of the program."""
        if side == "triptych":
            options = ["run", "--gl", "--engine", self.engine, "--threads", str(threads)]
            return [self.triptych, *options, *preload, *command], {}
        # llvmpipe draws on the calling thread if it has no threads of its own.
        variables = {"LIBGL_ALWAYS_SOFTWARE": "1", "LP_NUM_THREADS": str(threads if threads > 1 else 0)}
        loader = [os.path.join(self.mesa, "run")] if side == "llvmpipe-newest" else []
        return [*preload, *loader, *command], variables

    def path(self, name):
        return os.path.join(self.folder, name)

    def run(self, program, side, threads, frames, picture=None, **settings):
        """Runs the frames. Returns their times in milliseconds, and the last lines that the program wrote."""
        variables = {**os.environ, **program.environment, **settings, "FRAMES_COUNT": str(frames)}
        variables |= {"FRAMES_PICTURE": picture} if picture else {}
        preload = ["env", "LD_PRELOAD=" + self.path("frames.so")]
        command, needed = self.launch(side, threads, program.command, preload)
        variables |= needed
        cores = sorted(os.sched_getaffinity(0))[:threads]
        try:
            done = subprocess.run(
                ["taskset", "-c", ",".join(map(str, cores)), *command],
                env=variables, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                text=True, errors="replace", timeout=LIMIT, check=False,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return None, [f"no end after {LIMIT} s"]
        lines = done.stdout.splitlines()
        found = [match for match in map(FRAMES.search, lines) if match]
        if not found or done.returncode:
            return None, [f"exit status {done.returncode}", *lines[-3:]]
        count, start, first, longest, total = map(float, found[-1].groups())
        processor = float(PROCESSOR.search(found[-1].string)[1])
        return {
            "fps": 1000 * (count - 1) / total,
            "processor_ms": processor / (count - 1),
            "first_ms": start,
            "longest_ms": longest,
        }, lines


def compare_pictures(player, program, sides):
    paths = {side: player.path(f"{program.name}-{side}.ppm") for side in sides}
    report = {"shown": {}}
    for side, path in paths.items():
        if os.path.exists(path):
            os.remove(path)
        times, lines = player.run(program, side, max(THREADS), PICTURE, path)
        report["shown"][side] = bool(times) and os.path.exists(path)
        if not report["shown"][side]:
            report["said"] = lines
    if report["shown"].get("triptych") and not program.timed:
        for side in sides:
            if side != "triptych" and report["shown"][side]:
                found = agreement(program, paths["triptych"], paths[side])
                report |= found if side == "llvmpipe" else {side: found}
    return report


def agreement(program, ours, theirs):
    found = difference(ours, theirs)
    far, mean = WIDER.get(program.name, (FAR_PERCENT, MEAN))
    return found | {"agrees": found["far_percent"] <= far and found["mean"] <= mean}


def measure(player, program, sides, passes):
    """Medians by side and number of threads. The sides take turns."""
    report = []
    for threads in THREADS:
        runs = {side: [] for side in sides}
        for _ in range(passes):
            for side in sides:
                runs[side].append(player.run(program, side, threads, program.frames)[0])
        report.append({"threads": threads, **{side: medians(runs[side]) for side in sides}})
    return report


def medians(runs):
    if not runs or None in runs:
        return None
    result = {name: statistics.median(run[name] for run in runs) for name in runs[0]}
    result["runs_fps"] = [run["fps"] for run in runs]
    return result


def recording(player, program):
    """Records the first frames, and verifies them on every engine."""
    path = player.path(program.name + ".trib")
    if os.path.exists(path):
        os.remove(path)
    player.run(program, "triptych", 1, RECORDED, TRIPTYCH_RECORD=path)
    if not os.path.exists(path):
        return None
    command = [player.triptych, "verify", "--frames", str(RECORDED), "--json", path + ".verify.json", path]
    verified = subprocess.run(command, capture_output=True, text=True, check=False)
    return {
        "file": os.path.basename(path),
        "bytes": os.path.getsize(path),
        "verified": verified.returncode == 0,
        "verify": (verified.stdout + verified.stderr).strip().splitlines()[-1:],
    }


def counters(player, program):
    """The front end's statistics of one run."""
    path = player.path(program.name + "-statistics.json")
    if os.path.exists(path):
        os.remove(path)
    player.run(program, "triptych", 1, program.frames, TRIPTYCH_STATISTICS=path)
    return load(path)


def run(player, program, options):
    sides = [side for side in options.sides.split(",") if side not in program.without]
    report = {"program": program.name, "description": program.description}
    report["picture"] = compare_pictures(player, program, sides)
    print(f"{program.name}: picture {report['picture']}", flush=True)
    if "triptych" in sides:
        report["recording"] = recording(player, program)
        report["statistics"] = counters(player, program)
        print(f"{program.name}: recording {report['recording']}", flush=True)
    report["speed"] = measure(player, program, sides, options.passes) if options.passes else []
    off_screen = program.off_screen() if options.passes else None
    report["off_screen"] = measure(player, off_screen, sides, options.passes) if off_screen else []
    print(f"{program.name}: speed {report['speed']} {report['off_screen']}", flush=True)
    return report


def validation(player):
    """glmark2's own check of its pictures, off-screen: how many scenes it finds right, wrong, or has no picture of."""
    done = subprocess.run(
        [player.triptych, "run", "--gl", "--engine", player.engine, "glmark2-es2", "--off-screen", "--validate"],
        capture_output=True, text=True, timeout=LIMIT, check=False,
    )  # fmt: skip
    return {word: done.stdout.count("Validation: " + word) for word in ("Success", "Failure", "Unknown")}


def scores(reports):
    """glmark2's score, the mean of the scenes' frames per second off-screen, by side and number of threads."""
    result = []
    for i, threads in enumerate(THREADS):
        rows = [report["off_screen"][i] for report in reports if report["off_screen"]]
        sides = [side for side in SIDES if rows and side in rows[0]]
        known = [row for row in rows if all(row[side] for side in sides)]
        if known and len(sides) > 1:
            means = {side: statistics.mean(row[side]["fps"] for row in known) for side in sides}
            result.append({"threads": threads, "scenes": len(known), **means})
    return result


def problems(report):
    name, picture, found = report["program"], report["picture"], []
    for side, shown in picture["shown"].items():
        if not shown:
            found.append(f"{name}: no picture on {side}: {' / '.join(picture['said'])}")
    for each in (picture, picture.get("llvmpipe-newest", {})):
        if not each.get("agrees", True):
            found.append(f"{name}: the pictures differ, {picture}")
    for row in report["speed"] + report["off_screen"]:
        found += [f"{name}: no times on {side}" for side in SIDES if side in row and not row[side]]
    if "recording" in report and not (report["recording"] or {}).get("verified"):
        found.append(f"{name}: the recording is missing or differs between engines: {report['recording']}")
    return found


def newest(player):
    """The versions of the newest Mesa and of its LLVM."""
    if not player.mesa:
        return {}
    with open(os.path.join(player.mesa, "version"), encoding="utf-8") as file:
        return {"llvmpipe-newest": file.read().strip()}


def main():
    options = arguments()
    if not options.mesa:
        options.sides = ",".join(side for side in options.sides.split(",") if side != "llvmpipe-newest")
    player = Player(options)
    known = {each.name: each for each in programs(player.folder)}
    if unknown := [name for name in options.names if name not in known]:
        print(f"programs: {' '.join(unknown)}: expected some of {' '.join(known)}", file=sys.stderr)
        return 2
    reports = [run(player, known[name], options) for name in options.names or known]
    valid = validation(player)
    document = {
        "machine": machine.machine(),
        "engine": machine.engine(options.triptych, options.engine),
        "renderers": machine.renderers(*PACKAGES) | newest(player),
        "command": "make programs-gles",
        "passes": options.passes,
        "allowed": {"far_percent": FAR_PERCENT, "mean": MEAN},
        "validation": valid,
        "scores": scores(reports),
        "compilation": compilation(player, options.sides.split(","), others(known.values())),
        "programs": reports,
        "problems": [each for report in reports for each in problems(report)],
    }
    if valid["Failure"] or not valid["Success"]:
        document["problems"].append(f"glmark2 --validate: {valid}")
    write_json(options.results, "programs-gles.json", document)
    pictures = [player.path(f"{name}-triptych.ppm") for name in SHEET]
    if all(map(os.path.exists, pictures)):
        sheet(os.path.join(options.results, "programs-gles.png"), pictures)
    for each in document["problems"]:
        print("PROBLEM " + each)
    return 1 if document["problems"] else 0


if __name__ == "__main__":
    sys.exit(main())
