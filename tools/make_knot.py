#!/usr/bin/env python3
"""Writes the demo's object: a trefoil knot of fluted rope, as a binary PLY with smooth normals.

The centre line is the (2,3) torus knot; its frame is transported in parallel along the line and untwisted so that it
closes, and the cross-section is a circle with flutes that wind around it. Usage: make_knot.py OUT.ply
"""
import math
import struct
import sys

SEGMENTS, SIDES = 720, 72          # along the line, around it
TUBE_RADIUS, FLUTE_DEPTH = 0.33, 0.05
FLUTES, TURNS = 6, 9               # flutes around the section, windings of each along the whole line


def add(a, b, scale=1.0):
    return tuple(x + scale * y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def normalized(a):
    length = math.sqrt(dot(a, a))
    return tuple(x / length for x in a)


def centre(t):
    radius = 1.0 + 0.45 * math.cos(3 * t)
    return (radius * math.cos(2 * t), radius * math.sin(2 * t), 0.62 * math.sin(3 * t))


def parallel_frames():
    """Points, tangents and normals along the line; the normals close after one turn."""
    ts = [2 * math.pi * i / SEGMENTS for i in range(SEGMENTS + 1)]
    points = [centre(t) for t in ts]
    tangents = [normalized(add(centre(t + 1e-4), centre(t - 1e-4), -1.0)) for t in ts]
    normal = normalized(cross(tangents[0], (0.0, 0.0, 1.0)))
    normals = []
    for tangent in tangents:
        normal = normalized(add(normal, tangent, -dot(normal, tangent)))
        normals.append(normal)
    # Spread the angle by which the transported normal misses the first one over the whole line.
    end, start, tangent = normals[-1], normals[0], tangents[-1]
    miss = math.atan2(dot(cross(end, start), tangent), dot(end, start))
    return points, tangents, normals, miss


def section_radius(angle, along):
    return TUBE_RADIUS + FLUTE_DEPTH * math.cos(FLUTES * angle + 2 * math.pi * TURNS * along)


def vertices():
    points, tangents, normals, miss = parallel_frames()
    rings = []
    for i in range(SEGMENTS):
        binormal = cross(tangents[i], normals[i])
        ring = []
        for j in range(SIDES):
            angle = 2 * math.pi * j / SIDES
            turned = angle + miss * i / SEGMENTS
            direction = add(tuple(math.cos(turned) * x for x in normals[i]), binormal, math.sin(turned))
            ring.append(add(points[i], direction, section_radius(angle, i / SEGMENTS)))
        rings.append(ring)
    return rings


def smooth_normal(rings, i, j):
    along = add(rings[(i + 1) % SEGMENTS][j], rings[i - 1][j], -1.0)
    around = add(rings[i][(j + 1) % SIDES], rings[i][j - 1], -1.0)
    return normalized(cross(around, along))


def main():
    rings = vertices()
    header = ("ply\nformat binary_little_endian 1.0\n"
              f"element vertex {SEGMENTS * SIDES}\n"
              + "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
              + f"element face {SEGMENTS * SIDES * 2}\nproperty list uchar int vertex_indices\nend_header\n")
    with open(sys.argv[1], "wb") as out:
        out.write(header.encode())
        for i in range(SEGMENTS):
            for j in range(SIDES):
                out.write(struct.pack("<6f", *rings[i][j], *smooth_normal(rings, i, j)))
        for i in range(SEGMENTS):
            for j in range(SIDES):
                a, b = i * SIDES + j, i * SIDES + (j + 1) % SIDES
                c, d = ((i + 1) % SEGMENTS) * SIDES + j, ((i + 1) % SEGMENTS) * SIDES + (j + 1) % SIDES
                out.write(struct.pack("<B3iB3i", 3, a, b, d, 3, a, d, c))


if __name__ == "__main__":
    main()
