"""Tables and lines of the pages that are written whole from results/ (see __main__.py)."""

import math

import results
from results import load, only

texts = {}

COMMANDS = {
    "bench": "make bench",
    "baselines": "make bench",
    "builds": "make bench",
    "cold": "make bench",
    "verify": "triptych verify --json",
    "shaders": "make bench-shaders",
    "flow": "make bench-shaders",
    "passes": "make bench-passes",
    "parts": "make bench-passes",
    "peers": "make peers",
    "peers-avx2": "make peers",
    "fuzz": "triptych fuzz",
    "programs": "make programs-d3d9",
    "programs-gles": "make programs-gles",
    "profile-gles": "make profile-gles",
    "conformance-gles2": "make conformance-gles",
    "conformance-egl": "make conformance-gles",
    "conformance-piglit": "make conformance-piglit",
    "claims": "make claims",
    "clients": "make bench-clients",
}


def text(function):
    texts[function.__name__.replace("_", "-")] = function
    return function


def significant(value, digits=3):
    """The value rounded to significant digits, without an exponent."""
    if value == 0:
        return "0"
    rounded = round(value, digits - 1 - math.floor(math.log10(abs(value))))
    places = max(0, digits - 1 - math.floor(math.log10(abs(rounded))))
    return f"{rounded:,.{places}f}"


def markdown(headings, rows, left=1):
    """A table whose first `left` columns are aligned to the left, with a line end before and after it."""
    rule = ["---"] * left + ["---:"] * (len(headings) - left)
    lines = [headings, rule] + rows
    return "\n" + "".join("| " + " | ".join(map(str, line)) + " |\n" for line in lines)


# --- Where a number comes from -----------------------------------------------------------------------------------


def engine_fields(file):
    """The lanes and instruction set of each engine of a file, by engine, in the file's order."""
    found = {}
    report = load(file)
    for each in report.get("streams", []):
        for run in each.get("engines", []):
            if isinstance(run, dict):
                found.setdefault(run["engine"], run)
    if "widest" in report.get("machine", {}):
        return {"specialize": report["machine"]["widest"]}
    if isinstance(report.get("engine"), dict):
        found[report["engine"]["engine"]] = report["engine"]
    if isinstance(report.get("renderers"), dict):
        return found
    for each in report.get("renderers", []) + report.get("builds", []) + report.get("cold", []):
        found.setdefault(each.get("name", each.get("engine")), each)
    return found


def describe_engine(name, fields):
    lanes, instruction_set = fields.get("lanes"), fields.get("instruction_set")
    if not lanes or not instruction_set:
        return f"`{name}`"
    unit = " (vertex/setup/pixel)" if "/" in str(lanes) else ""
    return f"`{name}` {lanes} lanes{unit} {instruction_set}"


@text
def source(file, *engines):
    """Processor, compiler, commit and command of a results file, with the lanes and instruction set of each engine."""
    report = load(file)
    machine = report["campaigns"][-1]["machine"] if file == "fuzz" else report["machine"]
    line = f"{machine['cpu']}, {machine['compiler']}, commit {machine['commit']}"
    known = engine_fields(file)
    named = [describe_engine(name, known[name]) for name in engines or known if name in known]
    named = [each for each in named if " " in each]
    if named:
        line += "; " + ", ".join(named)
    return f"{line}; `{COMMANDS[file]}` writes [results/{file}.json]({link(file)})"


def link(file):
    return f"../results/{file}.json"


@text
def source_here(file, *engines):
    """The same for README.md, which is not in docs/."""
    return source(file, *engines).replace("(../results/", "(results/")


@text
def machine(file, field):
    return str(load(file)["machine"][field])


# --- Streams -----------------------------------------------------------------------------------------------------------


