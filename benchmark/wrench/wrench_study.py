"""A tool that presses on the end of a body, whose sensor tells force and torque, on truths of the independent simulator: is E
right, with the torque and without it? usage: wrench_study.py ROOT --output FOLDER [--seeds N] [--estimate PROGRAM]"""
import argparse
import os
import sys

import rosbag

import meshes
import wrench_truths as truths
from draw_folders import begin_draw, estimated, read_truth, write_model, write_truth
from moving_study import write_points
from rig_recordings import FAR_PRIOR, write_wrench
from study_arguments import study_arguments
from study_pages import judged_modulus, summary_row, write_page

CASES = ('force and torque', 'force alone')
WANTED = 0.03


def model_of(truth, case, prior, noise):
    force, torque = noise
    traction = {'region': 'tool', 'topic': '/tool/wrench', 'gain': 0.005, 'bias': force, 'noise': force, 'hysteresis': 0.0,
                'direction': 0.01}
    if case == 'force and torque':
        traction.update(torque_about=[float(x) for x in truth.sensor], torque_bias=torque, torque_noise=torque,
                        torque_hysteresis=0.0)
    elasticity = {'law': 'linear', 'young_modulus': {'prior': prior, 'factor': 3.0}, 'poisson_ratio': truths.POISSON}
    return {'mesh': {'file': 'mesh.vtk'}, 'regions': truth.regions,
            'effects': [{'inertia': {'density': truths.DENSITY}}, {'elasticity': elasticity}, {'fixed': {'region': 'clamp'}},
                        {'traction': traction}],
            'observations': [{'vertices': {'topic': '/tissue/vertices', 'noise': truths.POINT_NOISE}}]}


def recorded(args, seed, folder):
    """Makes the recording and the models; what is there is kept."""
    if not begin_draw(folder):
        return
    truth, nodes, tets, surface, positions, wrenches = truths.draw(args.simulator, seed)
    meshes.write_vtk(os.path.join(folder, 'mesh.vtk'), nodes, tets)
    with rosbag.Bag(os.path.join(folder, 'recording.bag'), 'w') as bag:
        noise = write_wrench(bag, wrenches, truths.FPS, truths.FORCE_NOISE, truth.rng)
        write_points(bag, positions, surface, truth.rng)
    prior = truth.modulus * float(truth.rng.choice(FAR_PRIOR))
    for case in CASES:
        write_model(folder, model_of(truth, case, prior, noise), case)
    write_truth(folder, {'modulus': truth.modulus, 'body': truth.body})


PAGE = """# A tool that measures force and torque: how far E is off

`scripts/measure_wrench` writes this page. The recordings come from an independent simulator (FEniCSx, other mesh, other integrator), in which a
tool presses on two small places on the end of a body, each at its own rate. The sensor is {height:.0f} mm above that end. The model knows no place, but
the wrench on the whole end: `traction` with `torque_about`, and without. Points come at {fps:.0f} Hz with {point_noise:.1f} mm of noise. Forces and
torques have {force_noise:.0f} % of noise. The prior is off by a factor of 0.4 to 2.5.

| case | draws | converged | median error of those | largest | wanted | intervals that hold, of all |
|---|---|---|---|---|---|---|
{table}

| case | draw | body | error | the interval holds the truth | its half width | state |
|---|---|---|---|---|---|---|
{draws}
"""


def page(rows):
    table, draws = [], []
    for case in CASES:
        own = [r for r in rows if r['case'] == case]
        table.append(summary_row(case, own, WANTED))
        draws += ['| %s | %d | %s | %+.1f %% | %s | %.1f %% | %s |' % (
            case, r['seed'], r['body'], 100 * r['error'], 'yes' if r['inside'] else 'no', 100 * r['width'], r['state'])
            for r in own]
    return PAGE.format(table='\n'.join(table), draws='\n'.join(draws), height=1e3 * truths.SENSOR_HEIGHT, fps=truths.FPS,
                       point_noise=1e3 * truths.POINT_NOISE, force_noise=100 * truths.FORCE_NOISE)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seeds', type=int, default=8)
    args = study_arguments(parser, 'estimate', 'wrench')
    rows = []
    for seed in range(args.seeds):
        folder = os.path.join(args.output, str(seed))
        recorded(args, seed, folder)
        truth = read_truth(folder)
        for case in CASES:
            result = estimated(args.estimate, folder, case)
            row = {'case': case, 'seed': seed, 'body': truth['body'], **judged_modulus(result, truth['modulus'])}
            rows.append(row)
            print('%-16s %d %-6s error %+6.2f %%  %-7s %s' % (
                case, seed, row['body'], 100 * row['error'], 'inside' if row['inside'] else 'OUTSIDE', row['state']),
                flush=True)
    write_page(args, 'wrench.md', page(rows))


if __name__ == '__main__':
    sys.exit(main())
