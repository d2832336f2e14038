"""Programs for Windows on Triptych and on Wine's own Direct3D 9: pictures compared, frames per second, caches.

    python3 bench/d3d9/programs.py --folder FOLDER --triptych COMMAND --results FOLDER [PROGRAM...]

The desktop (bench/d3d9/desktop.sh) runs; FOLDER has the programs of bench/d3d9/wheels.sh and irrlicht.sh. Writes
programs.json. Exits with 1 if a program fails, a picture differs, a recording differs between engines, or Triptych is
not ahead.
"""

import argparse
import os
import statistics
import subprocess
import sys

sys.dont_write_bytecode = True
import machine  # noqa: E402
from player import SIDES, Player, Program, difference, load  # noqa: E402
from report import write_json  # noqa: E402

# A picture agrees if at most this share of its pixels differs by more than 16 of 255, and the mean of the largest
# differences is at most MEAN. Edges of triangles and levels of textures differ between renderers.
FAR_PERCENT, MEAN = 1.0, 2.0
THREADS = (1, 2)


def programs(folder):
    panda = os.path.join(os.path.abspath(folder), "panda")
    windows = lambda *path: "Z:" + os.path.join(panda, *path).replace("/", "\\")  # noqa: E731
    path = ";".join(windows(*each) for each in (("panda3d",), ("panda3d_tools",), ("deploy_libs",)))
    drag = "mousemove 400 300 mousedown 1 mousemove_relative 20 10 mousemove_relative 120 60 mouseup 1 mousemove 900 700"
    pview = Program(
        "panda",
        ["panda3d_tools/pview.exe", "-c", "-L", "panda-model.egg.pz"],
        None,
        20,
        {"PANDA_PRC_DIR": windows("configuration"), "WINEPATH": path},
        drag.split(),
    )
    return [
        Program("sdl", ["sdl.exe"], 30, 200),
        pview,
        Program("gles", ["gles.exe"], 30, 200),
        Program("irrlicht", ["irrlicht.exe"], 60, 150),
    ]


DESCRIPTIONS = {
    "sdl": "sprites, geometry, blending and render targets by SDL's renderer `direct3d`",
    "panda": "Panda3D's viewer `pview` with the lit model `panda-model`, turned with the mouse",
    "gles": "GLES2 on ANGLE: lit tori, framebuffer objects, stencil and discarded pixels",
    "irrlicht": "Irrlicht: a map with light maps, animated models with shadow volumes, bump maps, water, particles",
}


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("--folder", required=True)
    parser.add_argument("--triptych", required=True)
    parser.add_argument("--engine", default="specialize")
    parser.add_argument("--passes", type=int, default=3)
    parser.add_argument("--results", default="results")
    parser.add_argument("--sides", default=",".join(SIDES), help="only one, to try a program")
    parser.add_argument("names", nargs="*")
    return parser.parse_args()


def compare_pictures(player, program, sides):
    paths = {side: os.path.join(player.folder, f"{program.name}-{side}.png") for side in sides}
    shown = {side: player.picture(program, side, paths[side]) for side in sides}
    report = {"shown": shown}
    if len(sides) == 2 and all(shown.values()):
        report |= difference(paths["triptych"], paths["wine"])
        report["agrees"] = report["far_percent"] <= FAR_PERCENT and report["mean"] <= MEAN
    return report


def measure(player, program, sides, passes):
    """Medians by side and number of threads. The sides take turns."""
    report = []
    for threads in THREADS:
        runs = {side: [] for side in sides}
        for _ in range(passes):
            for side in sides:
                runs[side].append(player.speed(program, side, threads))
        report.append({"threads": threads, **{side: medians(runs[side]) for side in sides}})
    return report


def medians(runs):
    if not runs or None in runs:
        return None
    result = {name: statistics.median(run[name] for run in runs) for name in runs[0]}
    result["runs_fps"] = [run["fps"] for run in runs]
    return result


def counters(player, program):
    """The front end's statistics of one run."""
    path = os.path.join(player.folder, f"{program.name}-statistics.json")
    if os.path.exists(path):
        os.remove(path)
    player.speed(program, "triptych", 1, statistics_path=path)
    return load(path)


def recording(player, program):
    """Records some frames; verifies them on every engine; measures them."""
    path = os.path.join(player.folder, f"{program.name}.trib")
    if os.path.exists(path):
        os.remove(path)
    player.speed(program, "triptych", 1, record=path, frames=20)
    if not os.path.exists(path):
        return None
    report = {"file": os.path.basename(path), "bytes": os.path.getsize(path)}
    options = ["--frames", "4", "--json", path + ".verify.json"]
    verified = subprocess.run([player.triptych, "verify", *options, path], capture_output=True, text=True, check=False)
    report["verified"] = verified.returncode == 0
    report["verify"] = (verified.stdout + verified.stderr).strip().splitlines()[-1:]
    options = ["--seconds", "3", "--frames", "20", "--json", path + ".bench.json"]
    subprocess.run([player.triptych, "bench", *options, path], capture_output=True, check=False)
    bench = load(path + ".bench.json")
    if bench:
        report["engines"] = bench["streams"][0]["engines"]
        for row in report["engines"]:
            row.pop("samples", None)
    return report


def run(player, program, options):
    sides = options.sides.split(",")
    report = {"program": program.name, "description": DESCRIPTIONS[program.name]}
    report["picture"] = compare_pictures(player, program, sides)
    print(f"{program.name}: picture {report['picture']}", flush=True)
    report["speed"] = measure(player, program, sides, options.passes)
    print(f"{program.name}: speed {report['speed']}", flush=True)
    if "triptych" in sides:
        report["statistics"] = counters(player, program)
        report["recording"] = recording(player, program)
        print(f"{program.name}: {report['statistics']}, recording verified: "
              f"{report['recording'] and report['recording']['verified']}", flush=True)
    return report


def problems(report):
    name, found = report["program"], []
    for side, shown in report["picture"]["shown"].items():
        if not shown:
            found.append(f"{name}: no steady picture on {side}")
    if not report["picture"].get("agrees", True):
        found.append(f"{name}: the pictures differ, {report['picture']}")
    for row in report["speed"]:
        ours, wines = row.get("triptych"), row.get("wine")
        if "triptych" in row and not ours:
            found.append(f"{name}: no times on Triptych, {row['threads']} threads")
        if ours and wines and ours["fps"] <= wines["fps"]:
            found.append(f"{name}: {ours['fps']:.1f} frames per second, Wine's own {wines['fps']:.1f}")
    if "recording" in report and not (report["recording"] or {}).get("verified"):
        found.append(f"{name}: the recording is missing or differs between engines")
    return found


def main():
    options = arguments()
    player = Player(options.folder, options.triptych, options.engine)
    known = programs(options.folder)
    if unknown := set(options.names) - {each.name for each in known}:
        print(f"programs: {' '.join(sorted(unknown))}: expected some of {' '.join(each.name for each in known)}", file=sys.stderr)
        return 2
    chosen = [each for each in known if not options.names or each.name in options.names]
    reports = [run(player, program, options) for program in chosen]
    document = {
        "machine": machine.machine(),
        "engine": machine.engine(options.triptych, options.engine),
        "renderers": machine.renderers(*machine.WINE),
        "command": "make programs-d3d9",
        "passes": options.passes,
        "allowed": {"far_percent": FAR_PERCENT, "mean": MEAN},
        "programs": reports,
        "problems": [each for report in reports for each in problems(report)],
    }
    write_json(options.results, "programs.json", document)
    for each in document["problems"]:
        print("PROBLEM " + each)
    return 1 if document["problems"] else 0


sys.exit(main())
