"""Regions that follow a rigid body, on truths of the independent simulator: is E right, and does its interval hold?
usage: moving_study.py ROOT --output FOLDER [--seeds N] [--estimate PROGRAM] [--fresh]"""
import argparse
import os
import sys

import numpy as np
import rosbag
import sensor_msgs.point_cloud2 as point_cloud2
from geometry_msgs.msg import PoseStamped
from scipy.spatial.transform import Rotation
from sensor_msgs.msg import PointField

import meshes
import moving_truths as truths
from draw_folders import begin_draw, estimated, file_name, read_truth, write_model, write_truth
from foreign import simulate_header
from rig_recordings import FAR_PRIOR, stamp, write_force
from study_arguments import study_arguments
from study_pages import judged_modulus, write_page

WANTED = {'indentation': 0.02, 'retraction, force': 0.02, 'retraction, no force': 0.05, 'shaken base': 0.02}
TOOL_AT = np.array([0.2, -0.1, 0.15])  # the pose's own place: only its motion counts


def write_pose(bag, truth, rng):
    end = (truths.FRAMES - 1) / truths.FPS
    for k, t in enumerate(np.arange(0.0, end + 0.05, 1 / truths.POSE_RATE)):
        shift, turn = truth.motion(t)
        rotation = Rotation.from_rotvec(turn)
        message = PoseStamped(header=simulate_header(k, stamp(t)))
        p, q = message.pose.position, message.pose.orientation
        p.x, p.y, p.z = rotation.apply(TOOL_AT) + shift + truths.POSE_NOISE[truth.kind] * rng.standard_normal(3)
        q.x, q.y, q.z, q.w = rotation.as_quat()
        bag.write('/tool/pose', message, message.header.stamp)


def write_points(bag, positions, vertices, rng):
    fields = [PointField(axis, 4 * i, PointField.FLOAT32, 1) for i, axis in enumerate('xyz')]
    fields.append(PointField('vertex', 12, PointField.UINT32, 1))
    for k, points in enumerate(positions):
        header = simulate_header(k, stamp(k / truths.FPS))
        seen = points + truths.POINT_NOISE * rng.standard_normal(points.shape)
        rows = [(*map(float, p), int(v)) for p, v in zip(seen, vertices)]
        bag.write('/tissue/vertices', point_cloud2.create_cloud(header, fields, rows), header.stamp)


def model_of(truth, case, prior, noise):
    regions = dict(truth.regions)
    elasticity = {'law': 'linear', 'young_modulus': {'prior': prior, 'factor': 3.0}, 'poisson_ratio': truths.POISSON}
    effects = [{'inertia': {'density': truths.DENSITY}}, {'elasticity': elasticity}]
    observations = []
    if truth.ratio != 1.0:
        point, normal = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
        point[truth.axis], normal[truth.axis] = truth.middle, 1.0
        regions['foot'] = {'half_space': {'point': point, 'normal': normal}}
        regions['head'] = {'half_space': {'point': point, 'normal': [-x for x in normal]}}
        effects = [effects[0]] + [{'elasticity': dict(elasticity, region=name)} for name in ('foot', 'head')]
    if truth.kind == 'shaken base':
        effects.append({'moved': {'region': 'clamp', 'topic': '/tool/pose'}})
    else:
        effects += [{'fixed': {'region': 'clamp'}}, {'moved': {'region': 'tool', 'topic': '/tool/pose'}}]
    if truth.kind != 'indentation':
        observations.append({'vertices': {'topic': '/tissue/vertices', 'noise': truths.POINT_NOISE}})
    if case in ('indentation', 'retraction, force'):
        observations.append({'reaction': {'topic': '/tool/wrench', 'region': 'tool', 'noise': noise, 'gain': 0.005,
                                          'bias': noise, 'rotation_tolerance': 0.01}})
    return {'mesh': {'file': 'mesh.vtk'}, 'regions': regions, 'effects': effects, 'observations': observations}


def cases_of(kind):
    return ['retraction, no force', 'retraction, force'] if kind == 'retraction' else [kind]


def recorded(args, kind, seed, folder):
    """Makes the recording and the models; what is there is kept."""
    if not begin_draw(folder):
        return
    truth, nodes, tets, surface, positions, forces = truths.draw(args.simulator, kind, seed)
    rng = truth.rng
    meshes.write_vtk(os.path.join(folder, 'mesh.vtk'), nodes, tets)
    noise = 0.0
    with rosbag.Bag(os.path.join(folder, 'recording.bag'), 'w') as bag:
        write_pose(bag, truth, rng)
        if kind != 'shaken base':
            noise = write_force(bag, forces, truths.FPS, truths.FORCE_NOISE, rng)
        if kind != 'indentation':
            write_points(bag, positions, surface, rng)
    prior = truth.modulus * float(rng.choice(FAR_PRIOR))
    for case in cases_of(kind):
        write_model(folder, model_of(truth, case, prior, noise), case)
    write_truth(folder, {'modulus': truth.modulus, 'ratio': truth.ratio, 'body': truth.body,
                         'force': float(np.abs(forces).max())})


