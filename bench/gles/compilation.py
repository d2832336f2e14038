"""The processor time from the sources of a program to machine code, for each program that glmark2 links."""

import os
import shutil
import statistics
import subprocess

RUNS = 3


def sources(player):
    """Writes each different pair of sources once: 0.vert, 0.frag and so on. Returns the folder and their number."""
    linked, folder, seen = player.path("linked"), player.path("sources"), set()
    for each in (linked, folder):
        shutil.rmtree(each, ignore_errors=True)
        os.makedirs(each)
    command = [player.triptych, "run", "--gl", "env", "LD_PRELOAD=" + player.path("frames.so"), "glmark2-es2"]
    subprocess.run(
        [*command, "--off-screen", "--validate"],
        env={**os.environ, "FRAMES_SOURCES": linked}, capture_output=True, check=True,
    )  # fmt: skip
    for number in sorted(int(name[:-5]) for name in os.listdir(linked) if name.endswith(".vert")):
        pair = tuple(open(os.path.join(linked, f"{number}.{end}")).read() for end in ("vert", "frag"))
        if pair not in seen:
            for text, end in zip(pair, ("vert", "frag")):
                with open(os.path.join(folder, f"{len(seen)}.{end}"), "w") as file:
                    file.write(text)
            seen.add(pair)
    return folder, len(seen)


def times(player, side, folder, count):
    """Milliseconds of each program in a new process: compiling, linking, and what the first draw takes longer."""
    command, variables = player.launch(side, 1, [player.path("compile"), folder, str(count)])
    variables = {**os.environ, **variables, "MESA_SHADER_CACHE_DISABLE": "true"}
    done = subprocess.run(command, env=variables, capture_output=True, text=True, check=True)
    rows = [dict(zip(words[1::2], map(float, words[2::2]))) for words in map(str.split, done.stdout.splitlines())]
    return [(row["compile"], row["link"], row["first"] - row["second"]) for row in rows]


def compilation(player, sides):
    """Medians over the programs, each of which has the median of its runs; the sides take turns."""
    folder, count = sources(player)
    runs = {side: [] for side in sides}
    for _ in range(RUNS):
        for side in sides:
            runs[side].append(times(player, side, folder, count))
    report = {"programs": count, "runs": RUNS}
    for side in sides:
        sums = [statistics.median(map(sum, each)) for each in zip(*runs[side])]
        parts = [statistics.median(row[i] for run in runs[side] for row in run) for i in range(3)]
        report[side] = {"median_ms": statistics.median(sums), "longest_ms": max(sums)}
        report[side] |= dict(zip(("compile_ms", "link_ms", "draw_ms"), parts))
    return report
