"""Diagnoses of large motions against FEniCSx: what is missing beside neo-Hookean elasticity, when a body swings by a quarter
of its length?

The bodies and the integrator are those of ../shared/simulator. Each recording hides one effect, or none. `diagnose --auto`
gets a model without it: vertices of a coarser mesh, with noise, and the force. Prints the table of
doc/method/finite_strain.md. Other laws are hidden by foreign_laws.py, in bars that are bent in steps.
"""
import json
import logging
import os
import subprocess
import sys

import numpy as np

MODULUS, POISSON_RATIO, DENSITY = 20e3, 0.45, 1060.0
RATE, FRAMES = 30.0, 40
STEP = 0.002   # [s]
LIMIT = 300    # [s], of a diagnosis
NOISE = 2e-4   # [m]
FAR, SPREAD = 10.0, 1e-4  # [m], of a ball that cuts the end off, and of its window's edge
BODIES = {     # lengths of the simulator's bar [m], the force on its end [N] and where it points
    'slender': ((0.10, 0.02, 0.02), 0.024, (0.3, 0.8, 0.6)),
    'stout': ((0.06, 0.03, 0.02), 0.10, (-0.2, 0.3, 1.0)),
    'flat': ((0.09, 0.04, 0.015), 0.025, (0.1, 0.4, -1.0)),
}
HIDDEN = {     # the tool's name: what the simulator is told
    'nothing': {},
    'gravity': {'gravity': {'g': 0.6, 'direction': [0.5, 0.6, -0.62]}},
    'viscous_damping': {'damping': {'kelvin_voigt': 0.012}},
    'mass_damping': {'damping': {'mass': 1.2}},
    'viscoelasticity': {'viscoelastic': {'gamma': 0.4, 'tau': 0.15}},
    'stiff_inclusion': {'inclusions': [{'center': [0.03, 0.003, -0.002], 'radius': 0.012, 'ratio': 6.0}]},
    'fibre_reinforcement': {'fibres': {'direction': [0.8, 0.0, 0.6], 'stiffness': 12e3}},
    'strain_stiffening': {'material': {'model': 'fung', 'fung_b': 6.0}},
}
COURSES = [
    {'type': 'table', 't': [0, 0.35, 0.45, 0.5], 'v': [0, 1, 1, 0]},
    {'type': 'sum', 'terms': [{'type': 'ramp', 't0': 0.05, 't1': 0.4, 'v0': 0, 'v1': 0.8},
                              {'type': 'sine', 'amp': 0.4, 'freq': 2.2, 'soft': 0.3}]},
]


def scenes():
    """(name, body, hidden effect, number of the course): every effect in two bodies."""
    bodies = list(BODIES)
    for k, effect in enumerate(HIDDEN):
        for i in range(2):
            body = bodies[(k + i) % len(bodies)]
            yield '%s_%s' % (effect, body), body, effect, (k + i) % len(COURSES)


def config_of(simulate, body, effect, course):
    (length, width, height), force, direction = BODIES[body]
    size = force / (width * height)
    out = simulate.copy.deepcopy(simulate.DEFAULTS)
    scaled = json.loads(json.dumps(COURSES[course]))
    for part in scaled.get('terms', [scaled]):
        for key in ('v0', 'v1', 'amp'):
            if key in part:
                part[key] *= size
        if 'v' in part:
            part['v'] = [size * v for v in part['v']]
    simulate.deep_update(out, {
        'body': {'type': 'bar', 'L': length, 'W': width, 'H': height, 'h': 0.008, 'h_obs': 0.012},
        'material': {'model': 'neo_hookean', 'E': MODULUS, 'nu': POISSON_RATIO, 'rho': DENSITY},
        'patch': {'center': [length + FAR, 0.0, 0.0], 'radius': float(np.hypot(FAR, np.hypot(width, height) / 2) + SPREAD),
                  'edge': SPREAD, 'direction': list(direction), 'course': scaled}})
    simulate.deep_update(out, HIDDEN[effect])
    return out


