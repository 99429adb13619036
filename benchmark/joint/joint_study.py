"""Several recordings of one body, on truths of the independent simulator: two indentations of the same body by the same rig
are fitted together, and a third one is foretold. The rig's force sensor has one gain and one direction, wrong within their
tolerances, in all three. usage: joint_study.py ROOT --output FOLDER [--seeds N] [--estimate PROGRAM]"""
import argparse
import json
import logging
import os
import subprocess
import sys

import numpy as np
import rosbag
import yaml
from scipy.spatial.transform import Rotation

import meshes
import moving_study
import moving_truths as truths
from study_arguments import study_arguments

COURSES = 3        # the last one is foretold
GAIN = 0.05        # 1 sigma, of the rig's force sensor
TURN = 0.01        # rad, 1 sigma about each axis
BIAS = 0.01        # of the largest force, 1 sigma; drawn anew for each recording
LARGEST = 1.2      # of the depth of the first course


def courses(truth):
    """The motion of each recording: other depths, other rhythms, another slant."""
    motions = []
    for k in range(COURSES):
        along = np.zeros(3)
        along[truth.axis] = -1.0
        along += 0.15 * truth.rng.standard_normal(3)
        depth = truth.length * truth.rng.uniform(0.02, 0.05)
        times = np.array([0.05, 0.4, 0.6, 0.9, 1.2]) * np.array([1.0, 1.0 - 0.15 * k, 1.0, 1.0, 1.0])
        way = truths.smooth(list(times), depth * np.array([0, 1, 0.6 - 0.2 * k, LARGEST, 0.2]))
        motions.append(lambda t, way=way, along=along: (way(t) * along, np.zeros(3)))
    return motions


def recorded(args, seed, folder):
    """Makes the recordings and their model; what is there is kept."""
    if os.path.exists(os.path.join(folder, 'truth.json')):
        return
    os.makedirs(folder, exist_ok=True)
    sys.path.insert(0, args.simulator)
    logging.disable(logging.INFO)
    import simulate
    truth = truths.Truth('indentation', 100 + seed)
    sim, rng = truths.gripped_sim(simulate), truth.rng
    gain, turn = 1.0 + GAIN * rng.standard_normal(), Rotation.from_rotvec(TURN * rng.standard_normal(3))
    noise = 0.0
    for k, motion in enumerate(courses(truth)):
        truth.motion = motion
        nodes, tets, _, _, forces = truth.run(simulate, sim, truths.STEP)  # slow motions: the step does not matter
        forces = gain * turn.apply(forces) + BIAS * np.abs(forces).max() * rng.standard_normal(3)
        with rosbag.Bag(os.path.join(folder, '%d.bag' % k), 'w') as bag:
            moving_study.write_pose(bag, truth, rng)
            noise = max(noise, moving_study.write_force(bag, forces, rng))
    meshes.write_vtk(os.path.join(folder, 'mesh.vtk'), nodes, tets)
    model = moving_study.model_of(truth, 'indentation', truth.modulus * float(rng.choice(moving_study.FAR_PRIOR)), noise)
    model['observations'][0]['reaction'].update({'gain': GAIN, 'bias': noise, 'rotation_tolerance': TURN})
    with open(os.path.join(folder, 'model.yaml'), 'w') as file:
        yaml.safe_dump(model, file, default_flow_style=None, sort_keys=False)
    with open(os.path.join(folder, 'truth.json'), 'w') as file:
        json.dump({'modulus': truth.modulus, 'body': truth.body, 'gain': gain}, file)


def estimated(args, folder):
    out = os.path.join(folder, 'joint')
    bags = [os.path.join(folder, '%d.bag' % k) for k in range(COURSES)]
    run = subprocess.run([args.estimate, os.path.join(folder, 'model.yaml'), *bags[:-1], '--predict', bags[-1], '--output', out,
                          '--quiet'], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if run.returncode not in (0, 3):
        raise RuntimeError(run.stdout)
    with open(os.path.join(out, 'results.json')) as file:
        return json.load(file)


def judged(parameter, truth):
    low, high = parameter['interval95']
    return parameter['mean'] / truth - 1.0, low <= truth <= high, 0.5 * (high - low) / parameter['mean']


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seeds', type=int, default=8)
    args = study_arguments(parser, 'estimate', 'joint')
    print('| draw | body | gain of the sensor | E, first alone | E, both | third foretold [of '
          'its noise] | agreement, z | state |\n|---|---|---|---|---|---|---|---|')
    held, foretold = [], []
    for seed in range(args.seeds):
        folder = os.path.join(args.output, 'joint_%d' % seed)
        recorded(args, seed, folder)
        with open(os.path.join(folder, 'truth.json')) as file:
            truth = json.load(file)
        results = estimated(args, folder)
        name = 'elasticity.young_modulus'
        alone = judged(results['recordings'][0]['alone']['parameters'][name], truth['modulus'])
        both = judged(results['parameters'][name], truth['modulus'])
        third = results['recordings'][-1]
        held.append(both[1])
        foretold.append(third['agreement']['passes'])
        cells = ['%+.1f %%, +-%.1f %%, %s' % (100 * e, 100 * w, 'holds' if h else '**misses**') for e, h, w in (alone, both)]
        print('| %d | %s | %+.1f %% | %s | %.2f | %.1f | %s |' % (
            seed, truth['body'], 100 * (truth['gain'] - 1), ' | '.join(cells), third['rms_sigma'], third['agreement']['z'],
            results['state']), flush=True)
    print('\n%d of %d intervals hold, %d of %d third recordings agree' % (sum(held), len(held), sum(foretold), len(foretold)))


if __name__ == '__main__':
    sys.exit(main())
