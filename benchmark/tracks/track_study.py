"""Features that an endoscope's camera sees, on truths of the independent simulator: is E right, and does its interval hold?
usage: track_study.py ROOT --output FOLDER [--seeds N] [--estimate PROGRAM] [--draw-only]"""
import argparse
import multiprocessing
import os
import sys

import rosbag

import meshes
import moving_truths as truths
import track_film
from draw_folders import begin_draw, estimated, file_name, read_truth, write_model, write_truth
from moving_study import write_pose
from rig_recordings import FAR_PRIOR, write_force
from study_arguments import study_arguments
from study_pages import judged_modulus, summary_row, write_page

WANTED = 0.02
VIEWS = ('iso', 'top', 'iso', 'side')
CASES = {'retraction': 'a grasp pulls, with its force', 'shaken base': 'the base shakes'}
NOISE = 2e-5  # m, at least: the tracker states its own


def model_of(truth, prior, force_noise):
    elasticity = {'law': 'linear', 'young_modulus': {'prior': prior, 'factor': 3.0}, 'poisson_ratio': truths.POISSON}
    effects = [{'inertia': {'density': truths.DENSITY}}, {'elasticity': elasticity}]
    observations = [{'tracks': {'image': '/endoscope/image_raw', 'camera_info': '/endoscope/camera_info', 'noise': NOISE}}]
    if truth.kind == 'shaken base':
        effects.append({'moved': {'region': 'clamp', 'topic': '/tool/pose'}})
    else:
        effects += [{'fixed': {'region': 'clamp'}}, {'moved': {'region': 'tool', 'topic': '/tool/pose'}}]
        observations.append({'reaction': {'topic': '/tool/wrench', 'region': 'tool', 'noise': force_noise, 'gain': 0.005,
                                          'bias': force_noise, 'rotation_tolerance': 0.01}})
    return {'mesh': {'file': 'mesh.vtk'}, 'regions': truth.regions, 'effects': effects, 'observations': observations}


def recorded(args, kind, seed, folder):
    """Makes the film, the recording and the model; what is there is kept."""
    if not begin_draw(folder):
        return
    truth, nodes, tets, _, _, forces = truths.draw(args.simulator, kind, seed, one_modulus=True)
    import render  # beside the simulator
    import simulate
    meshes.write_vtk(os.path.join(folder, 'mesh.vtk'), nodes, tets)
    track_film.draw(render, truth, truth.config(simulate, truths.STEP), VIEWS[seed % len(VIEWS)], seed + 1, folder)
    force_noise = 0.0
    with rosbag.Bag(os.path.join(folder, 'recording.bag'), 'w') as bag:
        track_film.write(bag, folder)
        write_pose(bag, truth, truth.rng)
        if kind != 'shaken base':
            force_noise = write_force(bag, forces, truths.FPS, truths.FORCE_NOISE, truth.rng)
    prior = truth.modulus * float(truth.rng.choice(FAR_PRIOR))
    write_model(folder, model_of(truth, prior, force_noise))
    write_truth(folder, {'modulus': truth.modulus, 'body': truth.body, 'view': VIEWS[seed % len(VIEWS)]})


PAGE = """# Features in a film: how far E is off

`scripts/measure_tracks` writes this page. The truths come from an independent simulator (FEniCSx, other mesh, other integrator), and its renderer draws
the films. They have {width} x {height} pixels at {fps:.0f} Hz, from {distance:.2f} m. The pixels have {noise:.0f} grey values of noise, the surface has highlights, and its shade
changes as it turns. [What the sensor may be](sensors.md#features-of-a-surface) says how features are followed.

A retraction knows the pose of a jaw and the force on it, and a shaken base the pose of the base. Nothing else is known of the body's motion than the
film. The prior is off by a factor of 0.4 to 2.5.

| case | draws | converged | median error of those | largest | wanted | intervals that hold, of all |
|---|---|---|---|---|---|---|
{table}

| case | draw | body | view | error | the interval holds the truth | its half width | state |
|---|---|---|---|---|---|---|---|
{draws}
"""


def page(rows):
    table, draws = [], []
    for kind, name in CASES.items():
        own = [r for r in rows if r['kind'] == kind]
        if not own:
            continue
        table.append(summary_row(name, own, WANTED))
        draws += ['| %s | %d | %s | %s | %+.1f %% | %s | %.1f %% | %s |' % (
            name, r['seed'], r['body'], r['view'], 100 * r['error'], 'yes' if r['inside'] else 'no', 100 * r['width'], r['state'])
            for r in own]
    return PAGE.format(width=track_film.SIZE[0], height=track_film.SIZE[1], fps=truths.FPS, distance=track_film.DISTANCE,
                       noise=track_film.NOISE, table='\n'.join(table), draws='\n'.join(draws))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seeds', type=int, default=8)
    parser.add_argument('--only', type=int, help='this seed alone, and no page')
    parser.add_argument('--draw-only', action='store_true')
    args = study_arguments(parser, 'estimate', 'tracks')
    rows = []
    for kind in CASES:
        for seed in range(args.seeds) if args.only is None else [args.only]:
            folder = os.path.join(args.output, '%s_%d' % (file_name(kind), seed))
            make = multiprocessing.Process(target=recorded, args=(args, kind, seed, folder))  # whose memory ends with it
            make.start()
            make.join()
            if make.exitcode != 0:
                raise RuntimeError('%s %d cannot be simulated' % (kind, seed))
            if args.draw_only:
                continue
            truth = read_truth(folder)
            result = estimated(args.estimate, folder)
            row = {'kind': kind, 'seed': seed, 'body': truth['body'], 'view': truth['view'], **judged_modulus(result, truth['modulus'])}
            rows.append(row)
            print('%-12s %d %-6s %-5s error %+6.2f %%  %-7s +-%.1f %%  %s' % (
                kind, seed, row['body'], row['view'], 100 * row['error'], 'inside' if row['inside'] else 'OUTSIDE', 100 * row['width'],
                row['state']), flush=True)
    if args.draw_only or args.only is not None:
        return
    write_page(args, 'tracks.md', page(rows))


if __name__ == '__main__':
    sys.exit(main())
