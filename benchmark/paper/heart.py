"""The paper's table 1 and figure 6: Young's modulus of a beating heart from its surfaces."""
import os

import numpy as np
from scipy.optimize import brentq
from scipy.spatial import cKDTree

from biventricle import biventricle, cavity_volume
from common import MODULUS, TOPIC, Workshop, modulus, publish, read_cloud, table, write_vertices
from figures import plt, save
from meshes import write_obj

MODULI = (40, 80, 100, 140, 180)  # kPa
STARTS = ((20, 10), (40, 10), (50, 10), (70, 20), (90, 20))  # kPa
LOST = 0.4       # of both cavities' volume at end systole
BEAT, RATE, BEATS = 0.8, 30.0, 4
FRAMES = int(BEAT * RATE) + 1
SYSTOLE = FRAMES // 2
STEP = 0.01      # s, of the truth
NOISE = 2e-4     # m, on every coordinate of a tracked surface
SILENT = 1e-9    # m
COARSE, FINE = 0.009, 0.0045  # m: edges of the model's mesh and of the truth's
THINNED = (4800, 8000)        # triangles of the real heart, the same way round
BASE = {'base': {'box': {'min': [-1, -1, -1e-7], 'max': [1, 1, 1]}}}
SEEN = [{'vertices': {'topic': TOPIC, 'noise': NOISE}}]
PUBLISHED = {
    'E': '37±2 76±3 93±4 134±7 167±10', 'error': '7.5 5 7 4.3 7.2', 'std': '1.41 2 3.2 7.5 10.2',
    'distance': '0.2±0.1 0.3±0.1 0.3±0.1 0.5±0.2 0.7±0.2', 'tracking': '1.3 2.0 2.0 3.3 4.7',
    'force': '8-37 17-80 17-85 25-110 30-170'}


def effects(young_modulus, stress):
    """The paper's linear tissue; its muscle pulls around the long axis, and half as much along it."""
    def fibres(direction, amplitude):
        return {'active_contraction': {'direction': direction, 'axis': [0, 0, 1], 'center': [0, 0, 0], 'amplitude': amplitude,
                                       'period': BEAT, 'duration': BEAT}}
    return [{'inertia': {'density': 1060.0}},
            {'elasticity': {'law': 'linear', 'young_modulus': young_modulus, 'poisson_ratio': 0.45}},
            {'fixed': {'region': 'base'}}, fibres('circumferential', stress), fibres('longitudinal', 0.5 * stress)]


class Heart:
    """A heart on two meshes: the model's, and the finer one that the truth is simulated on."""

    def __init__(self, work, coarse, fine):
        self.work = work
        self.points, triangles, self.cavities = coarse
        self.triangles = triangles
        write_obj(work.path('coarse.obj'), self.points, triangles)
        write_obj(work.path('fine.obj'), *fine[:2])
        _, self.ids, frames = read_cloud(self.run('rest', 'coarse', 1e3, 0.0, 2.0 / RATE))
        self.rest = frames[0]
        self.corner = cKDTree(self.rest).query(self.points)[1]  # row of each point of the surface's triangles
        self.stress = self.contraction()

    def run(self, name, mesh, young_modulus, stress, duration):
        seen = {'vertices': {'topic': TOPIC, 'noise': SILENT}}
        if mesh == 'fine':
            seen = {'markers': {'topic': TOPIC, 'noise': SILENT, 'rest': self.rest.tolist()}}
        simulation = {'duration': duration, 'rate': RATE, 'step': STEP}
        return self.work.simulate(name, {'mesh': {'file': mesh + '.obj'}, 'regions': BASE, 'observations': [seen],
                                         'effects': effects(young_modulus, stress), 'simulation': simulation})

    def contraction(self):
        """Fibre stress over Young's modulus at which both ventricles together lose as much of their volume as hearts do."""
        trial = 0.3
        _, _, frames = read_cloud(self.run('trial', 'fine', 40e3, trial * 40e3, 0.6 * BEAT), name='marker')
        moved = (frames[SYSTOLE] - self.rest)[self.corner]

        def volume(share):
            return sum(cavity_volume(self.points + share * moved, part) for part in self.cavities.values())
        return trial * brentq(lambda share: volume(share) / volume(0.0) - (1.0 - LOST), 0.1, 3.0)

    def model(self, young_modulus, truth, **more):
        return dict({'mesh': {'file': 'coarse.obj'}, 'regions': BASE, 'observations': SEEN,
                     'effects': effects(young_modulus, self.stress * truth)}, **more)

    def systole(self, young_modulus, truth):
        """The model's surface at end systole, with this modulus under the contraction of the true one."""
        bag = self.run('tracked', 'coarse', young_modulus, self.stress * truth, 0.6 * BEAT)
        return read_cloud(bag)[2][SYSTOLE]

    def distance(self, young_modulus, truth, reference):
        """Mean and standard deviation of the distance between the model's surface and the true one [mm]."""
        corners = reference[self.corner][self.triangles]
        areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals = np.zeros_like(reference)
        for i in range(3):
            np.add.at(normals, self.corner[self.triangles[:, i]], areas)
        length = np.linalg.norm(normals, axis=1)
        known = length > 0
        apart = np.einsum('ij,ij->i', self.systole(young_modulus, truth) - reference, normals)[known] / length[known]
        return 1e3 * np.abs(apart).mean(), 1e3 * np.abs(apart).std()


