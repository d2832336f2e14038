"""What the reports of the conformance suites and of the programs share: files, and the reasons of failures."""

import json
import os


def write_json(folder, name, document):
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        json.dump(document, file, indent=1)
        file.write("\n")


def read_reasons(path):
    """The lines `PLACE | WORDS` of a file, as a dictionary. Lines that begin with # are comments."""
    found = {}
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.strip() and not line.startswith("#"):
                place, words = line.split("|", 1)
                found[place.strip()] = words.strip()
    return found
