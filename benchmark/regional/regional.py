"""Regional moduli: three in the ratios 1 : 3 : 0.5, and the ten slices of Optimus' cylinder, each simulated on a mesh of eight
times as many elements and in time steps, then estimated; and maps of the three and of one, made by an estimator that does not
know where they are. Prints the tables of doc/regional.md."""
import argparse
import json
import os
import subprocess
import sys
import tempfile
import time

import yaml

from cylinder import cylinder, volume
from meshes import write_vtk

SLICES = [3500, 4000, 1000, 6000, 2000, 7000, 2500, 8000, 3000, 1500]  # Pa
OPTIMUS = [3254, 4808, 1010, 6791, 1998, 8056, 2611, 46699, 5828, 969]  # what it ends at, from 4000 +- 1000
LAYERS = 40
MAPPED_LAYERS = 18
THIRDS = [4000, 12000, 2000]
MAP = {'cells': 12, 'length': 0.06, 'factor': 2.0}
TITLES = {'thirds': 'Three moduli', 'slices': "Optimus' ten slices", 'map': 'Three moduli, mapped', 'flat': 'One modulus, mapped'}


class Body:
    """A cylinder in slices of equal length, both ends clamped, gravity across it switched on at rest."""

    def __init__(self, moduli, layers, rings=2, radius=0.02, length=0.3, mass=0.2):
        self.moduli = moduli
        self.nodes, self.tets, self.line = cylinder(radius, length, layers, rings)
        density = mass / volume(self.nodes, self.tets)
        big, step = 1.0, length / len(moduli)
        self.regions = {}
        for i in range(len(moduli)):
            box = {'min': [i * step - 1e-6, -big, -big], 'max': [(i + 1) * step + 1e-6, big, big]}
            self.regions['slice_%d' % (i + 1)] = {'box': box}
        self.regions['left'] = {'box': {'min': [-big] * 3, 'max': [1e-9, big, big]}}
        self.regions['right'] = {'box': {'min': [length - 1e-9, -big, -big], 'max': [big] * 3}}
        self.others = [{'inertia': {'density': density}}, {'gravity': {'acceleration': [0, 0, -9.81]}},
                       {'fixed': {'region': 'left'}}, {'fixed': {'region': 'right'}}]

    def model(self, moduli, noise):
        effects = self.others + [
            {'elasticity': {'law': 'linear', 'young_modulus': modulus, 'poisson_ratio': 0.45, 'region': 'slice_%d' % (i + 1)}}
            for i, modulus in enumerate(moduli)]
        return {'mesh': {'file': 'mesh.vtk', 'boundary': 'faceted'}, 'regions': self.regions, 'effects': effects,
                'observations': [{'vertices': {'topic': '/line', 'noise': noise}}]}

    def mapped(self, prior, noise):
        """One modulus, to be mapped."""
        effects = self.others + [{'elasticity': {'law': 'linear', 'young_modulus': prior, 'poisson_ratio': 0.45}}]
        return {**self.model([], noise), 'effects': effects, 'map': MAP}

    def truth_at(self, x, length=0.3):
        return self.moduli[min(int(x / length * len(self.moduli)), len(self.moduli) - 1)]

    def run(self, folder, prior, noise, duration, mapped=False):
        write_vtk(os.path.join(folder, 'mesh.vtk'), self.nodes, self.tets)
        scene = self.model([float(e) for e in self.moduli], noise)
        scene['simulation'] = {'duration': duration, 'rate': 100, 'step': 0.001, 'refine': 1, 'seed': 1,
                               'sensors': {'/line': {'ids': [int(i) for i in self.line]}}}
        model = self.mapped(prior, noise) if mapped else self.model([prior] * len(self.moduli), noise)
        files = {'scene.yaml': scene, 'model.yaml': model}
        for name, content in files.items():
            with open(os.path.join(folder, name), 'w') as file:
                yaml.safe_dump(content, file, sort_keys=False)
        tool('simulate', os.path.join(folder, 'scene.yaml'), '--output', os.path.join(folder, 'line.bag'))
        start = time.time()
        tool('estimate', os.path.join(folder, 'model.yaml'), os.path.join(folder, 'line.bag'), '--output', folder)
        with open(os.path.join(folder, 'results.json')) as file:
            results = json.load(file)
        print('The body has %d vertices. The estimate from %d frames took %.0f s, with an rms error of %.2f of the noise.\n' % (
            len(self.nodes), results['frames'], time.time() - start, results['rms_error'] / noise))
        return results


