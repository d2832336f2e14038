"""What a tracker of values that seldom change would find in a stream, beside the keys.

    python3 bench/claims/tools/tracker.py STREAM [THRESHOLD]

A word is a state, a stage or sampler state, a transformation, a light, a binding, or a constant of a shader. The
tracker compares all words with those of the draw before. A word that was the same for THRESHOLD draws (16) becomes
a constant of the routine, with a guard. A guard fails at the draw that changes its word.

Prints as JSON: the numbers of draws and of words; compared: words that are compared at a draw; failures: the draws
at which a guard fails, in percent; in_keys: words that keys depend on; chosen: words that are constants in the mean
of all draws; common: those of them that keys depend on; missed: words of keys that are not constants.
"""

import json
import subprocess
import sys

PREFIXES = {"state": 2, "stage": 3, "sampler": 3, "transform": 2, "light": 2, "material": 1, "bind": 2, "pixelconstant": 2,
            "vertexconstant": 2, "pixelshader": 1, "vertexshader": 1, "scissor": 1, "viewport": 1}


def run(*command):
    done = subprocess.run(["triptych", *command], capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"tracker.py: {done.stderr.strip()}")
    return done.stdout


def calls_of(text):
    """The calls of all frames, in their order; those of a sequence where it is played."""
    sequences, current, calls = {}, None, []
    depth = 0
    for line in text.splitlines():
        words = line.split()
        if depth or not words or words[0].startswith("#"):
            depth -= words[:1] == ["}"]
            continue
        depth += words[-1] == "{"
        if words[0] == "sequence":
            current = sequences.setdefault(words[1], [])
        elif words[0] == "end":
            current = None
        elif words[0] == "play":
            (calls if current is None else current).extend(sequences[words[1]])
        else:
            (calls if current is None else current).append(words)
    return calls


def key_words():
    """Names of states that keys depend on; a dash and `job` are not in keys."""
    rows = json.loads(run("list", "states", "--json"))
    return {row["state"] for row in rows if set(row["keys"]) & set("VSP")}


def in_key(word, keys):
    """Bindings and shaders decide keys; transformations, lights' colours and constants do not."""
    kind = word.split()[0]
    return word.split()[-1] in keys if kind in ("state", "stage", "sampler") else kind in ("bind", "pixelshader", "vertexshader")


def track(calls, threshold, keys):
    value, age, before = {}, {}, {}
    draws = failures = chosen = common = missed = compared = 0
    for words in calls:
        length = PREFIXES.get(words[0])
        if length:
            value[" ".join(words[:length])] = words[length:]
        if words[0] != "draw":
            continue
        draws += 1
        compared += len(value)
        failed = False
        for word, now in value.items():
            same = before.get(word) == now
            failed |= not same and age.get(word, 0) >= threshold
            age[word] = age.get(word, 0) + 1 if same else 0
            constant, key = age[word] >= threshold, in_key(word, keys)
            chosen += constant
            common += constant and key
            missed += key and not constant
        failures += failed
        before = dict(value)
    return {
        "draws": draws,
        "words": len(value),
        "compared": compared / draws,
        "failures": 100 * failures / draws,
        "in_keys": sum(in_key(word, keys) for word in value),
        "chosen": chosen / draws,
        "common": common / draws,
        "missed": missed / draws,
    }


def main():
    threshold = int(sys.argv[2]) if len(sys.argv) > 2 else 16
    calls = calls_of(run("convert", sys.argv[1], "--format", "tri", "-"))
    print(json.dumps(track(calls, threshold, key_words())))


main()