@text
def bench_output(name, *engines):
    """The table that `triptych bench` prints for a stream, as a code block."""
    each = only(load("bench")["streams"], "bench", stream=name)
    columns = [
        ("ms/frame", "frame_ms", 3),
        ("mad", "frame_ms_deviation", 3),
        ("ns/vertex", "vertex_ns", 2),
        ("ns/pixel", "pixel_ns", 2),
        ("routines", "routines", 0),
        ("build us", "build_us", 1),
        ("bytes", "code_bytes", 0),
        ("x frame", "speedup", 2),
    ]
    lines = [["engine", "lanes", "set"] + [heading for heading, _, _ in columns]]
    for engine in engines:
        run = only(each["engines"], name, engine=engine)
        fields = [engine, str(run.get("lanes", "")), run.get("instruction_set", "")]
        lines.append(fields + [f"{run[column]:.{places}f}" for _, column, places in columns])
    widths = [max(len(line[i]) for line in lines) for i in range(len(lines[0]))]
    left = ("engine", "set")
    table = "".join(
        "  ".join(
            cell.ljust(width) if heading in left else cell.rjust(width)
            for cell, width, heading in zip(line, widths, lines[0])
        ).rstrip()
        + "\n"
        for line in lines
    )
    return f"\n```\n{each['stream']}: {each['width']} x {each['height']}, threads: {load('bench')['threads']}\n{table}```\n"


@text
def frames(*arguments):
    """Milliseconds a frame: STREAM... -- ENGINE..., with the geometric mean of all streams over emulate."""
    at = arguments.index("--")
    streams, engines = arguments[:at], arguments[at + 1 :]
    rows = [
        [f"`{name}`"] + [significant(results.stream_row("bench", name, engine)["frame_ms"]) for engine in engines]
        for name in streams
    ]
    count = len(load("bench")["streams"])
    means = [significant(results.stream("bench", "mean", engine, "speedup")) for engine in engines]
    rows.append([f"times as fast as `emulate`, geometric mean of {count} streams"] + means)
    return markdown(["ms a frame"] + [f"`{engine}`" for engine in engines], rows)


@text
def baselines(*engines):
    """Processor time per vertex and per pixel of each engine on the streams of baselines.json."""
    streams = [each["stream"] for each in load("baselines")["streams"]]
    headings = ["engine", "lanes", "set"]
    for name in streams:
        headings += [f"{name}: ns/vertex", "ns/pixel"]
    rows = []
    for engine in engines:
        runs = [results.stream_row("baselines", name, engine) for name in streams]
        row = [f"`{engine}`", runs[0].get("lanes", ""), runs[0].get("instruction_set", "")]
        for run in runs:
            row += [significant(run["vertex_ns"]), significant(run["pixel_ns"])]
        rows.append(row)
    return markdown(headings, rows)


@text
def baseline_code(*engines):
    """Size of the median routine, and what building it takes, on the streams of baselines.json."""
    headings = ["stream"]
    for engine in engines:
        headings += [f"`{engine}`: bytes", "build, µs"]
    rows = []
    for each in load("baselines")["streams"]:
        row = [f"`{each['stream']}`"]
        for engine in engines:
            run = results.stream_row("baselines", each["stream"], engine)
            row += [f"{run['code_bytes']:,.0f}", significant(run["build_us"])]
        rows.append(row)
    return markdown(headings, rows)


@text
def flow():
    """Flow control by constants and by values: nanoseconds a pixel and routines, from flow.json."""
    names = {
        "booleans": "eight parts inside of `if b#`, four sets of Booleans",
        "values": "the same inside of `if_gt` of two constants",
        "integers": "a loop of 16 passes, `rep i#`, the count set by the draw",
        "defined": "the same, the count defined in the shader",
        "unrolled": "its 16 passes written out",
    }
    rows = []
    for name, meaning in names.items():
        stitch, specialize = (results.stream_row("flow", name, each) for each in ("stitch", "specialize"))
        pixel_routines = stitch["routines"] - 2  # a vertex and a setup routine besides
        times = [significant(each["pixel_ns"]) for each in (stitch, specialize)]
        rows.append([meaning] + times + [f"{pixel_routines:.0f}"])
    return markdown(["", "`stitch`: ns/pixel", "`specialize`: ns/pixel", "pixel routines"], rows)


# --- Routines ----------------------------------------------------------------------------------------------------------


@text
def unit_builds(file, quantity, *engines):
    """Medians of build_us or code_bytes by unit, over the routines of a file's streams."""
    headings = ["median, " + {"build_us": "µs", "code_bytes": "bytes"}[quantity], "vertex", "setup", "pixel"]
    rows = [
        [f"`{engine}`"]
        + [
            significant(only(load(file)["builds"], file, engine=engine, unit=unit)[quantity]["median"])
            for unit in ("vertex", "setup", "pixel")
        ]
        for engine in engines
    ]
    return markdown(headings, rows)


