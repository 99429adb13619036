"""A real silicone beam, released under gravity with and without 52 g at its tip, filmed twice each: what the plain elastic model
lacks on the first recording, and how well a model fitted to one recording of each kind together predicts the other two.
Prints the tables of doc/silicone.md."""
import json
import os
import subprocess
import sys
import tempfile

import numpy as np
import rosbag
import sensor_msgs.point_cloud2 as point_cloud2
import yaml

RECORDINGS = 'silicone_beam_%s'
DAMPING = {'viscous_damping': {'beta': {'prior': 0.003, 'factor': 2.0}}}
TURNED = {'sensor_rotation': {'angles': {'mean': [0.0, 0.0, 0.0], 'std': 0.1}}}
MODULUS, BETA, MASS = 'elasticity.young_modulus', 'viscous_damping.beta', 'added_mass.mass'
TOPIC = '/beam/markers'
TIP = [0.015, 0.015, 0.1]  # m, its centre
SWING = slice(10, 200)     # frames, of the ringing
ANGLES = ['sensor_rotation.angles_' + axis for axis in 'xyz']


def tool(root, name, *arguments):
    done = subprocess.run([os.path.join(root, 'build', 'devel', 'lib', 'tissue_stiffness', name), *arguments, '--quiet'],
                          stdout=subprocess.DEVNULL)
    if done.returncode not in (0, 3):  # 3: answered, but not to be used
        done.check_returncode()


def read(folder, name):
    with open(os.path.join(folder, name)) as file:
        return json.load(file) if name.endswith('.json') else yaml.safe_load(file)


class Beam:
    def __init__(self, root, folder):
        self.root, self.folder = root, folder
        self.cases = os.path.join(root, '..', 'shared', 'cases')

    def place(self, name):
        return os.path.join(self.cases, RECORDINGS % name)

    def diagnose(self, name):
        case = self.place(name)
        tool(self.root, 'diagnose', case + '/model.yaml', case + '/recording.bag', '--output', self.folder, '--auto')
        return read(self.folder, 'diagnosis.json')

    def model(self, name, added, quantities):
        """Name of the recording's own model with the added effects; `quantities` replaces numbers by name."""
        case = self.place(name)
        model = read(case, 'model.yaml')
        model['mesh']['file'] = os.path.join(case, model['mesh']['file'])
        model['effects'] += json.loads(json.dumps(added))
        for entry in model['effects']:
            (effect, arguments), = entry.items()
            for key in list(arguments):
                arguments[key] = quantities.get(effect + '.' + key, arguments[key])
        path = os.path.join(self.folder, name + '.yaml')
        with open(path, 'w') as file:
            yaml.safe_dump(model, file)
        return path

    def estimate(self, added, quantities=None, own=()):
        """One recording of each kind, fitted together; they predict the other two."""
        def files(*names):
            return [file for name in names
                    for file in (self.model(name, added, quantities or {}), self.place(name) + '/recording.bag')]
        more = [text for name in own for text in ('--own', name)]
        tool(self.root, 'estimate', *files('gravity_a', 'load52_a'), '--predict', *files('gravity_b', 'load52_b'), *more,
             '--output', self.folder)
        return read(self.folder, 'results.json')


def tip_motion(place):
    """Displacement of the tip's centre in every frame, which moves with the three markers as a rigid body does [mm]."""
    rest = np.array(read(place, 'model.yaml')['observations'][0]['markers']['rest'])
    out = []
    with rosbag.Bag(os.path.join(place, 'recording.bag')) as bag:
        for _, cloud, _ in bag.read_messages(TOPIC):
            seen = np.array(list(point_cloud2.read_points(cloud, ('x', 'y', 'z'))))
            left, _, right = np.linalg.svd((rest - rest.mean(0)).T @ (seen - seen.mean(0)))
            turn = (left @ np.diag([1, 1, np.linalg.det(left @ right)]) @ right).T  # Kabsch 1976
            out.append(seen.mean(0) + turn @ (TIP - rest.mean(0)) - TIP)
    return 1e3 * np.array(out)