def judged(case, result, truth):
    moduli = {k: v for k, v in result['parameters'].items() if k.endswith('young_modulus')}
    first = moduli['elasticity.young_modulus']
    if case == 'retraction, no force':
        ratio = moduli['elasticity#2.young_modulus']['mean'] / first['mean']
        return ratio / truth['ratio'] - 1.0, None, None
    own = judged_modulus(result, truth['modulus'])
    return own['error'], own['inside'], own['width']


PAGE = """# Regions that follow a pose: how far E is off

`scripts/measure_moving` writes this page. The recordings come from an independent simulator (FEniCSx, other mesh, other integrator), in which its
own springs impose the motion. `benchmark/moving/moving_truths.py` says what is simulated. [The method](method/moved.md) says what is estimated.

An indentation knows the pose of a punch that sticks to the tissue, and the force on it. A retraction knows the pose of a jaw and tracked points,
with and without the force. Its body has two halves of different moduli. A shaken base knows the pose of the base and tracked points. Poses come at
{pose_rate:.0f} Hz, with {stage:.0f} um of noise for the punch (a linear stage) and {arm:.0f} um for jaw and base (an arm). Points come at {fps:.0f} Hz with
{point_noise:.1f} mm of noise. Forces have {force_noise:.0f} % of noise. The prior is off by a factor of 0.4 to 2.5.

| case | draws | converged | median error of those | largest | wanted | intervals that hold, of all |
|---|---|---|---|---|---|---|
{table}

The error of a retraction without a force is that of the ratio of both moduli. The other errors are those of E.

| case | draw | body | error | E's interval holds the truth | its half width | `identifiable` | state |
|---|---|---|---|---|---|---|---|
{draws}
"""


def page(rows):
    table, draws = [], []
    for case, wanted in WANTED.items():
        own = [r for r in rows if r['case'] == case]
        told = [abs(r['error']) for r in own if r['state'] == 'converged' or r['inside'] is None]
        held = [r['inside'] for r in own if r['inside'] is not None]
        table.append('| %s | %d | %s | %s | %s | %.0f %% | %s |' % (
            case, len(own), '%d' % len(told) if held else '-', '%.1f %%' % (100 * np.median(told)) if told else '-',
            '%.1f %%' % (100 * max(told)) if told else '-', 100 * wanted,
            '%d of %d' % (sum(held), len(held)) if held else '-'))
        draws += ['| %s | %d | %s | %+.1f %% | %s | %s | %s | %s |' % (
            r['case'], r['seed'], r['body'], 100 * r['error'], {True: 'yes', False: 'no', None: '-'}[r['inside']],
            '%.0f %%' % (100 * r['width']) if r['width'] else '-', r['verdict'], r['state']) for r in own]
    return PAGE.format(table='\n'.join(table), draws='\n'.join(draws), pose_rate=truths.POSE_RATE, fps=truths.FPS,
                       stage=1e6 * truths.POSE_NOISE['indentation'], arm=1e6 * truths.POSE_NOISE['retraction'], point_noise=1e3 * truths.POINT_NOISE,
                       force_noise=100 * truths.FORCE_NOISE)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seeds', type=int, default=8)
    parser.add_argument('--fresh', action='store_true')
    args = study_arguments(parser, 'estimate', 'moving')
    rows = []
    for kind in truths.KINDS:
        for seed in range(args.seeds):
            folder = os.path.join(args.output, '%s_%d' % (file_name(kind), seed))
            recorded(args, kind, seed, folder)
            truth = read_truth(folder)
            for case in cases_of(kind):
                result = estimated(args.estimate, folder, case)
                error, inside, width = judged(case, result, truth)
                verdict = result['identifiable']['elasticity.young_modulus']['verdict']
                state = result.get('state', '')
                rows.append({'case': case, 'seed': seed, 'body': truth['body'], 'error': error, 'inside': inside,
                             'width': width, 'verdict': verdict, 'state': state})
                print('%-22s %d %-6s error %+6.2f %%  %-7s %-10s %s' % (
                    case, seed, truth['body'], 100 * error, {True: 'inside', False: 'OUTSIDE', None: ''}[inside], verdict,
                    state), flush=True)
    write_page(args, 'moving.md', page(rows))


if __name__ == '__main__':
    sys.exit(main())