@text
def builds(*engines):
    """What building routines takes: the distribution by unit, for sets of three and for bursts, from builds.json."""
    headings = ["µs", "", "routines or sets", "median", "90 %", "99 %", "most"]
    entries = load("builds")["builds"]
    kinds = list(dict.fromkeys(each["what"] for each in entries))
    rows = []
    for engine in engines:
        for what in kinds:
            entry = only(entries, "builds", engine=engine, what=what)
            times = [significant(entry[each + "_us"]) for each in ("median", "p90", "p99", "most")]
            rows.append([f"`{engine}`", what, f"{entry['count']:,.0f}"] + times)
    return markdown(headings, rows, 2)


def parts_of(engine, unit="all"):
    return only(load("parts")["engines"], "parts", engine=engine, unit=unit)


@text
def passes():
    """Without each pass: means of instructions and spills of a routine, and the median time to build one."""
    rows = []
    for engine in dict.fromkeys(each["engine"] for each in load("parts")["engines"]):
        entry = parts_of(engine)
        means = [entry[column] / entry["routines"] for column in ("left", "spills")]
        build = only(entry["parts"], engine, part="all")["median_us"]
        rows.append([f"`{engine}`"] + [significant(value) for value in means + [build]])
    return markdown(["", "instructions", "spills", "build, µs"], rows)


@text
def build_parts(*engines):
    """The parts of a build: medians, and the shares of the time of all builds."""
    names = [each["part"] for each in parts_of(engines[0])["parts"]]
    rows = []
    for name in names:
        row = [name]
        for engine in engines:
            part = only(parts_of(engine)["parts"], engine, part=name)
            row += [significant(part["median_us"]), significant(part["p99_us"]), f"{100 * part['share']:.1f}"]
        rows.append(row)
    headings = [heading for engine in engines for heading in (f"`{engine}`: µs", "99 %", "share, %")]
    return markdown([""] + headings, rows)


@text
def staircase(*engines):
    """Instructions after the first run of each pass, over all routines, as quotients to those recorded."""
    shown = [each["part"] for each in parts_of(engines[0])["parts"] if each["part"] not in ("allocate", "select", "encode", "all")]
    rows = []
    for name in shown:
        row = ["all runs" if name == "compact" else name]
        for engine in engines:
            part = only(parts_of(engine)["parts"], engine, part=name)
            row += [f"{100 * part['first_left'] / parts_of(engine)['recorded']:.1f}"]
            row += [f"{part['removed']:,.0f}" if part["runs"] else ""]
        rows.append(row)
    headings = [heading for engine in engines for heading in (f"`{engine}`: left, %", "removed")]
    return markdown([""] + headings, rows)


@text
def cold(*engines):
    """What the first frame of a stream costs, by the clock of the thread that draws, from cold.json."""
    rows = []
    for engine in engines:
        entry = only(load("cold")["cold"], "cold", engine=engine)
        rows.append(
            [f"`{engine}`"] + [significant(entry[each]) for each in ("thread_warm_ms", "thread_first", "thread_worst")]
        )
    return markdown(["engine", "warm frame, ms", "first frame, times that", "worst of the frames, times that"], rows)


# --- Shaders -----------------------------------------------------------------------------------------------------------

LENGTHS = [(1, 8), (9, 16), (17, 32), (33, 64), (65, 128), (129, 256), (257, 1 << 32)]


def length_name(least, most):
    return f"from {least}" if most > 1 << 20 else f"{least} to {most}"


@text
def shader_lengths(unit, *engines):
    """Nanoseconds per element by the length of the shader, with the quotient of stitch and specialize-8."""
    rows = []
    for least, most in LENGTHS:
        found = results.shader_rows(unit, least, most)
        if not found:
            continue
        times = [results.shader_column(found, engine, "ns") for engine in engines]
        quotient = results.shader_column(found, "stitch", "ns") / results.shader_column(found, "specialize-8", "ns")
        rows.append([length_name(least, most), len(found)] + list(map(significant, times)) + [f"{quotient:.2f}"])
    headings = [f"{unit} slots", "shaders"] + [f"`{engine}`" for engine in engines] + ["`stitch` / `specialize-8`"]
    return markdown(headings, rows)