def write_recording(folder, root, simulate, name, body, effect, course):
    sys.path.insert(0, os.path.join(root, 'benchmark', 'hidden_effects'))
    import foreign_bodies
    config = config_of(simulate, body, effect, course)
    length = BODIES[body][0][0]
    direction = np.array(BODIES[body][2]) / np.linalg.norm(BODIES[body][2])
    config['patch']['direction'] = [float(x) for x in direction]
    nodes, tets = simulate.linear_mesh(config, config['body']['h_obs'])
    simulate.write_vtk_tets(os.path.join(folder, 'mesh.vtk'), nodes, tets)
    surface = np.unique(simulate.surf_linear(nodes, tets))
    run = foreign_bodies.extend(simulate)(config, {'name': 'bar'})
    to_nodes, _ = simulate.p2_interp_matrix(run.X, run.cells, nodes[surface])
    run.init_accel()
    steps = int(np.ceil(1.0 / RATE / STEP))
    random = np.random.default_rng([ord(c) for c in name])
    most = 0.0
    with open(os.path.join(folder, 'points.csv'), 'w') as out:
        for k in range(FRAMES):
            for _ in range(steps if k else 0):
                run.step(1.0 / RATE / steps)
            run.t = k / RATE
            moved = to_nodes @ run.u.x.array.reshape(-1, 3)
            most = max(most, np.abs(moved).max())
            seen = nodes[surface] + moved + NOISE * random.standard_normal(moved.shape)
            for vertex, x in zip(surface, seen):
                out.write('%.9g,%d,%.9g,%.9g,%.9g\n' % (k / RATE, vertex, *x))
    course = simulate.course(config['patch']['course'])
    with open(os.path.join(folder, 'force.csv'), 'w') as out:
        for t in np.arange(0.0, FRAMES / RATE, 2e-3):
            out.write('%.9g,%.9g,%.9g,%.9g\n' % (t, *(run.patch_area * course(t) * direction)))
    with open(os.path.join(folder, 'model.yaml'), 'w') as out:
        out.write('\n'.join([
            'mesh: {file: mesh.vtk}', 'regions:',
            '  clamp: {box: {min: [-1, -1, -1], max: [1.0e-6, 1, 1]}}',
            '  end: {box: {min: [%.9g, -1, -1], max: [1, 1, 1]}}' % (length - 1e-6),
            'effects:', '  - inertia: {density: %g}' % DENSITY,
            '  - elasticity: {law: neo_hookean, poisson_ratio: %g, young_modulus: {prior: 30e3, factor: 2}}' % POISSON_RATIO,
            '  - fixed: {region: clamp}', '  - traction: {region: end, topic: /tool/wrench}',
            'observations:', '  - vertices: {topic: /tissue/vertices, noise: %g}' % NOISE, '']))
    with open(os.path.join(folder, 'most.json'), 'w') as out:  # last: it says that the rest is there
        json.dump(most / length, out)


def diagnose(programs, folder):
    """The result; None where it did not end in time."""
    model, bag, output = (os.path.join(folder, name) for name in ('model.yaml', 'recording.bag', 'diagnosis'))
    subprocess.run([os.path.join(programs, 'pack'), model, '--data', '/tissue/vertices=' + os.path.join(folder, 'points.csv'),
                    '/tool/wrench=' + os.path.join(folder, 'force.csv'), '--output', bag], check=True, stdout=subprocess.DEVNULL)
    done = subprocess.run([os.path.join(programs, 'diagnose'), model, bag, '--auto', '--quiet', '--time-limit', str(LIMIT),
                           '--output', output], capture_output=True, text=True)
    if done.returncode not in (0, 3, 75):
        raise RuntimeError(done.stderr)
    return json.load(open(os.path.join(output, 'diagnosis.json')))


def row(name, most, result):
    final = result['final']
    e = final.get('parameters', {}).get('elasticity.young_modulus')
    off = '%+.1f %% (%+.1f to %+.1f)' % tuple(100 * (v / MODULUS - 1) for v in (e['mean'], *e['interval95'])) if e else ''
    return '| %s | %.0f %% | %s | %s | %s | %s | %.0f |' % (
        name, 100 * most, result['verdict'], ', '.join(result['set']), final['verdict'], off, result['seconds'])


def main(root, output, programs, *wanted):
    sys.path.insert(0, os.path.join(root, '..', 'shared', 'simulator'))
    import simulate
    logging.disable(logging.INFO)  # every compiled form says so
    print('| hidden, body | motion over length | verdict | named | in the end | E off (95 %) | seconds |\n' + '|---' * 7 + '|')
    for name, body, effect, course in scenes():
        if wanted and effect not in wanted and name not in wanted:
            continue
        folder = os.path.join(output, name)
        os.makedirs(folder, exist_ok=True)
        if not os.path.exists(os.path.join(folder, 'most.json')):
            write_recording(folder, root, simulate, name, body, effect, course)
        most = json.load(open(os.path.join(folder, 'most.json')))
        print(row(name, most, diagnose(programs, folder)), flush=True)


if __name__ == '__main__':
    main(*sys.argv[1:])
