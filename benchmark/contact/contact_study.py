"""A rigid ball touches a block, on truths of the independent simulator: is E right, and does its interval hold?
usage: contact_study.py ROOT --output FOLDER [--seeds N] [--estimate PROGRAM]"""
import argparse
import os
import sys
import time

import numpy as np
import rosbag
from geometry_msgs.msg import PoseStamped

import contact_truths as truths
import meshes
from draw_folders import begin_draw, estimated, read_truth, write_model, write_truth
from foreign import simulate_header
from rig_recordings import FAR_PRIOR, stamp, write_force
from study_arguments import study_arguments
from study_pages import judged_modulus, write_page

WANTED = 0.02
EDGE = 1e-6  # m


def write_bag(path, truth, forces, rng):
    with rosbag.Bag(path, 'w') as bag:
        for k, t in enumerate(np.arange(0.0, truth.end + 0.05, 1 / truths.POSE_RATE)):
            message = PoseStamped(header=simulate_header(k, stamp(t)))
            p, q = message.pose.position, message.pose.orientation
            p.x, p.y, p.z = np.array([*truth.center, truth.height(t)]) + truths.POSE_NOISE * rng.standard_normal(3)
            q.w = 1.0
            bag.write('/tool/pose', message, message.header.stamp)
        return write_force(bag, forces, truths.FPS, truths.FORCE_NOISE, rng)


def model_of(truth, prior, noise):
    size = truths.SIZE
    return {
        'mesh': {'file': 'mesh.vtk', 'boundary': 'faceted'},
        'regions': {'table': {'box': {'min': [-1, -1, -1], 'max': [1, 1, EDGE]}},
                    'top': {'box': {'min': [-1, -1, size[2] - EDGE], 'max': [1, 1, 1]}}},
        'effects': [
            {'inertia': {'density': truths.DENSITY}},
            {'elasticity': {'law': 'linear', 'young_modulus': {'prior': prior, 'factor': 3.0}, 'poisson_ratio': truths.POISSON}},
            {'fixed': {'region': 'table'}},
            {'viscous_damping': {'beta': truth.damping}},
            {'tool_contact': {'region': 'top', 'topic': '/tool/pose', 'center': [0, 0, truth.radius], 'radius': {'value': truth.radius, 'tolerance': 0.0},
                              'offset': {'value': 0.0, 'tolerance': 1e-5}}}],
        'observations': [{'reaction': {'topic': '/tool/wrench', 'region': 'top', 'noise': noise, 'gain': 0.005, 'bias': noise,
                                       'rotation_tolerance': 0.01}}]}


def recorded(args, seed, folder):
    """Makes the recording and the model; what is there is kept."""
    if not begin_draw(folder):
        return
    truth, nodes, tets, forces = truths.draw(args.simulator, seed)
    meshes.write_vtk(os.path.join(folder, 'mesh.vtk'), nodes, tets)
    noise = write_bag(os.path.join(folder, 'recording.bag'), truth, forces, truth.rng)
    prior = truth.modulus * float(truth.rng.choice(FAR_PRIOR))
    write_model(folder, model_of(truth, prior, noise))
    write_truth(folder, {'modulus': truth.modulus, 'radius': truth.radius, 'depth': 1.2 * truth.depth,
                         'force': float(np.abs(forces).max())})


def row_of(args, seed):
    folder = os.path.join(args.output, str(seed))
    recorded(args, seed, folder)
    truth = read_truth(folder)
    begun = time.monotonic()
    result = estimated(args.estimate, folder)
    seconds = time.monotonic() - begun
    return {**truth, 'seed': seed, 'seconds': seconds, **judged_modulus(result, truth['modulus'])}


PAGE = """# A tool that touches: how far E is off

`scripts/measure_contact` writes this page. The recordings come from an independent simulator (FEniCSx, other mesh, other integrator, other contact
law). `benchmark/contact/contact_truths.py` says what is simulated. [The method](method/contact.md) says what is estimated.

A rigid ball of 6 to 12 mm goes into a block of 50 x 50 x 25 mm that stands on a table, half out, and deeper in. A linear stage knows where the ball
is ({stage:.0f} um of noise), and a sensor measures the force on it ({force_noise:.0f} % of noise). The mesh has edges of {own:.0f} mm. The prior is off by a
factor of 0.4 to 2.5.

{converged} of {count} draws end `converged`. The median error of E is {median:.1f} %, the largest {largest:.1f} % (wanted: {wanted:.0f} %). The interval holds the
truth in {held} of {count}. A run takes {seconds:.0f} s in the median, on a machine that other programs used too.

| draw | E [kPa] | ball [mm] | depth [mm] | error | E's interval holds the truth | its half width | state |
|---|---|---|---|---|---|---|---|
{rows}
"""


def page(rows):
    errors = [100 * abs(r['error']) for r in rows]
    lines = ['| %d | %.1f | %.1f | %.1f | %+.1f %% | %s | %.1f %% | %s |' % (
        r['seed'], 1e-3 * r['modulus'], 1e3 * r['radius'], 1e3 * r['depth'], 100 * r['error'], 'yes' if r['inside'] else 'no', 100 * r['width'],
        r['state']) for r in rows]
    return PAGE.format(stage=1e6 * truths.POSE_NOISE, force_noise=100 * truths.FORCE_NOISE, own=1e3 * truths.OWN, count=len(rows),
                       converged=sum(r['state'] == 'converged' for r in rows), median=np.median(errors), largest=max(errors), wanted=100 * WANTED,
                       held=sum(r['inside'] for r in rows), seconds=np.median([r['seconds'] for r in rows]), rows='\n'.join(lines))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seeds', type=int, default=8)
    args = study_arguments(parser, 'estimate', 'contact')
    rows = []
    for seed in range(args.seeds):
        rows.append(row_of(args, seed))
        r = rows[-1]
        print('%d E %.1f kPa error %+.2f %% +- %.1f %% %s %s %.0f s' % (
            seed, 1e-3 * r['modulus'], 100 * r['error'], 100 * r['width'], 'inside' if r['inside'] else 'OUTSIDE', r['state'], r['seconds']), flush=True)
    write_page(args, 'contact.md', page(rows))


if __name__ == '__main__':
    sys.exit(main())