@text
def shader_builds(*engines):
    """Microseconds to build a routine, and bytes of code, by the length of the shader, both units."""
    coded = [engine for engine in engines if engine in ("stitch", "specialize")]
    rows = []
    for least, most in LENGTHS:
        found = results.shader_rows("all", least, most)
        row = [length_name(least, most)]
        row += [significant(results.shader_column(found, engine, "build_us")) for engine in engines]
        row += [f"{results.shader_column(found, engine, 'code_bytes'):,.0f}" for engine in coded]
        rows.append(row)
    headings = ["slots"] + [f"`{engine}`, µs" for engine in engines] + [f"`{engine}`, bytes" for engine in coded]
    return markdown(headings, rows)


@text
def shader_code(*engines):
    """Means over all shaders: instructions, bytes of code, spills and microseconds to build."""
    rows = []
    for engine in engines:
        found = [only(row["engines"], row["shader"], engine=engine) for row in load("shaders")["shaders"]]
        means = [sum(each[column] for each in found) / len(found) for column in ("parts", "code_bytes", "spills", "build_us")]
        rows.append([f"`{engine}`"] + [significant(mean) for mean in means])
    return markdown(["mean of a shader's routines", "instructions", "bytes of code", "spills", "build, µs"], rows)


@text
def shader_worst(first, second, count):
    """The shaders with the largest quotients of two engines' times, in a line."""
    return ", ".join(
        f"`{name}` {quotient:.1f} times" for quotient, name in results.worst_shaders(first, second, count)
    )


# --- Renderers ---------------------------------------------------------------------------------------------------------


def rate(value):
    return "-" if value is None else significant(value)


def renderer_names(cores="one"):
    return [each["name"] for each in load("peers")["renderers"] if each["cores"] == cores and "description" in each]


@text
def renderers(*arguments):
    """Values of workloads by renderer: RENDERER... -- WORKLOAD... A renderer that was not measured has no column."""
    at = arguments.index("--")
    columns = [name for name in arguments[:at] if name in renderer_names()]
    rows = []
    for name in arguments[at + 1 :]:
        workload = results.workload(name)
        values = [results.cell(name, column).get("value") for column in columns]
        rows.append([workload["text"], workload["unit"]] + [rate(value) for value in values])
    return markdown(["", "unit"] + [f"`{name}`" for name in columns], rows, 2)


@text
def limits():
    """Each workload with its rate, with AVX-512 and AVX2, the best peer, and the share of the machine's limit."""
    narrow = "specialize-avx2" in renderer_names()
    headings = ["workload", "unit", "`specialize`"] + (["with AVX2"] if narrow else [])
    headings += ["best peer", "times as fast"] + (["with AVX2"] if narrow else []) + ["% of the limit"]
    rows = []
    for workload in load("peers")["workloads"]:
        own = results.cell(workload["name"], "specialize")
        avx2 = results.cell(workload["name"], "specialize-avx2") if narrow else {}
        row = [f"`{workload['name']}`", workload["unit"], rate(own.get("value"))]
        row += [rate(avx2.get("value"))] if narrow else []
        row += [results.best_peer(workload["name"]), rate(own["against_best_peer"][0])]
        row += [rate(avx2.get("against_best_peer", [None])[0])] if narrow else []
        share = own.get("percent_of_limit", 0)
        rows.append(row + [f"{share:.0f}" if share > 0 else "-"])
    return markdown(headings, rows, 2)


@text
def rivals(file, *others):
    """Each workload with the rate of `specialize`, and how many times as fast it is as each of the others: quotients of
    the medians. A renderer that was not measured has no column."""
    report = load(file)
    known = {each["name"] for each in report["renderers"] if each["cores"] == "one" and "description" in each}
    others = [name for name in others if name in known]
    rows = []
    for workload in report["workloads"]:
        values = {each["renderer"]: each.get("value") for each in workload["results"] if each["cores"] == "one"}
        own = values["specialize"]
        quotients = [own / values[name] if values.get(name) else None for name in others]
        if workload["unit"] == "ms":
            quotients = [1 / each if each else None for each in quotients]
        rows.append([f"`{workload['name']}`", workload["unit"], rate(own)] + list(map(rate, quotients)))
    return markdown(["workload", "unit", "`specialize`"] + [f"`{name}`" for name in others], rows, 2)


@text
def means(file="peers"):
    """The geometric means of the report, by pair of renderers, number of cores and group of workloads."""
    rows = [
        [
            f"`{entry['renderer']}`",
            f"`{entry['against']}`" if "against" in entry else "itself" if entry["group"] == "cores" else "best peer",
            "one against all" if entry["group"] == "cores" else entry["cores"],
            "without hidden layers" if entry["group"] == "cores" else entry["text"],
            f"{entry['mean']:.2f}",
            entry["workloads"],
        ]
        for entry in load(file)["geometric_means"]
    ]
    return markdown(["renderer", "against", "cores", "over", "times as fast", "workloads"], rows, 4)


