"""The paper's own list of error sources, each made, measured, and shown to `diagnose`."""
import json
import os

import numpy as np

from biventricle import biventricle
from common import MODULUS, TOPIC, Workshop, modulus, publish, read_cloud, table, write_vertices
from heart import BASE, BEAT, Heart, effects

TRUTH = 40e3         # Pa
COARSE, FINE = 0.012, 0.006
RATE, STEP, NOISE = 60.0, 0.005, 2e-4
STRIDES = (1, 2, 4, 12, 24)  # frames between the samples of their scheme
MOTIONS = (1.0, 0.25, 0.0625)  # of the contraction
LATE = 12            # frames into the beat
CUSHION = 2.5e-7     # m^3/N: a layer of 1 cm at the muscle's modulus
OFF = 1.15           # of the contraction that is assumed


class Bench(Heart):
    """The idealised heart with effects of one's choice."""

    def truth(self, name, more=(), share=1.0, beats=1.0):
        seen = {'markers': {'topic': TOPIC, 'noise': 1e-9, 'rest': self.rest.tolist()}}
        scene = {'mesh': {'file': 'fine.obj'}, 'regions': BASE, 'observations': [seen],
                 'effects': effects(TRUTH, share * self.stress * TRUTH) + list(more),
                 'simulation': {'duration': beats * BEAT + 1.5 / RATE, 'rate': RATE, 'step': STEP}}
        times, _, frames = read_cloud(self.work.simulate(name + '_truth', scene), name='marker')
        return times, frames + NOISE * np.random.RandomState(3).standard_normal(frames.shape)

    def bag(self, name, times, frames, chosen=slice(None), points=slice(None)):
        return write_vertices(self.work.path(name + '.bag'), times[chosen], self.ids[points], frames[chosen][:, points])

    def model(self, share=1.0, onset=0.0, more=(), **rest):
        listed = effects({'prior': 0.5 * TRUTH, 'factor': 3.0}, share * self.stress * TRUTH) + list(more)
        for effect in listed:
            if 'active_contraction' in effect:
                effect['active_contraction']['onset'] = onset
        return dict({'mesh': {'file': 'coarse.obj'}, 'regions': BASE, 'effects': listed,
                     'observations': [{'vertices': {'topic': TOPIC, 'noise': NOISE}}]}, **rest)

    def fit(self, name, model, bag):
        results, _ = self.work.estimate(name, model, bag)
        mean, std, interval = modulus(results)
        self.work.progress('%s: %.2f kPa' % (name, mean))
        return {'E': '%.2f (%.1f to %.1f)' % (mean, interval[0], interval[1]), 'off': 1e3 * mean / TRUTH - 1.0,
                'std': 1e3 * std / TRUTH, 'rms': results['rms_error'] / NOISE}

    def diagnose(self, name, model, bag):
        out = self.work.path(name + '_diagnosis')
        self.work.call('diagnose', self.work.write(name + '.yaml', model), bag, '--auto', '--quiet', '--output', out)
        with open(os.path.join(out, 'diagnosis.json')) as file:
            found = json.load(file)
        self.work.progress('%s: %s %s' % (name, found['verdict'], ' '.join(found['set'])))
        last = found['steps'][-1]
        return {'verdict': found['verdict'], 'set': ', '.join(found['set']), 'added': ', '.join(found['final']['effects']),
                'off': last['parameters'][MODULUS] / TRUTH - 1.0, 'rms': last['held_out_rms'] / last['noise_floor']}


def percent(value):
    return '%+.1f %%' % (100.0 * value)


def velocities(bench, times, frames):
    """Their scheme with samples farther and farther apart; ours on the same samples."""
    narrow = {'mean': 0.5 * TRUTH, 'std': 0.25 * TRUTH}
    rows = []
    for stride in STRIDES:
        bag = bench.bag('stride_%d' % stride, times, frames, slice(None, None, stride))
        model = bench.model(estimator='paper')
        model['effects'][1]['elasticity']['young_modulus'] = narrow
        theirs = bench.fit('paper_every_%d' % stride, model, bag)
        ours = bench.fit('ours_every_%d' % stride, bench.model(), bag)
        rows.append(['%.0f' % (1e3 * stride / RATE), '%d' % len(times[::stride]), percent(theirs['off']),
                     percent(ours['off']), ours['E']])
    publish(bench.work.root, 'velocities', table(['between samples [ms]', 'samples', 'error of their scheme', 'error of ours',
                                                  'ours [kPa]'], rows))


def sensitivity(bench):
    rows = []
    for share in MOTIONS:
        name = 'motion_%g' % share
        times, frames = bench.truth(name, share=share)
        largest = 1e3 * np.linalg.norm(frames[len(times) // 2] - bench.rest, axis=1).max()
        row = bench.fit(name, bench.model(share=share), bench.bag(name, times, frames))
        rows.append(['%.1f mm' % largest, row['E'], percent(row['off']), '%.1f %%' % (100 * row['std'])])
    few = bench.bag('few', *bench.truth('few'), points=slice(None, None, 50))
    row = bench.fit('few', bench.model(), few)
    rows.append(['as the first, %d vertices seen' % len(bench.ids[::50]), row['E'], percent(row['off']),
                 '%.1f %%' % (100 * row['std'])])
    publish(bench.work.root, 'sensitivity', table(['largest motion', 'E [kPa]', 'error', 'standard deviation'], rows))


def hidden(bench, times, frames):
    """What is wrong with the model, its estimate, what `diagnose --auto` says and makes of it."""
    late = bench.bag('late', times, frames, slice(LATE, None))
    begun = -LATE / RATE
    cushion = [{'elastic_support': {'region': 'base', 'compliance': CUSHION}}]
    slow = [{'viscoelasticity': {'gamma': 0.3, 'tau': 0.08}}]
    cases = [('nothing', 'nothing', bench.model(), bench.bag('nothing', times, frames)),
             ('support', 'the base is compliant', bench.model(), bench.bag('support', *bench.truth('support', cushion))),
             ('relaxing', 'the muscle relaxes (viscoelasticity)', bench.model(),
              bench.bag('relaxing', *bench.truth('relaxing', slow))),
             ('late', 'the recording starts in mid-beat, at speed', bench.model(onset=begun), late),
             ('begun', 'the same, `time: {start: %g}`' % begun, bench.model(onset=begun, time={'start': begun}), late),
             ('contraction', 'the contraction is %.0f %% weaker than assumed' % (100 * (1 - 1 / OFF)), bench.model(share=OFF),
              bench.bag('contraction', times, frames))]
    rows = []
    for name, label, model, bag in cases:
        plain, found = bench.fit(name, model, bag), bench.diagnose(name, model, bag)
        rows.append([label, percent(plain['off']), '%.2f' % plain['rms'],
                     found['verdict'] + (': ' + found['set'] if found['set'] else ''),
                     found['added'] or '-', percent(found['off']), '%.2f' % found['rms']])
    publish(bench.work.root, 'failures', table(['what the model has wrong', 'error of E', 'rms error / noise',
                                                '`diagnose --auto`', 'added', 'error of E then', 'held-out error / noise then'], rows))


def main(place):
    work = Workshop(place, 2 * len(STRIDES) + len(MOTIONS) + 13, 'failures')
    bench = Bench(work, biventricle(COARSE), biventricle(FINE))
    times, frames = bench.truth('plain')
    velocities(bench, times, frames)
    sensitivity(bench)
    hidden(bench, times, frames)
