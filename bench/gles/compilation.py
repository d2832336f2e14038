"""The processor time from the sources of a program to machine code, for each that glmark2 and other programs link."""

import os
import shutil
import statistics
import subprocess

RUNS = 3


FRAMES = 6  # that a program draws while its sources are collected


def linked(player, programs):
    """Runs glmark2 and the programs. Returns the pairs of sources that each of them links."""
    folders = {name: player.path(os.path.join("linked", name)) for name in ["glmark2", *(each.name for each in programs)]}
    shutil.rmtree(player.path("linked"), ignore_errors=True)
    for folder in folders.values():
        os.makedirs(folder)
    command = [player.triptych, "run", "--gl", "env", "LD_PRELOAD=" + player.path("frames.so"), "glmark2-es2"]
    subprocess.run(
        [*command, "--off-screen", "--validate"],
        env={**os.environ, "FRAMES_SOURCES": folders["glmark2"]}, capture_output=True, check=True,
    )  # fmt: skip
    for each in programs:
        player.run(each, "triptych", 1, FRAMES, FRAMES_SOURCES=folders[each.name])
    return {name: pairs(folder) for name, folder in folders.items()}


def pairs(folder):
    numbers = sorted(int(name[:-5]) for name in os.listdir(folder) if name.endswith(".vert"))
    return [tuple(open(os.path.join(folder, f"{number}.{end}")).read() for end in ("vert", "frag")) for number in numbers]


def sources(player, programs):
    """Writes each different pair of sources once: 0.vert, 0.frag and so on. Returns the folder, their number, and that
    of each program."""
    folder, seen, counts = player.path("sources"), set(), {}
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    for name, found in linked(player, programs).items():
        before = len(seen)
        for pair in found:
            if pair not in seen:
                for text, end in zip(pair, ("vert", "frag")):
                    with open(os.path.join(folder, f"{len(seen)}.{end}"), "w") as file:
                        file.write(text)
                seen.add(pair)
        counts[name] = len(seen) - before
    return folder, len(seen), counts


def times(player, side, folder, count):
    """Milliseconds of each program in a new process: compiling, linking, and what the first draw takes longer."""
    command, variables = player.launch(side, 1, [player.path("compile"), folder, str(count)])
    variables = {**os.environ, **variables, "MESA_SHADER_CACHE_DISABLE": "true"}
    done = subprocess.run(command, env=variables, capture_output=True, text=True, check=True)
    rows = [dict(zip(words[1::2], map(float, words[2::2]))) for words in map(str.split, done.stdout.splitlines())]
    return [(row["compile"], row["link"], row["first"] - row["second"]) for row in rows]


def compilation(player, sides, programs):
    """Medians over the programs, each of which has the median of its runs; the sides take turns."""
    folder, count, counts = sources(player, programs)
    runs = {side: [] for side in sides}
    for _ in range(RUNS):
        for side in sides:
            runs[side].append(times(player, side, folder, count))
    report = {"programs": count, "of": counts, "runs": RUNS}
    for side in sides:
        sums = [statistics.median(map(sum, each)) for each in zip(*runs[side])]
        parts = [statistics.median(row[i] for run in runs[side] for row in run) for i in range(3)]
        report[side] = {"median_ms": statistics.median(sums), "longest_ms": max(sums)}
        report[side] |= dict(zip(("compile_ms", "link_ms", "draw_ms"), parts))
    return report