# --- Checks and history ------------------------------------------------------------------------------------------------


# --- Programs of others ------------------------------------------------------------------------------------------


def programs():
    return load("programs")["programs"]


@text
def programs_pictures():
    """How the pictures differ from those of Wine's own Direct3D 9."""
    rows = []
    for each in programs():
        picture = each["picture"]
        rows.append(
            [each["program"], f"{picture['pixels']:,}", f"{picture['mean']:.2f}", f"{picture['far_percent']:.3f} %"]
            + ["yes" if picture["agrees"] else "no"]
        )
    return markdown(["program", "pixels", "mean difference", "differ by more than 16", "agrees"], rows)


def program_times(times):
    if not times:
        return ["", "", ""]
    shown = [f"{times[name]:,.0f}" if name in times else "" for name in ("first_ms", "longest_ms")]
    return [significant(times["fps"])] + shown


@text
def programs_speed():
    """Frames per second, first and longest frame of both sides, by number of threads."""
    rows = []
    for each in programs():
        for row in each["speed"]:
            ours, wines = row["triptych"], row["wine"]
            ratio = f"{ours['fps'] / wines['fps']:.2f}" if ours and wines else ""
            rows.append([each["program"], row["threads"], *program_times(ours), *program_times(wines), ratio])
    heads = ["program", "threads", "frames/s", "first, ms", "longest, ms"]
    return markdown(heads + ["Wine frames/s", "Wine first, ms", "Wine longest, ms", "times"], rows)


@text
def programs_caches():
    """Draws, routines and hits of a run."""
    rows = []
    for each in programs():
        found = each["statistics"]
        routines = found["routines"]
        looked_up = found["cache_hits"] + found["cache_misses"]
        rows.append(
            [each["program"], f"{found['draws'] / found['frames']:,.0f}", f"{found['routines_of_a_frame']:.1f}"]
            + [routines["vertex"], routines["setup"], routines["pixel"]]
            + [f"{100 * found['cache_hits'] / looked_up:.3f} %", f"{found['build_ms']:.1f}"]
        )
    heads = ["program", "draws of a frame", "routines of a frame", "vertex", "setup", "pixel", "hits", "built in ms"]
    return markdown(heads, rows)


@text
def programs_recordings():
    """Size of each recording, and milliseconds of a frame by engine."""
    names = [row["engine"] for row in programs()[0]["recording"]["engines"]]
    rows = []
    for each in programs():
        recording = each["recording"]
        times = {row["engine"]: row["frame_ms"] for row in recording["engines"]}
        rows.append(
            [each["program"], f"{recording['bytes'] / 1000:,.0f} kB", "identical" if recording["verified"] else "differs"]
            + [significant(times[name]) if name in times else "" for name in names]
        )
    return markdown(["program", "recording", "engines"] + [f"`{name}`, ms" for name in names], rows)


# --- Programs of OpenGL ES ---------------------------------------------------------------------------------------

NO_GLES = "\n`make programs-gles` writes `results/programs-gles.json`, and `python3 bench/figures write` this table of it.\n"


def programs_gles():
    """The programs; none before `make programs-gles` has been run."""
    try:
        return load("programs-gles")["programs"]
    except FileNotFoundError:
        return []


def gles_mesas(file="programs-gles"):
    """The sides of Mesa in the report, and their heads: llvmpipe with its version."""
    report = load(file)
    versions = {"llvmpipe": report["renderers"]["libgl1-mesa-dri"]}
    if newest := report["renderers"].get("llvmpipe-newest"):
        versions["llvmpipe-newest"] = newest.split()[1]
    return {side: "llvmpipe " + ".".join(version.split("-")[0].split(".")[:2]) for side, version in versions.items()}


def gles_speed(program, kind, threads, measure="fps"):
    """A measure of all sides, and how many times as fast Triptych is as the fastest Mesa. Unknown cells are empty."""
    sides = ["triptych", *gles_mesas()]
    rows = [row for row in program[kind] if row["threads"] == threads]
    found = [rows[0].get(side) if rows else None for side in sides]
    shown = [significant(each[measure]) if each else "" for each in found]
    ours, *mesas = (each and each[measure] for each in found)
    mesas = [each for each in mesas if each]
    if not ours or not mesas:
        return [*shown, ""]
    return [*shown, f"{ours / max(mesas) if measure == 'fps' else min(mesas) / ours:.2f}"]


