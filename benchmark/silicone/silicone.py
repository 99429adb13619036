"""A real silicone beam, released under gravity with and without 52 g at its tip, filmed twice each: what the plain elastic model
lacks on the first recording, and how well a model fitted to one recording of each kind predicts the other two. Prints the
tables of doc/silicone.md."""
import json
import os
import subprocess
import sys
import tempfile

import yaml

RECORDINGS = 'silicone_beam_%s'
NARROW = 1.0001  # factor of a prior that keeps a parameter where it is
FITTED = 1.2     # and of one that hands a fit on to the next recording


def tool(root, name, *arguments):
    subprocess.run([os.path.join(root, 'build', 'devel', 'lib', 'tissue_stiffness', name), *arguments, '--quiet'],
                   check=True, stdout=subprocess.DEVNULL)


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

    def estimate(self, name, added, quantities):
        """The recording's own model with the added effects; `quantities` replaces estimated numbers by name."""
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
        tool(self.root, 'estimate', path, case + '/recording.bag', '--output', self.folder)
        return read(self.folder, 'results.json')


def around(results, factor):
    return {name: {'prior': p['mean'], 'factor': factor} for name, p in results['parameters'].items()}


def row(what, results):
    p = results['parameters']
    damping = p.get('viscous_damping.beta')
    print('| %s | %.1f | %s | %.2f |' % (what, p['elasticity.young_modulus']['mean'] / 1e3,
                                         '%.2f' % (1e3 * damping['mean']) if damping else '-', 1e3 * results['rms_error']),
          flush=True)


def main():
    root = sys.argv[1]
    if not os.path.isdir(os.path.join(root, '..', 'shared', 'cases')):
        sys.exit('silicone: the recordings are not beside the repository')
    with tempfile.TemporaryDirectory() as folder:
        beam = Beam(root, folder)
        diagnosis = beam.diagnose('gravity_a')
        print('## What the elastic model lacks (gravity_a)\n\nVerdict: %s; set: %s.\n' % (
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
        print('\n## Fitted to gravity_a and load52_a, predicting gravity_b and load52_b\n')
        print('| recording | E [kPa] | viscous damping [ms] | rms error [mm] |\n|---|---|---|---|')
        for label, added in (('elastic', []), ('damped', [{'viscous_damping': {'beta': {'prior': 0.003, 'factor': 2.0}}}])):
            one = beam.estimate('gravity_a', added, {})
            row(label + ': gravity_a, fitted', one)
            both = beam.estimate('load52_a', added, around(one, FITTED))
            row(label + ': load52_a, fitted from there', both)
            middle = {name: {'prior': (p['mean'] * one['parameters'][name]['mean']) ** 0.5, 'factor': NARROW}
                      for name, p in both['parameters'].items()}
            for name in ('gravity_b', 'load52_b'):
                row(label + ': ' + name + ', predicted', beam.estimate(name, added, middle))


if __name__ == '__main__':
    main()
