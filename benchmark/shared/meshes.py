"""Tetrahedral meshes of boxes, surfaces of revolution, and the files that they go into."""
import itertools

import numpy as np


def box(size, cells):
    """Nodes and tetrahedra of a box: six a cell, all around the cell's main diagonal (Kuhn's)."""
    def number(place):
        return place[0] + (cells[0] + 1) * (place[1] + (cells[1] + 1) * place[2])

    nodes = [tuple(size[d] * (i, j, k)[d] / cells[d] for d in range(3))
             for k in range(cells[2] + 1) for j in range(cells[1] + 1) for i in range(cells[0] + 1)]
    tets = []
    for cell in itertools.product(*map(range, cells)):
        for order in itertools.permutations(range(3)):
            place, tet = list(cell), [number(cell)]
            for axis in order:
                place[axis] += 1
                tet.append(number(place))
            inversions = sum(a > b for a, b in itertools.combinations(order, 2))
            tets.append(tet if inversions % 2 == 0 else [tet[0], tet[2], tet[1], tet[3]])
    return nodes, tets


def revolved(line, count):
    """The closed surface that a line of (radius, height) from the axis to the axis sweeps around z in `count` steps."""
    turn = 2 * np.pi * np.arange(count) / count
    rings = [np.stack([r * np.cos(turn), r * np.sin(turn), np.full(count, z)], axis=1) for r, z in line[1:-1]]
    points = np.concatenate([[[0, 0, line[0][1]]]] + rings + [[[0, 0, line[-1][1]]]])
    k, nxt, last = np.arange(count), (np.arange(count) + 1) % count, len(points) - 1
    triangles = [np.stack([np.zeros(count, int), 1 + nxt, 1 + k], axis=1)]
    for i in range(len(rings) - 1):
        a, b = 1 + i * count, 1 + (i + 1) * count
        triangles += [np.stack([a + k, a + nxt, b + k], axis=1), np.stack([a + nxt, b + nxt, b + k], axis=1)]
    a = 1 + (len(rings) - 1) * count
    triangles.append(np.stack([a + k, a + nxt, np.full(count, last)], axis=1))
    return points, np.concatenate(triangles)


def fill(gmsh, order):
    """Fills all volumes of gmsh's model with tetrahedra of this order. Returns gmsh, as the simulator's own mesher does."""
    gmsh.model.addPhysicalGroup(3, [tag for _, tag in gmsh.model.getEntities(3)], 1)
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.optimize('')
    if order == 2:
        gmsh.model.mesh.setOrder(2)
    return gmsh


def write_obj(path, points, triangles):
    with open(path, 'w') as file:
        file.writelines('v %.9g %.9g %.9g\n' % tuple(p) for p in points)
        file.writelines('f %d %d %d\n' % tuple(t + 1) for t in triangles)


def write_vtk(path, nodes, tets):
    """Legacy VTK, ASCII."""
    with open(path, 'w') as file:
        file.write('# vtk DataFile Version 3.0\nmesh\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS %d double\n' % len(nodes))
        file.writelines('%.9g %.9g %.9g\n' % tuple(node) for node in nodes)
        file.write('CELLS %d %d\n' % (len(tets), 5 * len(tets)))
        file.writelines('4 %d %d %d %d\n' % tuple(tet) for tet in tets)
        file.write('CELL_TYPES %d\n' % len(tets) + '10\n' * len(tets))