def one_modulus(heart, kilopascal, start):
    """Everything about one true modulus."""
    work, truth, name = heart.work, 1e3 * kilopascal, '%d_' % kilopascal
    times, _, frames = read_cloud(heart.run(name + 'truth', 'fine', truth, heart.stress * truth, BEATS * BEAT + 0.5 / RATE),
                                  name='marker')
    noise = NOISE * np.random.RandomState(kilopascal).standard_normal(frames.shape)
    seen = frames + noise
    beat = write_vertices(work.path(name + 'beat.bag'), times[:FRAMES], heart.ids, seen[:FRAMES])
    keys = [0] + list(range(SYSTOLE, len(times), SYSTOLE))
    samples = write_vertices(work.path(name + 'keys.bag'), times[keys], heart.ids, seen[keys])
    reference = frames[SYSTOLE]
    largest = 1e3 * np.linalg.norm(reference - heart.rest, axis=1).max()
    row = {'truth': kilopascal, 'start': start, 'largest': largest, 'stress': heart.stress * kilopascal}
    row['initial'] = heart.distance(1e3 * start[0], truth, reference)

    def fit(label, modulus_prior, bag, **more):
        results, course = work.estimate(name + label, heart.model(modulus_prior, truth, **more), bag)
        mean, std, interval = modulus(results)
        tracking, tracked = mean, course
        if not more:  # the surface that it tracks is the fit's, before E is corrected for what the mesh does
            mesh = {'file': 'coarse.obj', 'discretisation_error': False}
            plain, tracked = work.estimate(label + '_tracking', heart.model(modulus_prior, truth, mesh=mesh), bag)
            tracking = modulus(plain)[0]
        row[label] = {'E': mean, 'std': std, 'interval': interval, 'course': course, 'tracked': tracked,
                      'distance': heart.distance(1e3 * tracking, truth, reference)}
        work.progress('E = %d kPa, %s: %.2f kPa' % (kilopascal, label, mean))
    narrow = {'mean': 1e3 * start[0], 'std': 1e3 * start[1]}
    fit('paper_keys', narrow, samples, estimator='paper')
    fit('paper_beat', narrow, beat, estimator='paper')
    fit('ours', {'prior': 1e3 * start[0], 'factor': 3.0}, beat)
    fit('low', {'prior': 0.1 * truth, 'factor': 10.0}, beat)
    fit('high', {'prior': 10.0 * truth, 'factor': 10.0}, beat)
    row['reference'] = reference
    return row


def off(row, label):
    return 100.0 * (row[label]['E'] / row['truth'] - 1.0)


