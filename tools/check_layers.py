#!/usr/bin/env python3
"""Checks the layer rule: a folder of src/patina includes only from folders of lower layers (ARCHITECTURE.md)."""
import pathlib
import re
import sys

LAYERS = {
    "core": 0, "math": 1, "spectral": 2, "optics": 3, "rt": 4, "brdf": 4,
    "render": 5, "io": 5, "coating": 6, "jobs": 7,
}
INCLUDE = re.compile(r'^\s*#include "patina/([a-z_]+)/')


def violations(root: pathlib.Path):
    for path in sorted(root.rglob("*")):
        if path.suffix not in (".h", ".cpp"):
            continue
        folder = path.relative_to(root).parts[0]
        for number, line in enumerate(path.read_text().splitlines(), 1):
            match = INCLUDE.match(line)
            if not match or match[1] == folder or match[1] == "version.h":
                continue
            if match[1] not in LAYERS:
                yield f"{path}:{number}: unknown folder {match[1]}"
            elif LAYERS[match[1]] >= LAYERS[folder]:
                yield f"{path}:{number}: {folder} (layer {LAYERS[folder]}) may not include {match[1]} (layer {LAYERS[match[1]]})"


def main() -> int:
    root = pathlib.Path(__file__).resolve().parent.parent / "src" / "patina"
    found = list(violations(root))
    print("\n".join(found) if found else "layers: every include points downward")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