@text
def programs_gles_pictures():
    """How the pictures differ from those of llvmpipe, and if the engines draw the recording alike."""
    rows = []
    for each in programs_gles():
        picture, recording = each["picture"], each["recording"]
        if "agrees" in picture:
            shown = [f"{picture['mean']:.2f}", f"{picture['far_percent']:.3f} %", "yes" if picture["agrees"] else "no"]
        else:
            shown = ["", "", "not compared" if all(picture["shown"].values()) else "no picture"]
        same = "identical" if recording and recording["verified"] else "differ"
        rows.append([each["program"], each["description"], *shown, same])
    heads = ["program", "what is drawn", "mean difference", "differ by more than 16", "agrees", "engines"]
    return markdown(heads, rows, 2) if rows else NO_GLES


def gles_table(kind, selected):
    """Frames per second with one thread and with two, and the processor time of a frame with one thread."""
    columns = [(kind, 1), (kind, 2), (kind, 1, "processor_ms")]
    rows = [
        [each["program"], *(cell for column in columns for cell in gles_speed(each, *column))]
        for each in programs_gles()
        if each[kind] or not selected
    ]
    heads = ["program"]
    for head in ("frames/s, 1 thread", "frames/s, 2 threads", "processor ms a frame"):
        heads += [head, *(gles_mesas().values() if rows else []), "times"]
    return markdown(heads, rows) if rows else NO_GLES


@text
def programs_gles_speed():
    """Speed of both sides in windows."""
    return gles_table("speed", False)


@text
def programs_gles_off_screen():
    """Speed of both sides without windows."""
    return gles_table("off_screen", True)


@text
def programs_gles_scores():
    """glmark2's score of both sides."""
    if not programs_gles():
        return "not measured yet"
    rows = load("programs-gles")["scores"]
    return ", ".join(
        f"{significant(row['triptych'])} with {row['threads']} thread{'s' * (row['threads'] > 1)}"
        + "".join(
            f", that of {name} {significant(row[side])} ({row['triptych'] / row[side]:.2f} times)"
            for side, name in gles_mesas().items()
        )
        for row in rows
    )


@text
def programs_gles_compiled():
    """How many programs the compilation was measured with, and whose they are."""
    report = load("programs-gles")["compilation"]
    parts = [f"{count} of {name}" for name, count in report.get("of", {"glmark2": report["programs"]}).items() if count]
    return f"{report['programs']} programs: {', '.join(parts)}"


@text
def programs_gles_compilation():
    """Compilation of GLSL on both sides."""
    if not programs_gles():
        return NO_GLES
    report = load("programs-gles")["compilation"]
    names = ("compile_ms", "link_ms", "draw_ms", "median_ms", "longest_ms")
    sides = {"triptych": "triptych", **gles_mesas()}
    rows = [[head, *(significant(report[side][name]) for name in names)] for side, head in sides.items()]
    heads = ["", "glCompileShader, ms", "glLinkProgram, ms", "first draw, ms", "median of the sums, ms", "longest, ms"]
    return markdown(heads, rows)


@text
def programs_gles_source():
    """The machine and the command of the tables."""
    return source("programs-gles") if programs_gles() else "not measured yet"


def profile_gles():
    """The profiles; none before `make profile-gles` has been run."""
    try:
        return load("profile-gles")["programs"]
    except FileNotFoundError:
        return []


@text
def profile_gles_classes():
    """Instructions of a frame: all of them, how many llvmpipe needs, and the share of each class."""
    if not profile_gles():
        return NO_PROFILE
    rows = []
    mesas = {side: head for side, head in gles_mesas("profile-gles").items() if any(side in each for each in profile_gles())}
    for each in profile_gles():
        millions = [each.get(side) for side in ("triptych", *mesas)]
        counts = [significant(count / 1e6) if count else "" for count in millions]
        shares = [100 * count / each["triptych"] for count in each["classes"].values()]
        rows.append([each["program"], *counts, *(f"{share:.0f}" if share >= 0.5 else "" for share in shares)])
    names = [f"{name}, %" for name in profile_gles()[0]["classes"]]
    return markdown(["program", "million instructions", *mesas.values(), *names], rows)