def text(rows):
    lines = []

    def line(name, cells):
        lines.append([name] + list(cells))

    def each(name, shown):
        line(name, [shown(row) for row in rows])
    labels = (('paper_keys', '`estimator: paper`, two samples a beat'), ('paper_beat', '`estimator: paper`, every frame'),
              ('ours', '**ours**'))
    each('start [kPa]', lambda r: '%d±%d' % r['start'])
    line('recovered E [kPa]: published', PUBLISHED['E'].split())
    for label, name in labels[:2]:
        each(name, lambda r: '%.1f±%.2f' % (r[label]['E'], r[label]['std']))
    each('**ours**, 95 % interval', lambda r: '**%.2f** (%.1f to %.1f)' % ((r['ours']['E'],) + tuple(r['ours']['interval'])))
    each('ours, from a tenth', lambda r: '%.2f' % r['low']['E'])
    each('ours, from ten times', lambda r: '%.2f' % r['high']['E'])
    line('error [%]: published', PUBLISHED['error'].split())
    for label, name in labels:
        each(name, lambda r: '%+.2f' % off(r, label))
    each('the interval holds the truth: ours',
         lambda r: 'yes' if r['ours']['interval'][0] <= r['truth'] <= r['ours']['interval'][1] else 'NO')
    line('standard deviation of E [kPa]: published', PUBLISHED['std'].split())
    each('**ours**', lambda r: '%.2f' % r['ours']['std'])
    each('surface distance [mm]: at the start', lambda r: '%.2f' % r['initial'][0])
    line('published', PUBLISHED['distance'].split())
    for label, name in labels:
        each(name, lambda r: '%.3f±%.3f' % r[label]['distance'])
    line('tracking error, of the largest motion [%]: published', PUBLISHED['tracking'].split())
    for label, name in labels:
        each(name, lambda r: '%.2f' % (100.0 * r[label]['distance'][0] / r['largest']))
    line('contraction: published, force on a node [mN]', PUBLISHED['force'].split())
    each('ours, stress along the fibres [kPa]', lambda r: '%.1f' % r['stress'])
    return table(['true E [kPa]'] + ['%d' % row['truth'] for row in rows], lines)


def means(course):
    """Young's modulus after every frame that was used [Pa]."""
    column = next(name for name in course.dtype.names if name.startswith(MODULUS.replace('.', '')) and 'mean' in name)
    return course[column][course['used'] == 1]


def pictures(heart, rows, path):
    """Their figure 6: distance of the surfaces and E against the iteration."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.5, 3.4))
    row = rows[0]
    truth = 1e3 * row['truth']
    for label, name, colour in (('paper_keys', 'their scheme, two samples a beat', '#c0504d'),
                                ('ours', 'ours, the whole beat', '#1f5fa8')):
        values = np.concatenate([[1e3 * row['start'][0]], means(row[label]['tracked'])])
        kept = np.unique(np.round(np.linspace(0, len(values) - 1, min(len(values), 13))).astype(int))
        apart = [heart.distance(float(values[k]), truth, row['reference'])[0] for k in kept]
        left.plot(kept, apart, 'o-', ms=3, color=colour, label=name)
    left.set_ylabel('distance of the surfaces [mm]')
    left.set_yscale('log')
    left.legend(frameon=False, fontsize=8)
    for row in rows:
        for label, colour in (('ours', '#1f5fa8'), ('paper_keys', '#c0504d')):
            right.plot(np.concatenate([[row['start'][0]], means(row[label]['course']) / 1e3]), color=colour)
        right.axhline(row['truth'], color='#888888', lw=0.8, ls=':')
    right.set_ylabel('E [kPa]; dotted: the truth')
    for axis in (left, right):
        axis.set_xlabel('frames used')
    save(figure, path, bare=(left, right))


def about(heart, rows):
    worst = max(abs(off(row, label)) for row in rows for label in ('ours', 'low', 'high'))
    return ('There are %d tracked vertices with 0.2 mm of noise, and the largest motion is %.1f mm. From any start, our largest\n'
            'error is %.2f %% and our largest surface distance is %.3f mm.\n\n' % (
                len(heart.ids), rows[0]['largest'], worst,
                max(row[label]['distance'][0] for row in rows for label in ('ours', 'low', 'high'))))


def experiment(place, name, coarse, fine):
    heart = Heart(Workshop(place, 5 * len(MODULI), name), coarse, fine)
    rows = [one_modulus(heart, kilopascal, start) for kilopascal, start in zip(MODULI, STARTS)]
    publish(place.root, name, about(heart, rows) + text(rows))
    return heart, rows


def idealised(place):
    heart, rows = experiment(place, 'heart', biventricle(COARSE), biventricle(FINE))
    pictures(heart, rows, os.path.join(place.root, 'doc', 'paper', 'convergence.png'))


def real(place):
    folder = os.path.join(place.shared, 'data', 'heart_bivme')
    if not os.path.isdir(folder):
        print('The real heart is skipped: there is no ' + folder)
        return
    from real_heart import real_heart  # needs VTK
    experiment(place, 'real_heart', *(real_heart(folder, count) for count in THINNED))


def main(place):
    idealised(place)
    real(place)