def tool(name, *arguments):
    done = subprocess.run([os.path.join(TOOLS, name), *arguments, '--quiet'])
    if done.returncode not in (0, 3):  # 3: answered, but not to be used
        done.check_returncode()


def table(results, truth, peer=None):
    print('| slice | truth [Pa] | ours [Pa] | error | 95 % interval | identifiable |' + (' Optimus [Pa] |' if peer else ''))
    print('|---|---|---|---|---|---|' + ('---|' if peer else ''))
    held, worst = 0, 0.0
    for i, modulus in enumerate(truth):
        name = 'elasticity%s.young_modulus' % ('' if i == 0 else '#%d' % (i + 1))
        p = results['parameters'][name]
        low, high = p['interval95']
        error = 100 * (p['mean'] / modulus - 1)
        held += low <= modulus <= high
        worst = max(worst, abs(error))
        print('| %d | %d | %.0f | %+.1f %% | %.0f to %.0f | %s |' % (
            i + 1, modulus, p['mean'], error, low, high, results['identifiable'][name]['verdict'])
            + (' %d (%+.0f %%) |' % (peer[i], 100 * (peer[i] / modulus - 1)) if peer else ''))
    print('\n%d of %d intervals hold the truth; the largest error is %.1f %%.\n' % (held, len(truth), worst))


def map_table(body, found):
    """Patches along the body; one that lies in two slices has no truth of its own."""
    for level in found['levels']:
        print('%d patch%s: mean square error %.2f of the noise%s' % (
            level['patches'], 'es' if level['patches'] > 1 else '', level['mean_square'], ', kept' if level['kept'] else ''))
    print('\nbeside the mesh it leaves an error of %.1f of the noise: %d patches identified' % (
        found['misfit'], found['identified']))
    print('\n| patch at x [mm] | truth [Pa] | ours [Pa] | error | 95 % interval | |')
    print('|---|---|---|---|---|---|')
    patches = sorted(found['patches'], key=lambda patch: patch['center'][0])
    half = 0.15 / len(patches)
    held, whole, worst = 0, 0, 0.0
    for patch in patches:
        x, ours, (low, high) = patch['center'][0], patch['young_modulus'], patch['interval95']
        ends = {body.truth_at(x - 0.9 * half), body.truth_at(x + 0.9 * half)}
        row = '| %.0f | %s | %.0f | %s | %.0f to %.0f | %s |'
        state = 'identified' if patch['identified'] else 'not to be used'
        if len(ends) > 1:
            print(row % (1e3 * x, ' and '.join('%d' % e for e in sorted(ends)), ours, '', low, high, state))
            continue
        truth = ends.pop()
        error = 100 * (ours / truth - 1)
        whole, held, worst = whole + 1, held + (low <= truth <= high), max(worst, abs(error))
        print(row % (1e3 * x, truth, ours, '%+.1f %%' % error, low, high, state))
    print('\nOf %d patches within one slice %d intervals hold the truth; the largest error is %.1f %%.\n' % (whole, held, worst))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('root')
    parser.add_argument('which', nargs='*', default=list(TITLES), help='thirds, slices, map, flat (default: all)')
    parser.add_argument('--keep', help='folder for the recordings')
    options = parser.parse_args()
    for which in options.which:
        if which not in TITLES:
            parser.error('%s: one of %s' % (which, ', '.join(TITLES)))
    global TOOLS
    TOOLS = os.path.join(options.root, 'build', 'devel', 'lib', 'tissue_stiffness')
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or temporary
        os.makedirs(folder, exist_ok=True)
        for which in options.which:
            moduli = {'slices': SLICES, 'flat': [4000]}.get(which, THIRDS)
            mapped = which in ('map', 'flat')
            body = Body(moduli, MAPPED_LAYERS if mapped else LAYERS)
            print('## %s\n' % TITLES[which], flush=True)
            results = body.run(folder, {'prior': 4000.0, 'factor': 2.0}, 5e-4, 1.0 if mapped else 3.0, mapped)
            if mapped:
                map_table(body, results['map'])
                continue
            table(results, moduli, OPTIMUS if which == 'slices' else None)
            sys.stdout.flush()


if __name__ == '__main__':
    main()
