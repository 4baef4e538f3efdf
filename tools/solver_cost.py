#!/usr/bin/env python3
"""Measures how the solver's cost grows with streams, layers, thickness and wavelengths, and plots it.

Runs `rt_benchmark` and `patina` of a built tree, each measurement several times, and takes the least CPU time (other work
on a machine can only add to it). Writes docs/images/solver_cost.svg (gnuplot) and prints tables with fitted exponents.
"""

import argparse
import json
import math
import os
import resource
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def benchmark(build, repetitions):
    """{name: {arguments: CPU milliseconds}} of the cost_* rows of rt_benchmark."""
    command = [build / "bin/rt_benchmark", "--benchmark_filter=^cost_", "--benchmark_format=json",
               "--benchmark_min_time=0.005", f"--benchmark_repetitions={repetitions}"]
    rows = json.loads(subprocess.run(command, capture_output=True, check=True, text=True).stdout)["benchmarks"]
    costs = {}
    for row in rows:
        if row["run_type"] != "iteration":
            continue
        name, *arguments = row["run_name"].split("/")
        found = costs.setdefault(name, {})
        key = tuple(int(argument) for argument in arguments)
        found[key] = min(row["cpu_time"], found.get(key, math.inf))
    return costs


def user_seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def wavelengths(build, repetitions):
    """{number of wavelengths: CPU milliseconds} of a whole `patina solve`."""
    costs = {}
    with tempfile.TemporaryDirectory() as folder:
        for step in (400, 100, 40, 16, 5):
            command = [build / "bin/patina", "solve", ROOT / "examples/tio2_on_aluminium.toml", "-j1", "-q",
                       "-o", os.path.join(folder, "table.h5"), "--wavelengths", f"380:780:{step}"]
            costs[int(400 / step) + 1] = 1e3 * min(user_seconds(command) for _ in range(repetitions))
    return costs


def exponent(points, tail):
    """Slope of the logarithm over the last `tail` points, by least squares."""
    logs = [(math.log(x), math.log(y)) for x, y in sorted(points.items())[-tail:]]
    mean_x, mean_y = (sum(v) / len(logs) for v in zip(*logs))
    return (sum((x - mean_x) * (y - mean_y) for x, y in logs) / sum((x - mean_x) ** 2 for x, _ in logs))


def doubling_gflop(streams, layers=1, thickness=1.0):
    """Floating-point operations (1e9) of problem IIA without interface: per layer, with n unknowns, three inverses of n^3
    and a parallel sum of 7/3 n^3 for each of five steps of the start and each doubling; twelve orders, m = 0 in halves."""
    smallest_mu = 1.44 / (streams + 0.5) ** 2  # of the Gauss nodes on (0, 1): (j_01)^2 / (2 N + 1)^2
    z = 0.5 * thickness / smallest_mu
    worst = min(z, 5.5)
    error = 1e-7 * worst**10 * 2 * worst / math.sinh(2 * worst)
    steps = max(0, math.ceil(max(math.log2(error / 1e-16) / 10, math.log2(z / 3))))
    return 1e-9 * layers * (3 + 7 / 3 * (5 + steps)) * (4 * streams) ** 3 * (11 + 0.25)


def table(title, unit, points):
    print(f"\n{title}")
    for x, y in sorted(points.items()):
        print(f"  {x:>8g} {unit:<16} {y:10.3f} ms")


PLOT = """
set terminal svg size 900,640 font "sans,13" background "white"
set output "{output}"
set multiplot layout 2,2
set grid lc rgb "#dddddd"
set key left top reverse Left
set ylabel "CPU time, ms"
set logscale xy
{panels}
unset multiplot
"""


def panel(folder, label, curves, extra=""):
    lines = []
    for number, (title, points) in enumerate(curves):
        data = folder / f"{label.split()[0]}{number}.dat"
        data.write_text("".join(f"{x} {y}\n" for x, y in sorted(points.items())))
        lines.append(f'"{data}" using 1:2 with linespoints pt 7 ps 0.6 lw 1.5 title "{title}"')
    return f'set xlabel "{label}"\n{extra}\nplot ' + ", ".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=ROOT / "build/release")
    parser.add_argument("--output", type=Path, default=ROOT / "docs/images/solver_cost.svg")
    parser.add_argument("--repetitions", type=int, default=5)
    options = parser.parse_args()

    costs = benchmark(options.build, options.repetitions)
    first = {name: {key[0]: value for key, value in rows.items()} for name, rows in costs.items()}
    layers = {key[1]: value for key, value in costs["cost_layers"].items()}
    thickness = {10.0 ** key[1]: value for key, value in costs["cost_thickness"].items()}
    spectrum = wavelengths(options.build, options.repetitions)

    streams = [("doubling", first["cost_streams"]), ("eigenmodes", first["cost_streams_eigenmodes"]),
               ("doubling, interface and metal", first["cost_streams_interface"])]
    for title, points in streams:
        table(f"{title}: exponent {exponent(points, 3):.2f} over the last three", "streams", points)
    for count, milliseconds in sorted(first["cost_streams"].items()):
        print(f"  {count} streams: {doubling_gflop(count) / (1e-3 * milliseconds):.1f} GFLOP/s")
    table(f"layers, 8 streams: exponent {exponent(layers, 3):.2f}", "layers", layers)
    table("thickness, 8 streams", "optical depths", thickness)
    table(f"whole solve, 9 streams: exponent {exponent(spectrum, 3):.2f}", "wavelengths", spectrum)

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        panels = [panel(folder, "streams", streams,
                        "set xrange [6:64]; set xtics (8, 16, 24, 32, 48); set yrange [0.3:3000]"),
                  panel(folder, "layers", [("8 streams, interface and metal", layers)],
                        "set xrange [0.8:20]; set xtics (1, 2, 4, 8, 16); set yrange [1:200]"),
                  panel(folder, "optical thickness", [("8 streams, interface and metal", thickness)],
                        'set xrange [*:*]; set xtics autofreq; set format x "10^{%L}"; unset logscale y; set yrange [0:8]'),
                  panel(folder, "wavelengths", [("patina solve with its error bound", spectrum)],
                        'set xtics (2, 5, 10, 20, 40, 80); set format x "%g"; set logscale y; set yrange [100:5000]')]
        options.output.parent.mkdir(parents=True, exist_ok=True)
        subprocess.run(["gnuplot"], input=PLOT.format(output=options.output, panels="\n".join(panels)), text=True,
                       check=True)
    print(f"\n{options.output}")


if __name__ == "__main__":
    main()
