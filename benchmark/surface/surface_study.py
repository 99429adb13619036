"""Models whose mesh is thicker or thinner than the body, on truths of the independent simulator: does E's interval hold the
truth, with the surface's tolerance stated and without it? usage: surface_study.py ROOT --output FOLDER [--estimate PROGRAM]"""
import argparse
import os
import sys

import meshio
import numpy as np

import foreign_draws
import meshes
from draw_folders import begin_draw, estimated, read_truth, write_model, write_truth
from study_arguments import study_arguments
from study_pages import judged_modulus, write_page

TOLERANCE = 0.03  # of the body's thickness, twice its volume over its surface
OFF = (-2.0, -1.0, 1.0, 2.0)  # tolerances by which the model's surface is further out
CASES = ('stated', 'not stated')
FLAT = 0.02       # share of the largest eigenvalue, below which facets around a corner stand for one surface
FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))

PAGE = """# A mesh that is too thick or too thin: does E's interval tell?

`scripts/measure_surface` writes this page. The recordings come from an independent simulator (FEniCSx, other mesh, other integrator). The model's
surface is moved along its normals. The tolerance is {tolerance:.0f} % of the body's thickness, which is twice its volume over its surface.
`mesh.surface_tolerance` states it, or not. Points come with the usual noise. The loads are exact, and tolerated as usual.

The other tolerances, of the density for example, are the default ones. They make most of these intervals, so many hold the truth of a mesh that is off
without being told. Where they are stated more narrowly, the surface is what is left (`InputStudy.HoldsTheTruthOfABodyWhoseSurfaceIsOff`).

| `surface_tolerance` | surface further out by | draws | median of E over truth | intervals that hold the truth | `converged` beside it |
|---|---|---|---|---|---|
{table}

| body | surface further out by | E over truth, stated | not stated |
|---|---|---|---|
{draws}
"""


def volumes(points, tets):
    corners = points[tets]
    return np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6.0


def with_positive_volumes(points, tets):
    return np.where(volumes(points, tets)[:, None] > 0.0, tets, tets[:, [0, 2, 1, 3]])


def surface(tets):
    """The faces that only one tetrahedron has, with their corners in its order."""
    faces = np.concatenate([tets[:, face] for face in FACES])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[first[count == 1]]


def areas(points, facets):
    a, b, c = (points[facets[:, i]] for i in range(3))
    return 0.5 * np.cross(b - a, c - a)


def outward_moves(points, facets):
    """The move of each corner that takes every facet around it one unit outward, as closely as one move can."""
    area = areas(points, facets)
    square, total = np.zeros((len(points), 3, 3)), np.zeros((len(points), 3))
    for i in range(3):
        np.add.at(square, facets[:, i], area[:, :, None] * area[:, None, :] / np.linalg.norm(area, axis=1)[:, None, None])
        np.add.at(total, facets[:, i], area)
    return np.einsum('nij,nj->ni', np.linalg.pinv(square, rcond=FLAT, hermitian=True), total)


def inside(points, shape):
    """The numbers of the points in a region of a model file."""
    if 'box' in shape:
        box = shape['box']
        return np.flatnonzero(((points >= box['min']) & (points <= box['max'])).all(axis=1))
    kind, = shape
    radii = shape[kind]['radius' if kind == 'sphere' else 'radii']
    return np.flatnonzero(np.linalg.norm((points - shape[kind]['center']) / radii, axis=1) <= 1.0)


def recorded(args, draw, off, folder):
    """Writes the recording, and the models with the moved mesh. What is there is kept."""
    if not begin_draw(folder):
        return
    rng = np.random.default_rng(9000 + draw['number'])
    truth, model, recording = foreign_draws.read_truth(os.path.join(args.truths, draw['truth']))
    noise = foreign_draws.observe('stated', truth, recording, rng)
    mesh = meshio.read(model['mesh']['file'])
    points, tets = mesh.points, with_positive_volumes(mesh.points, mesh.cells_dict['tetra'])
    facets = surface(tets)
    area = np.linalg.norm(areas(points, facets), axis=1).sum()
    tolerance = TOLERANCE * 2.0 * volumes(points, tets).sum() / area
    moves = off * tolerance * outward_moves(points, facets)
    meshes.write_vtk(os.path.join(folder, 'mesh.vtk'), points + moves, tets)
    recording['positions'] = recording['positions'] + moves[recording['vertices']]  # they are seen on the model's surface
    foreign_draws.write_bag(os.path.join(folder, 'recording.bag'), recording)
    model['regions'] = {name: {'vertices': [int(i) for i in inside(points, shape)]} for name, shape in model['regions'].items()}
    foreign_draws.state_prior_and_noise(model, truth, noise, rng)
    for case in CASES:
        model['mesh'] = {'file': 'mesh.vtk', **({'surface_tolerance': float(tolerance)} if case == 'stated' else {})}
        write_model(folder, model, case)
    write_truth(folder, {'modulus': float(truth['young_modulus'][0]), 'tolerance': float(tolerance)})


def page(rows):
    table, draws = [], []
    for case in CASES:
        for off in OFF:
            own = [r for r in rows if r['off'] == off and r['case'] == case]
            table.append('| %s | %+.0f tolerances | %d | %.3f | %d of %d | %d |' % (
                case, off, len(own), np.median([1.0 + r['error'] for r in own]), sum(r['inside'] for r in own), len(own),
                sum(not r['inside'] and r['state'] == 'converged' for r in own)))
    for stated, other in zip(rows[::2], rows[1::2]):
        draws.append('| %s | %+.2f mm | %s | %s |' % (stated['body'], 1e3 * stated['off'] * stated['tolerance'], *(
            '%.3f +- %.3f, %s%s' % (1.0 + r['error'], r['width'], r['state'], '' if r['inside'] else ', beside')
            for r in (stated, other))))
    return PAGE.format(tolerance=100 * TOLERANCE, table='\n'.join(table), draws='\n'.join(draws))


def main():
    args = study_arguments(argparse.ArgumentParser(description=__doc__), 'estimate', 'surface')
    args.truths = os.path.join(args.root, 'output', 'hidden_effects', 'truths')
    clean = {draw['truth']: draw for draw in reversed(foreign_draws.draw_list()) if draw['class'] == 'clean'}
    rows = []
    for name in sorted(clean):
        for off in OFF:
            folder = os.path.join(args.output, '%s %+g' % (name, off))
            recorded(args, clean[name], off, folder)
            truth = read_truth(folder)
            for case in CASES:
                judged = judged_modulus(estimated(args.estimate, folder, case), truth['modulus'])
                rows.append({'body': name, 'off': off, 'case': case, 'tolerance': truth['tolerance'], **judged})
                print('%-14s %+g %-10s error %+6.1f %% +- %.1f %% %-7s %s' % (
                    name, off, case, 100 * judged['error'], 100 * judged['width'],
                    'inside' if judged['inside'] else 'OUTSIDE', judged['state']), flush=True)
    write_page(args, 'surface.md', page(rows))


if __name__ == '__main__':
    sys.exit(main())
