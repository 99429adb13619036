"""A real heart's muscle below the valves, from the surfaces that biv-me fitted to cine MRI: one closed surface, cut flat."""
import os

import numpy as np
import vtk
from scipy.spatial import cKDTree
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

NAMES = {'wall': 'EPICARDIAL', 'left': 'LV_ENDOCARDIAL', 'right': 'RV_ENDOCARDIAL'}
MARGIN = 4.0  # mm below the lowest point of a valve's rim
WELD = 1e-3  # mm
FLAT = 0.1  # mm: the cut's points move so little when the surface is thinned


def load(path):
    vertices, triangles = [], []
    with open(path) as file:
        for line in file:
            words = line.split()
            if words[:1] == ['v']:
                vertices.append([float(word) for word in words[1:4]])
            elif words[:1] == ['f']:
                triangles.append([int(word.split('/')[0]) - 1 for word in words[1:4]])
    return np.array(vertices), np.array(triangles)


def rim(triangles):
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    here = {tuple(edge) for edge in edges}
    return sorted({a for a, b in here if (b, a) not in here})


def to_vtk(vertices, triangles):
    data, points, cells = vtk.vtkPolyData(), vtk.vtkPoints(), vtk.vtkCellArray()
    points.SetDataType(vtk.VTK_DOUBLE)
    points.SetData(numpy_to_vtk(np.ascontiguousarray(vertices, dtype=float), deep=True))
    rows = np.hstack([np.full((len(triangles), 1), 3), triangles]).astype(np.int64)
    cells.SetCells(len(triangles), numpy_to_vtkIdTypeArray(rows.ravel(), deep=True))
    data.SetPoints(points)
    data.SetPolys(cells)
    return data


def passed(data, *filters):
    for step in filters:
        step.SetInputData(data)
        step.Update()
        data = step.GetOutput()
    return data


def cleaner(tolerance):
    clean = vtk.vtkCleanPolyData()
    clean.ToleranceIsAbsoluteOn()
    clean.SetAbsoluteTolerance(tolerance)
    return clean


def cut(data, height):
    plane = vtk.vtkPlane()
    plane.SetOrigin(0, 0, height)
    plane.SetNormal(0, 0, -1)
    planes = vtk.vtkPlaneCollection()
    planes.AddItem(plane)
    clip = vtk.vtkClipClosedSurface()
    clip.SetClippingPlanes(planes)
    return passed(data, clip, cleaner(0.3), vtk.vtkTriangleFilter())


def thinned(data, triangles):
    thin = vtk.vtkQuadricDecimation()
    thin.SetTargetReduction(max(0.0, 1.0 - triangles / data.GetNumberOfPolys()))
    return passed(data, thin, cleaner(1e-3), vtk.vtkTriangleFilter())


def oriented():
    turn = vtk.vtkPolyDataNormals()
    turn.ConsistencyOn()
    turn.AutoOrientNormalsOn()
    turn.SplittingOff()
    return turn


def upright(folder, phase):
    """The surfaces with the valves above, the left ventricle's long axis along z, and 0 just below the valves' rims [mm]."""
    parts = {name: load(os.path.join(folder, 'surfaces', 'patient1_%s_%03d.obj' % (kind, phase)))
             for name, kind in NAMES.items()}
    left, wall = parts['left'], parts['wall']
    top = left[0][rim(left[1])].mean(axis=0)
    apex = left[0][np.argmax(np.linalg.norm(left[0] - top, axis=1))]
    z = (top - apex) / np.linalg.norm(top - apex)
    x = np.cross([0.0, 1.0, 0.0], z)
    x /= np.linalg.norm(x)
    turn = np.stack([x, np.cross(z, x), z], axis=1)
    height = ((wall[0][rim(wall[1])] - top) @ turn)[:, 2].min() - MARGIN
    return {name: ((points - top) @ turn - [0.0, 0.0, height], triangles) for name, (points, triangles) in parts.items()}


def arrays(data):
    return vtk_to_numpy(data.GetPoints().GetData()), vtk_to_numpy(data.GetPolys().GetData()).reshape(-1, 4)[:, 1:]


def real_heart(folder, count, phase=0):
    """As biventricle(): about `count` triangles. Epicardium and both endocardia share the valves' rims, so that together
    they are the wall's closed surface; what lies above the rims is cut off."""
    parts = upright(folder, phase)
    starts = np.cumsum([0] + [len(points) for points, _ in parts.values()])
    everything = to_vtk(np.concatenate([points for points, _ in parts.values()]),
                        np.concatenate([t + start for (_, t), start in zip(parts.values(), starts)]))
    body = thinned(cut(passed(everything, cleaner(WELD), oriented()), 0.0), count)
    points, triangles = arrays(body)
    points[np.abs(points[:, 2]) < FLAT, 2] = 0.0
    number = np.concatenate([np.full(len(p), i) for i, (p, _) in enumerate(parts.values())])
    centres = points[triangles].mean(axis=1)
    owner = number[cKDTree(np.concatenate([p for p, _ in parts.values()])).query(centres)[1]]
    on_side = centres[:, 2] < -FLAT
    cavities = {name: triangles[(owner == i) & on_side] for i, name in enumerate(parts) if name != 'wall'}
    return 1e-3 * points, triangles, cavities
