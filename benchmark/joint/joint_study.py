"""Several recordings of one body, on truths of the independent simulator: two indentations of the same body by the same rig
are fitted together, and a third one is foretold. The rig's force sensor has one gain and one direction, wrong within their
tolerances, in all three. usage: joint_study.py ROOT --output FOLDER [--seeds N] [--estimate PROGRAM]"""
import argparse
import logging
import os
import sys

import numpy as np
import rosbag
from scipy.spatial.transform import Rotation

import meshes
import moving_study
import moving_truths as truths
from draw_folders import begin_draw, estimated, read_truth, write_model, write_truth
from rig_recordings import FAR_PRIOR, write_force
from study_arguments import study_arguments
from study_pages import judged_modulus

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
    if not begin_draw(folder):
        return
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
            noise = max(noise, write_force(bag, forces, truths.FPS, truths.FORCE_NOISE, rng))
    meshes.write_vtk(os.path.join(folder, 'mesh.vtk'), nodes, tets)
    model = moving_study.model_of(truth, 'indentation', truth.modulus * float(rng.choice(FAR_PRIOR)), noise)
    model['observations'][0]['reaction'].update({'gain': GAIN, 'bias': noise, 'rotation_tolerance': TURN})
    write_model(folder, model)
    write_truth(folder, {'modulus': truth.modulus, 'body': truth.body, 'gain': gain})


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
        truth = read_truth(folder)
        bags = ['%d.bag' % k for k in range(COURSES)]
        results = estimated(args.estimate, folder, bags=bags[:-1], options=['--predict', os.path.join(folder, bags[-1]), '--quiet'])
        alone = judged_modulus(results['recordings'][0]['alone'], truth['modulus'])
        both = judged_modulus(results, truth['modulus'])
        third = results['recordings'][-1]
        held.append(both['inside'])
        foretold.append(third['agreement']['passes'])
        cells = ['%+.1f %%, +-%.1f %%, %s' % (100 * e['error'], 100 * e['width'], 'holds' if e['inside'] else '**misses**')
                 for e in (alone, both)]
        print('| %d | %s | %+.1f %% | %s | %.2f | %.1f | %s |' % (
            seed, truth['body'], 100 * (truth['gain'] - 1), ' | '.join(cells), third['rms_sigma'], third['agreement']['z'],
            results['state']), flush=True)
    print('\n%d of %d intervals hold, %d of %d third recordings agree' % (sum(held), len(held), sum(foretold), len(foretold)))


if __name__ == '__main__':
    sys.exit(main())
