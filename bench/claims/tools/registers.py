"""Counts registers, arithmetic instructions and samples of every shader of the project, from the disassembly, as JSON.

    python3 bench/claims/tools/registers.py
"""

import glob
import json
import re
import subprocess
import tempfile

TEMPORARIES = {"vs_1": 12, "vs_2": 12, "vs_3": 32, "ps_1": 2, "ps_2": 12, "ps_3": 32}
FLOW = re.compile(r"(if|else|endif|rep|endrep|loop|endloop|break|call|ret|label|def|dcl|phase|nop|end)")
SAMPLE = re.compile(r"(tex(?!kill|coord|crd|depth|m3x3pad|m3x2pad))")


def shader(path):
    with tempfile.NamedTemporaryFile() as tokens:
        run("triptych", "shader", "assemble", path, "--out", tokens.name)
        lines = run("triptych", "shader", "disassemble", tokens.name).splitlines()
    model = lines[0].strip()
    code = [line.strip() for line in lines[1:] if line.strip()]
    samples = sum(1 for line in code if SAMPLE.match(line))
    flow = sum(1 for line in code if FLOW.match(line))
    return {
        "shader": path,
        "model": model,
        "unit": "vertex" if model.startswith("vs") else "pixel",
        "registers": len(set(re.findall(r"\br(\d+)", "\n".join(code)))),
        "allowed": 6 if model == "ps_1_4" else TEMPORARIES[model[:4]],
        "arithmetic": len(code) - samples - flow,
        "samples": samples,
    }


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


paths = sorted(glob.glob("tests/data/shaders/*/*.vsa") + glob.glob("tests/data/shaders/*/*.psa"))
print(json.dumps({"shaders": [shader(path) for path in paths]}, indent=1))