def show_tip(beam):
    print('| recording | along the beam, of the motion across it | and of its square [1/m] |\n|---|---|---|')
    for name in ('gravity_a', 'gravity_b', 'load52_a', 'load52_b'):
        across, _, along = tip_motion(beam.place(name))[SWING].T
        share, square = np.linalg.lstsq(np.stack([across, across ** 2], axis=1), along, rcond=None)[0]
        print('| %s | %.3f | %.1f |' % (name, share, 1e3 * square))


def show_fit(label, results):
    def cell(name, scale, digits):
        if name not in results['parameters']:
            return '-'
        p = results['parameters'][name]
        return '%.*f (%.*f to %.*f)' % (digits, scale * p['mean'], digits, scale * p['interval95'][0], digits,
                                        scale * p['interval95'][1])
    print('| %s | %s | %s | %s | %s | %s |' % (label, cell(MODULUS, 1e-3, 0), cell(BETA, 1e3, 1), cell(ANGLES[1], 57.3, 1),
                                               cell(MASS, 1e3, 1), results['state']), flush=True)


def verdict(test):
    return '%.1f, %s' % (test['z'], 'passes' if test['passes'] else 'fails') if test else '-'


def show_recordings(label, results):
    for r in results['recordings']:
        name = os.path.basename(os.path.dirname(r['recording'])).replace('silicone_beam_', '')
        own = ', '.join('%s %.3g' % (parameter, value['mean']) for parameter, value in r['parameters'].items())
        print('| %s | %s | %s | %.2f | %.2f | %s | %s | %s |' % (
            label, name, 'predicted' if r['predicted'] else 'fitted', 1e3 * r['rms_error'], r['rms_sigma'],
            verdict(r.get('misfit')), verdict(r.get('agreement')), own or '-'), flush=True)


def fit_together(beam):
    weighed = {'added_mass.mass': {'prior': 0.052, 'factor': 1.2}}
    fits = [('elastic', beam.estimate([])), ('damped', beam.estimate([DAMPING])),
            ('damped, turned', beam.estimate([DAMPING, TURNED])),
            ('damped, turned, weighed', beam.estimate([DAMPING, TURNED], weighed)),
            ('damped, each turned', beam.estimate([DAMPING, TURNED], own=['sensor_rotation']))]
    print('| model | E [kPa] | viscous damping [ms] | turned by [deg] | weight [g] | state |\n|---|---|---|---|---|---|')
    for label, results in fits:
        show_fit(label, results)
    print('\n| model | recording | | rms error [mm] | of the noise | misfit, z | agreement, z | its own |\n'
          '|---|---|---|---|---|---|---|---|')
    for label, results in fits:
        show_recordings(label, results)


def main():
    root = sys.argv[1]
    if not os.path.isdir(os.path.join(root, '..', 'shared', 'cases')):
        sys.exit('silicone: the recordings are not beside the repository')
    with tempfile.TemporaryDirectory() as folder:
        beam = Beam(root, folder)
        diagnosis = beam.diagnose('gravity_a')
        print('## What the elastic model lacks (gravity_a)\n\nThe verdict is `%s`, and the set holds %s.\n' % (
            diagnosis['verdict'], ', '.join(diagnosis['set'])))
        print('| model | E [kPa] | held-out error [mm] | times smaller |\n|---|---|---|---|')
        first = diagnosis['steps'][0]['held_out_rms']
        for step in diagnosis['steps']:
            print('| %s | %.1f | %.2f | %.1f |' % (
                ' + '.join(['elastic'] + step['effects']), step['parameters']['elasticity.young_modulus'] / 1e3,
                1e3 * step['held_out_rms'], first / step['held_out_rms']))
        print('\n| effect | explains | held-out error [mm] |\n|---|---|---|')
        for candidate in diagnosis['candidates']:
            if candidate.get('held_out_rms_after'):
                print('| %s | %.1f %% | %.2f |' % (candidate['effect'], 100 * candidate['explained'],
                                                  1e3 * candidate['held_out_rms_after']))
        print('\n## Where the tip goes\n')
        show_tip(beam)
        print('\n## Fitted to gravity_a and load52_a, predicting gravity_b and load52_b\n')
        fit_together(beam)


if __name__ == '__main__':
    main()