@text
def profile_gles_source():
    """The machine and the command of the table."""
    return source("profile-gles") if profile_gles() else "not measured yet"


NO_PROFILE = "\n`make profile-gles` writes `results/profile-gles.json`, and `python3 bench/figures write` this table of it.\n"
NO_SUITE = "\n`make conformance-gles DEQP=folder` writes `results/conformance-{}.json`, and `python3 bench/figures write` this table of it.\n"
PASSED = ("Pass", "QualityWarning", "CompatibilityWarning", "Waiver")


def suite_cells(found):
    """Cases that passed, that are not supported, and all others."""
    passed, unsupported = sum(found.get(each, 0) for each in PASSED), found.get("NotSupported", 0)
    return [f"{each:,}" for each in (passed, unsupported, sum(found.values()) - passed - unsupported)]


def suite_table(suite):
    """The groups of a suite on Triptych and on llvmpipe; none before `make conformance-gles` has been run."""
    try:
        report = load("conformance-" + suite)
    except FileNotFoundError:
        return NO_SUITE.format(suite)
    sides, rows = list(report["sides"]), []
    for each in report["groups"]:
        cells = [cell for side in sides for cell in suite_cells(each[side])]
        rows.append([f"`{each['group']}`", f"{each['cases']:,}", *cells])
    whole = [cell for side in sides for cell in suite_cells(report["sides"][side]["counts"])]
    rows.append(["all", f"{report['cases']:,}", *whole])
    heads = [f"{head}, {side}" for side in sides for head in ("passed", "not supported", "failed")]
    return markdown(["group", "cases", *heads], rows)


def suite_source(suite):
    """The machine and the command of the table, and the time of all cases, one after the other."""
    try:
        sides = load("conformance-" + suite)["sides"]
    except FileNotFoundError:
        return "not measured yet"
    times = " and ".join(f"{side['seconds']:,.0f} s on {name}" for name, side in sides.items())
    return f"{source('conformance-' + suite)}. All cases took {times}"


@text
def conformance_gles2():
    return suite_table("gles2")


@text
def conformance_gles2_source():
    return suite_source("gles2")


@text
def conformance_egl():
    return suite_table("egl")


@text
def conformance_egl_source():
    return suite_source("egl")


@text
def conformance_piglit():
    """The folders of piglit's tests on both sides."""
    report = load("conformance-piglit")
    sides, words = list(report["sides"]), ("pass", "skip", "fail")
    rows = [
        [f"`{each['group']}`", f"{each['tests']}", *(f"{each[side].get(word, 0)}" for side in sides for word in words)]
        for each in report["groups"]
    ]
    rows.append(["all", f"{report['tests']}", *(f"{report['sides'][side].get(w, 0)}" for side in sides for w in words)])
    heads = [f"{head}, {side}" for side in sides for head in ("passed", "skipped", "failed")]
    return markdown(["folder", "tests", *heads], rows)


@text
def conformance_piglit_source():
    return source("conformance-piglit")


# --- Claims ------------------------------------------------------------------------------------------------------------


def claim(identifier):
    return only(load("claims")["claims"], "claims", id=identifier)


@text
def verdict(identifier):
    return f"**{claim(identifier)['verdict']}**"


@text
def measured(identifier, name):
    """A value of a claim with its unit, and its interval if it has one."""
    value = only(claim(identifier)["values"], identifier, name=name)
    unit = {"-": "", "%": " %"}.get(value["unit"], " " + value["unit"].replace("_", " "))
    interval = "" if value["low"] == value["high"] else f" [{claimed(value['low'])}, {claimed(value['high'])}]"
    return claimed(value["value"]) + interval + unit


def claimed(value):
    return f"{value:,.0f}" if value == int(value) else significant(value)


@text
def verdicts(*prefixes):
    """A row for each claim whose name is in a range such as C1-C18: the claim, its values, the verdict."""
    rows = []
    for each in load("claims")["claims"]:
        if any(in_range(each["id"], prefix) for prefix in prefixes):
            values = ", ".join(f"{value['name'].replace('_', ' ')} {measured(each['id'], value['name'])}" for value in each["values"])
            words = each["words"].replace("|", "\\|")
            rows.append([each["id"], words, values, each["verdict"]])
    return markdown(["claim", "words", "measured", "verdict"], rows, left=4)


