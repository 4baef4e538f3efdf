#!/usr/bin/env python3
"""Writes the demo's environment: a photographer's studio as a latitude-longitude PFM (linear RGB).

A dim gradient from floor to ceiling, a long strip light on one side and a large soft panel on the other, with soft
edges so that it can be sampled well. Usage: make_studio.py OUT.pfm
"""
import math
import struct
import sys

WIDTH, HEIGHT = 512, 256


def soft_step(x, edge, width):
    t = min(1.0, max(0.0, (x - edge) / width + 0.5))
    return t * t * (3 - 2 * t)


def panel(azimuth_deg, elevation_deg, centre, size, softness):
    """1 inside a rectangle of angles, falling softly to 0 outside."""
    across = abs((azimuth_deg - centre[0] + 180) % 360 - 180)
    up = abs(elevation_deg - centre[1])
    return (1 - soft_step(across, size[0], softness)) * (1 - soft_step(up, size[1], softness))


def radiance(azimuth_deg, elevation_deg):
    sky = 0.18 + 0.5 * soft_step(elevation_deg, 10, 140)
    strip = 5.0 * panel(azimuth_deg, elevation_deg, (55, 25), (5, 38), 6)
    soft_box = 1.6 * panel(azimuth_deg, elevation_deg, (-120, 35), (30, 22), 12)
    warm, cool = (1.0, 0.96, 0.9), (0.9, 0.96, 1.0)
    return tuple(sky + strip * cool[c] + soft_box * warm[c] for c in range(3))


def main():
    with open(sys.argv[1], "wb") as out:
        out.write(f"PF\n{WIDTH} {HEIGHT}\n-1.0\n".encode())
        for row in reversed(range(HEIGHT)):  # PFM stores the lowest row first
            elevation = 90 - 180 * (row + 0.5) / HEIGHT
            for column in range(WIDTH):
                azimuth = 360 * (column + 0.5) / WIDTH
                out.write(struct.pack("<3f", *radiance(azimuth, elevation)))


if __name__ == "__main__":
    main()
