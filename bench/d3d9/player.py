"""Runs a program for Windows on Triptych or on Wine's own Direct3D 9: pictures, times, recordings."""

import json
import os
import re
import signal
import subprocess
import time

FRAMES = re.compile(r"^@frames (\d+) start ([\d.]+) first ([\d.]+) longest ([\d.]+) total ([\d.]+)")
# Printed by Panda3D's viewer at its end.
AVERAGE = re.compile(r"^([\d.]+) fps average", re.M)
SIDES = ("triptych", "wine")


class Program:
    """A program: its folder, its command, the frame of its picture, the frames that are measured."""

    def __init__(self, name, command, picture, frames, environment=None, driven=None):
        self.name = name
        self.command = command
        self.picture = picture  # None: the program does not have the arguments of frames.h
        self.frames = frames  # or seconds, for such a program
        self.environment = environment or {}
        self.driven = driven  # arguments of xdotool before the picture


class Player:
    def __init__(self, folder, triptych, engine):
        self.folder = os.path.abspath(folder)
        self.triptych = os.path.abspath(triptych)
        self.engine = engine

    def start(self, program, side, threads, arguments=(), environment=None):
        command = [*program.command, *arguments]
        variables = {**os.environ, **program.environment, **(environment or {})}
        if side == "triptych":
            command = [self.triptych, "run", "--engine", self.engine, "--threads", str(threads), *command]
        else:
            command = ["wine", *command]
            # llvmpipe draws on the calling thread if it has no threads of its own.
            variables |= {"WINEDLLOVERRIDES": "d3d9=b", "LP_NUM_THREADS": str(threads if threads > 1 else 0)}
        cores = sorted(os.sched_getaffinity(0))[:threads]
        return subprocess.Popen(
            ["taskset", "-c", ",".join(map(str, cores)), *command],
            cwd=os.path.join(self.folder, program.name),
            env=variables,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            text=True,
            errors="replace",
        )

    @staticmethod
    def end(process):
        """Ends a program that does not end by itself, and all that its prefix runs."""
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        subprocess.run(["wineserver", "-k"], check=False, capture_output=True)
        subprocess.run(["wineserver", "-w"], check=False, capture_output=True)
        process.stdout.close()
        process.wait()

    def picture(self, program, side, path, limit=120):
        """Takes a picture of the screen while the program shows one frame."""
        arguments = () if program.picture is None else ("picture", str(program.picture))
        process = self.start(program, side, 2, arguments)
        try:
            return self.steady_picture(process, program, path, limit)
        finally:
            self.end(process)

    @staticmethod
    def steady_picture(process, program, path, limit):
        """The screen when three pictures in a row are equal and not of one colour. Returns false if it never is."""
        begin, previous, equal, driven = time.monotonic(), None, 0, program.driven is None
        while time.monotonic() - begin < limit and process.poll() is None:
            time.sleep(1)
            subprocess.run(["import", "-window", "root", path], check=True, capture_output=True)
            pixels = read_pixels(path)
            equal = equal + 1 if pixels == previous and len(set(pixels[::997])) > 8 else 0
            previous = pixels
            if equal >= 3 and driven:
                return True
            if equal >= 3:
                subprocess.run(["xdotool", *program.driven], check=True)
                driven, equal = True, 0
        return False

    def speed(self, program, side, threads, statistics_path=None, record=None, frames=None):
        """Times of one run in milliseconds, or None if the program failed."""
        environment = {}
        if side == "triptych":
            environment = {"TRIPTYCH_STATISTICS": statistics_path or "", "TRIPTYCH_RECORD": record or ""}
            environment = {name: value for name, value in environment.items() if value}
        if program.picture is None:
            return self.timed(program, side, threads, statistics_path, environment)
        process = self.start(program, side, threads, ("speed", str(frames or program.frames)), environment)
        try:
            output, _ = process.communicate(timeout=600)
        except subprocess.TimeoutExpired:
            output = ""
        finally:
            self.end(process)
        for line in output.splitlines():
            if match := FRAMES.match(line):
                frames, start, first, longest, total = map(float, match.groups())
                return {"fps": 1000 * (frames - 1) / total, "first_ms": start + first, "longest_ms": longest}
        return None

    def timed(self, program, side, threads, statistics_path, environment):
        """A program without a number of frames runs for some seconds, then its window is closed. It prints its mean
        frames per second; the times of single frames are those of the front end."""
        if side == "triptych" and statistics_path is None:
            environment["TRIPTYCH_STATISTICS"] = statistics_path = os.path.join(self.folder, "timed.json")
        process = self.start(program, side, threads, (), environment)
        time.sleep(program.frames)
        subprocess.run(["wine", "taskkill", "/im", os.path.basename(program.command[0])], check=False, capture_output=True)
        try:
            output, _ = process.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            output = ""
        finally:
            self.end(process)
        average = AVERAGE.search(output)
        if not average:
            return None
        measured = (load(statistics_path) if side == "triptych" else None) or {}
        names = {"first_frame_ms": "first_ms", "longest_frame_ms": "longest_ms"}
        return {"fps": float(average[1]), **{names[name]: measured[name] for name in names if name in measured}}


def load(path):
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return None


def read_pixels(path):
    return subprocess.run(["convert", path, "-depth", "8", "rgb:-"], capture_output=True, check=True).stdout


def difference(ours, wines, allowed=16):
    """How two pictures differ, over the pixels where one of them is not black: the screen outside the window."""
    first, second = read_pixels(ours), read_pixels(wines)
    covered = far = total = most = 0
    for at in range(0, min(len(first), len(second)), 3):
        a, b = first[at : at + 3], second[at : at + 3]
        if a == b == b"\0\0\0":
            continue
        covered += 1
        if a != b:
            largest = max(abs(x - y) for x, y in zip(a, b))
            total += largest
            most = max(most, largest)
            far += largest > allowed
    covered = max(covered, 1)
    return {"pixels": covered, "mean": total / covered, "most": most, "far_percent": 100 * far / covered}
