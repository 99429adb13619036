"""A cylinder along x in layers of tetrahedra, for moduli that change from slice to slice."""
import math

import numpy as np


def disk(radius, rings):
    """Points of a disk: the centre, then 6, 12, ... on rings; and its triangles."""
    points, triangles, start = [(0.0, 0.0)], [], [0]
    for ring in range(1, rings + 1):
        start.append(len(points))
        for k in range(6 * ring):
            angle = 2 * math.pi * k / (6 * ring)
            points.append((radius * ring / rings * math.cos(angle), radius * ring / rings * math.sin(angle)))
    for ring in range(1, rings + 1):
        inner, outer = max(6 * (ring - 1), 1), 6 * ring
        for side in range(6):
            for k in range(ring):
                a = start[ring] + (side * ring + k) % outer
                b = start[ring] + (side * ring + k + 1) % outer
                c = start[ring - 1] + (side * (ring - 1) + k) % inner
                triangles.append((a, b, c))
                if k + 1 < ring:
                    triangles.append((b, start[ring - 1] + (side * (ring - 1) + k + 1) % inner, c))
    return np.array(points), triangles


def cylinder(radius, length, layers, rings):
    """Nodes (n x 3), tetrahedra (m x 4), and the nodes of the line at the top of each layer."""
    plane, triangles = disk(radius, rings)
    count = len(plane)
    nodes = np.array([(length * layer / layers, y, z) for layer in range(layers + 1) for y, z in plane])
    tets = []
    for layer in range(layers):
        for triangle in triangles:
            low = sorted(layer * count + i for i in triangle)  # one order everywhere: neighbours share diagonals
            high = [i + count for i in low]
            for tet in ((low[0], low[1], low[2], high[2]), (low[0], low[1], high[1], high[2]), (low[0],) + tuple(high)):
                a, b, c, d = (nodes[i] for i in tet)
                tets.append(tet if np.dot(np.cross(b - a, c - a), d - a) > 0 else (tet[0], tet[2], tet[1], tet[3]))
    top = max(range(count), key=lambda i: plane[i][1])
    return nodes, np.array(tets), [layer * count + top for layer in range(layers + 1)]


def volume(nodes, tets):
    a, b, c, d = (nodes[tets[:, i]] for i in range(4))
    return float(np.einsum('ij,ij->i', np.cross(b - a, c - a), d - a).sum()) / 6