def in_range(identifier, prefix):
    first, _, last = prefix.partition("-")
    number = lambda name: int(name[1:])  # noqa: E731
    return identifier[0] == first[0] and number(first) <= number(identifier) <= number(last or first)


@text
def verdict_counts(*prefixes):
    """The number of claims with each verdict."""
    found = [each["verdict"] for each in load("claims")["claims"] if any(in_range(each["id"], prefix) for prefix in prefixes)]
    parts = [f"{found.count(name)} {name}" for name in dict.fromkeys(sorted(found, key=ORDER.index))]
    return f"{len(found)}: {', '.join(parts)}"


ORDER = ["holds", "holds in part", "does not hold", "cannot be tested here", "not yet", "no verdict"]


@text
def campaigns():
    """The campaigns of `triptych fuzz` that fuzz.json holds."""
    rows = []
    for run in results.campaigns():
        counts = [f"{run[each]:,}" for each in ("cases", "same", "refused", "limited")]
        bad = sum(run[each] for each in ("different", "failed", "crashed", "hung"))
        rows.append(
            [run["machine"]["commit"], run["machine"]["cpu"], f"{run['seed']}{', interrupted' if run['interrupted'] else ''}", len(run["engines"])] + counts + [bad, f"{run['pixels'] / 1e6:.1f}"]
        )
    headings = ["commit", "processor", "seed", "engines", "cases", "same", "refused", "limited", "findings", "million pixels"]
    return markdown(headings, rows, 2)


# --- Kernels that are not graphics: clients.json ------------------------------------------------------------------------

NO_CLIENTS = "\n`make bench-clients` writes `results/clients.json`, and `python3 bench/figures write` this table of it.\n"


def clients(part):
    """The `jobs` or the `counts`; none before `make bench-clients` has been run."""
    try:
        return load("clients")[part]
    except FileNotFoundError:
        return []


@text
def client_counts(*engines):
    """Executed instructions for a byte of input, by job, of engines with different numbers of lanes."""
    counts = clients("counts")
    if not counts:
        return NO_CLIENTS
    jobs = list(dict.fromkeys(each["job"] for each in counts))
    rows = [
        [job] + [significant(only(counts, "clients", job=job, way=engine)["instructions_a_byte"]) for engine in engines]
        for job in jobs
    ]
    return markdown([""] + [f"`{engine}`" for engine in engines], rows)


@text
def client_lanes(*engines):
    """Megabytes a second on one thread, by processor time. An engine that the machine cannot run has no number."""
    jobs = clients("jobs")
    if not jobs:
        return NO_CLIENTS
    rows = []
    for job in jobs:
        ways = {each["way"]: each for each in job["ways"]}
        speeds = [significant(1e3 / ways[each]["ns_a_byte"]) if each in ways else "" for each in engines]
        rows.append([job["job"]] + speeds)
    return markdown(["MB/s"] + [f"`{engine}`" for engine in engines], rows)


@text
def client_threads(*engines):
    """The speed of the most threads that were measured, as a multiple of that of one, by wall time."""
    jobs = clients("jobs")
    if not jobs:
        return NO_CLIENTS
    rows = []
    for job in jobs:
        ways = {each["way"]: each for each in job["ways"]}
        times = [f"{ways[each]['threads'][-1]['times']:.2f}" if each in ways else "" for each in engines]
        rows.append([job["job"]] + times)
    return markdown(["times"] + [f"`{engine}`" for engine in engines], rows)


@text
def client_source(*engines):
    """The machine and the command of the tables, and the lanes of engines whose name does not have them."""
    ways = {each["way"]: each["lanes"] for job in clients("jobs") for each in job["ways"]}
    lanes = ", ".join(f"`{engine}` {ways[engine]} lanes" for engine in engines if engine in ways)
    return f"{lanes}; {source('clients')}" if ways else "not measured yet"


@text
def history(table):
    """The rows of history.csv with that table's name. An empty change continues the one above."""
    rows = []
    for row in load("history.csv"):
        if row["table"] == table:
            files = ", ".join(f"`{file}`" for file in row["files"].split())
            rows.append([row["change"], files, row["workload"], row["result"], row["unit"], row["measured_by"]])
    if not rows:
        raise KeyError(f"history.csv has no rows of {table}")
    return markdown(["change", "where", "measured on", "before → after", "unit", "measured by"], rows, 6)
