#!/usr/bin/env python3
"""Time to equal error: renders scenes against a converged picture of their own and prints, for each Stokes component, the
root mean square error that one core-second leaves, over pixels and spectral bands and over pixels in the green of linear
sRGB. Time to an error e is (that / e)^2.

Usage: equal_error.py [--patina build/release/bin/patina] [--spp 64] [--reference-spp 1024] [--seeds 2] [--integrator NAME]
                      [SCENE.xml ...]
Without scenes: the three that docs/performance.md lists. The time is user CPU time on one thread less that of a picture of
one sample, so that solving recipes and building tables does not count."""
import argparse
import json
import pathlib
import resource
import subprocess
import tempfile

SCENES = ["examples/polar_balls.xml", "examples/painted_spheres.xml", "examples/painted_cornell_box.xml"]
COMPONENTS = ["S0", "S1", "S2", "S3"]


def user_seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def render(patina, scene, out, spp, seed, extra, threads=1):
    return user_seconds([patina, "-j", str(threads), "-q", "render", scene, "-o", out, "--spp", str(spp),
                         "--seed", str(seed), *extra])


def mean_square_errors(patina, picture, reference):
    """Of S0..S3 over the spectral bands, then of S0..S3 in green."""
    text = subprocess.run([patina, "compare", picture, reference, "--json"], check=True, capture_output=True, text=True).stdout
    document = json.loads(text)
    bands = {row["component"]: row["rms"] for row in document["stokes"]}
    green = {row["component"]: row["G"]["rms"] for row in document["rgb"]}
    return [bands[c] ** 2 for c in COMPONENTS] + [green[c] ** 2 for c in COMPONENTS]


def measure(scene, arguments, folder):
    """RMSE at --spp (bands, then green), core-seconds of it, and the RMSE that one core-second would leave."""
    extra = ["--integrator", arguments.integrator] if arguments.integrator else []
    reference, picture = str(folder / "reference.exr"), str(folder / "picture.exr")
    # The reference is made by the scene's own method, whichever is measured.
    render(arguments.patina, scene, reference, arguments.reference_spp, 1000, [], arguments.threads)
    squares, seconds = [0.0] * 8, 0.0
    for seed in range(arguments.seeds):
        overhead = render(arguments.patina, scene, picture, 1, seed, extra)
        seconds += (render(arguments.patina, scene, picture, arguments.spp, seed, extra) - overhead) / arguments.seeds
        squares = [a + b / arguments.seeds for a, b in zip(squares, mean_square_errors(arguments.patina, picture, reference))]
    # The reference has its own noise, with as much less variance as it has more samples.
    share = 1 / (1 + arguments.spp / arguments.reference_spp)
    errors = [(square * share) ** 0.5 for square in squares]
    return errors, seconds, [error * seconds ** 0.5 for error in errors]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", default=SCENES)
    parser.add_argument("--patina", default="build/release/bin/patina")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--reference-spp", type=int, default=1024)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--integrator", default="")
    parser.add_argument("--threads", type=int, default=0, help="of the reference alone (0: all)")
    arguments = parser.parse_args()
    print(f"{'scene':28} {'core-s':>8} of     RMSE at {arguments.spp} spp, S0 S1 S2 S3" + " " * 14 + "RMSE after one core-second")
    with tempfile.TemporaryDirectory() as folder:
        for scene in arguments.scenes:
            errors, seconds, normalized = measure(scene, arguments, pathlib.Path(folder))
            for name, first in (("bands", 0), ("green", 4)):
                numbers = "   ".join(" ".join(f"{x:9.3g}" for x in values[first:first + 4]) for values in (errors, normalized))
                print(f"{pathlib.Path(scene).stem:28} {seconds:8.2f} {name:6} {numbers}", flush=True)


if __name__ == "__main__":
    main()
