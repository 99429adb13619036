"""Hides effects in simulated bodies and counts how often `diagnose` finds them: see scripts/hidden_effects."""
import argparse
import collections
import json
import multiprocessing
import os
import random
import sys
import time

import rosbag
import sensor_msgs.point_cloud2 as point_cloud2
import yaml

from figures import plt, save
from organs import organs
from scenes import STEP, TRIAL_STEP, scenes, step_of
from tool_runs import Failed, call

DURATION = 1.6    # s
TOPIC = '/tissue/markers'
MISFITS = (0.03, 0.1, 0.3)   # of the motion
EQUIVALENTS = [{'viscous_damping', 'mass_damping', 'viscoelasticity'}, {'density_error', 'force_scale', 'image_scale', 'added_mass'},
         {'fibre_reinforcement', 'stiff_inclusion'},
         {'elastic_support', 'stiff_inclusion'}]  # what is soft beside the clamp, and what is soft there
HIDDEN = {
    'bar released under gravity': ['none', 'viscous_damping', 'viscoelasticity', 'elastic_support', 'stiff_inclusion',
                                   'added_mass', 'foundation', 'geometric_nonlinearity'],
    'bar pushed and let go': ['none', 'mass_damping', 'viscoelasticity', 'elastic_support', 'stiff_inclusion', 'added_mass',
                              'gravity'],
    'slab worked by a tool': ['none', 'viscoelasticity', 'elastic_support', 'stiff_inclusion', 'foundation', 'gravity'],
}
ORGANS = {
    'block worked by a tool': ['viscous_damping', 'mass_damping', 'viscoelasticity', 'stiff_inclusion', 'foundation', 'gravity',
                               'image_scale', 'time_offset', 'compressibility'],
    'ventricle filled by a pressure': ['viscous_damping', 'viscoelasticity', 'stiff_inclusion', 'fibre_reinforcement',
                                       'active_contraction', 'elastic_support', 'foundation', 'gravity', 'image_scale'],
}
STEPS_PER_FRAME = (4, 8)  # of their truths: independent simulators take as few
MODULUS = 'elasticity.young_modulus'
TIME_LIMIT = 600  # s a run
VISIBLE = 1.15    # held-out error over a clean recording's: there is something to find
EVERY = 8  # draws there come one of each of these, numbered from here on:
PUSHES, LONG_STEPS = 10000, 20000  # unrecorded loads, which no effect of the library is; truths in long time steps
EVERY_ORGAN, FIRST_ORGAN = 2, 30000  # draws there comes one of a block or a ventricle
MOST_TRIALS = 5   # of a strength
STRONGEST = 10.0


def write(folder, name, content):
    path = os.path.join(folder, name)
    with open(path, 'w') as file:
        yaml.safe_dump(content, file, default_flow_style=None, sort_keys=False)
    return path


def observations(scene):
    return [{'markers': {'topic': TOPIC, 'noise': scene.noise, 'rest': scene.markers()}}]


def simulate(arguments, folder, scene, modulus, hidden, strength, load=1.0, true=False, noise=1e-9, memory=0.0, seed=1,
             step=STEP):
    step = step_of(hidden, strength, step)
    regions, effects = scene.truth(modulus, hidden, strength, load)
    loads = scene.loads_with(modulus, hidden, strength)
    content = {'mesh': scene.write_mesh(folder, 'true', true, hidden), 'regions': regions, 'effects': effects,
               'observations': observations(scene),
               'simulation': {'duration': DURATION, 'rate': scene.rate, 'step': step, 'spectral_radius': 1.0, 'seed': seed,
                              **({'loads': loads} if loads else {}),
                              'sensors': {TOPIC: {'noise': noise, 'memory': memory}}}}
    bag = os.path.join(folder, 'recording.bag')
    call([arguments.simulate, write(folder, 'scene.yaml', content), '--output', bag, '--quiet'], TIME_LIMIT)
    return bag


def motion(bag):
    with rosbag.Bag(bag) as file:
        frames = [[value for point in point_cloud2.read_points(cloud, ('x', 'y', 'z')) for value in point]
                  for _, cloud, _ in file.read_messages(TOPIC)]
    return [[value - rest for value, rest in zip(frame, frames[0])] for frame in frames]


def rms(frames):
    values = [value for frame in frames for value in frame]
    return (sum(value * value for value in values) / len(values)) ** 0.5


def load_for(hidden, strength):
    """Nothing but the load makes finite strain matter."""
    return strength if hidden == 'geometric_nonlinearity' else 1.0


def strength_for(arguments, folder, scene, modulus, hidden, misfit):
    """The effect's strength at which it moves the body by about `misfit` of its motion; on the coarse mesh, which is quick."""
    if hidden == 'image_scale':  # moves the whole picture by as much
        return misfit
    strength = 0.02
    plain = None
    for _ in range(MOST_TRIALS):
        load = load_for(hidden, strength)
        if plain is None or load != 1.0:
            plain = motion(simulate(arguments, folder, scene, modulus, 'none', 0.0, load, step=TRIAL_STEP))
        changed = motion(simulate(arguments, folder, scene, modulus, hidden, strength, load, step=TRIAL_STEP))
        size = rms([[a - b for a, b in zip(x, y)] for x, y in zip(changed, plain)]) / rms(plain)
        if 0.8 < size / misfit < 1.25 or strength == STRONGEST:
            break
        strength = min(STRONGEST, strength * min(10.0, max(0.1, misfit / max(size, 1e-6))))
    return strength


def draw(task):
    """One recording with something hidden, and what the diagnosis says of it."""
    arguments, number, scene_name, hidden, misfit, memory, absent, step = task
    rng = random.Random(1000 + number)
    scene = next(s for s in scenes() + organs() if s.name == scene_name)
    begun = time.time()
    folder = os.path.join(arguments.output, 'draw_%03d' % number)
    os.makedirs(folder, exist_ok=True)
    modulus = scene.modulus * rng.uniform(0.7, 1.4)
    row = {'number': number, 'scene': scene_name, 'hidden': hidden, 'misfit': misfit, 'memory': memory, 'absent': absent}
    try:
        mesh = scene.write_mesh(folder, 'mesh', False)
        strength = 0.0 if hidden == 'none' else strength_for(arguments, folder, scene, modulus, hidden, misfit)
        load = load_for(hidden, strength)
        bag = simulate(arguments, folder, scene, modulus, hidden, strength, load, True, scene.noise, memory, number + 1, step)
        start = modulus * rng.choice((0.5, 0.7, 1.5, 2.0))
        effects = [{'elasticity': {'law': 'linear', 'young_modulus': {'prior': start, 'factor': 3.0}, 'poisson_ratio': 0.45}}]
        model = write(folder, 'model.yaml', {'mesh': mesh, 'regions': scene.regions, 'effects': effects + scene.effects_under(load),
                                             'observations': observations(scene)})
        command = [arguments.diagnose, model, bag, '--quiet', '--output', folder]
        if not absent:  # what the library lacks can only be told from the given model
            command.append('--auto')
        for name in sorted(like(hidden)) if absent and hidden != 'push' else []:
            command += ['--ignore', name]
        call(command, TIME_LIMIT)
        with open(os.path.join(folder, 'diagnosis.json')) as file:
            found = json.load(file)
    except Failed as error:
        row['failed'] = str(error)
        return row
    first, last = found['steps'][0], found['steps'][-1]
    row.update(verdict=found['verdict'], set=found['set'], final=found['final']['effects'])
    for name, value in (('strength', strength), ('modulus_error', found['final']['parameters'][MODULUS]['mean'] / modulus - 1),
                        ('seconds', found['seconds']), ('whole', time.time() - begun),
                        ('given', first['held_out_rms'] / first['noise_floor']),
                        ('held_out', last['held_out_rms'] / last['noise_floor'])):
        row[name] = float('%.5g' % value)
    row['p_values'] = [float('%.4g' % c['p_value']) for c in found['candidates']] if hidden == 'none' else []
    return row


def organ_task(arguments, number, rng):
    scene = rng.choice(organs())
    hidden = rng.choice(ORGANS[scene.name]) if rng.random() > 0.15 else 'none'
    absent = hidden != 'none' and rng.random() < 0.15
    step = 1.0 / scene.rate / rng.choice(STEPS_PER_FRAME)
    return arguments, number, scene.name, hidden, rng.choice(MISFITS), rng.choice((0.0, 0.6)), absent, step


def tasks(arguments):
    """Draws in an order of which any beginning is a fair sample."""
    rng, rng_of_pushes, rng_of_steps, rng_of_organs = (random.Random(seed) for seed in (7, 8, 9, 10))
    out = []
    for number in range(arguments.draws):
        scene = rng.choice(sorted(HIDDEN))
        hidden = rng.choice(HIDDEN[scene]) if rng.random() > 0.15 else 'none'
        absent = hidden != 'none' and rng.random() < 0.15
        out.append((arguments, number, scene, hidden, rng.choice(MISFITS), rng.choice((0.0, 0.6)), absent, STEP))
        if number % EVERY_ORGAN == 0:
            out.append(organ_task(arguments, FIRST_ORGAN + number, rng_of_organs))
        if number % EVERY != 0:
            continue
        for first, what, own, absent in ((PUSHES, 'push', rng_of_pushes, True),
                                         (LONG_STEPS, 'period_elongation', rng_of_steps, False)):
            out.append((arguments, first + number, own.choice(sorted(HIDDEN)), what, own.choice(MISFITS),
                        own.choice((0.0, 0.6)), absent, STEP))
    return out


def like(hidden):
    """The effect, and those that these recordings cannot tell from it."""
    return {hidden}.union(*(group for group in EQUIVALENTS if hidden in group))


def share(values):
    return '%5.1f %% of %d' % (100.0 * sum(values) / len(values), len(values)) if values else '    - of 0'


def tables(rows):
    good = [row for row in rows if 'failed' not in row]
    clean = [row for row in good if row['hidden'] == 'none']
    absent = [row for row in good if row['absent']]
    slow = [row for row in good if row['hidden'] == 'period_elongation']
    hidden = [row for row in good if row['hidden'] not in ('none', 'period_elongation') and not row['absent']]
    # What a clean recording leaves of a scene is its mesh's part.
    plain = {name: sorted(row['given'] for row in clean if row['scene'] == name) or [1.0] for name in {**HIDDEN, **ORGANS}}
    floor = {name: values[len(values) // 2] for name, values in plain.items()}
    leaves = {row['number'] for row in good if row['given'] > VISIBLE * floor[row['scene']]}
    seen = [row for row in hidden if row['number'] in leaves]
    faint = [row for row in hidden if row['number'] not in leaves and row['verdict'] == 'missing']
    lines = ['| figure | all that leave a misfit | %s |' % ' | '.join('misfit %g %%' % (100 * m) for m in MISFITS),
             '|---|---|' + '---|' * len(MISFITS)]

    def line(name, value):
        cells = [share([value(row) for row in seen])]
        cells += [share([value(row) for row in seen if row['misfit'] == m]) for m in MISFITS]
        lines.append('| %s | %s |' % (name, ' | '.join(cells)))
    line('the hidden effect is in the set', lambda row: row['hidden'] in row['set'])
    line('it or its equivalent is first', lambda row: bool(row['set']) and row['set'][0] in like(row['hidden']))
    line('it is first', lambda row: row['set'][:1] == [row['hidden']])
    line('it is first or second', lambda row: row['hidden'] in row['set'][:2])
    line('E within 3 % after adding', lambda row: abs(row['modulus_error']) < 0.03)
    line('held-out error within 1.2x of the noise', lambda row: row['held_out'] < 1.2)
    ratios = sorted(row['held_out'] for row in seen)
    silent = [(row['hidden'], row['verdict'] != 'missing') for row in absent if row['number'] in leaves]
    lines += ['', '* false alarms on clean recordings: ' + share([row['verdict'] == 'missing' for row in clean]),
              '* abstention when the effect is not in the library: ' + share([no for _, no in silent]),
              '  * an unrecorded load: ' + share([no for what, no in silent if what == 'push']),
              '  * an effect that was taken out of the library, with its equivalents: ' +
              share([no for what, no in silent if what != 'push']),
              '* p-values below 5 %% on clean recordings: %s' % share([p < 0.05 for row in clean for p in row['p_values']]),
              '* held-out error over noise after adding: median %.3f' % (ratios[len(ratios) // 2] if ratios else float('nan')),
              '* hidden but within the noise after the fit of E: %d of %d' % (len(hidden) - len(seen), len(hidden)),
              '  * named all the same: %d; in the set: %s, first: %s' % (
                  len(faint), share([row['hidden'] in row['set'] for row in faint]),
                  share([row['set'][:1] == [row['hidden']] for row in faint])),
              '* truths in long time steps that leave a misfit: period elongation is first in %s, unexplained: %s' % (
                  share([row['set'][:1] == ['period_elongation'] for row in slow if row['number'] in leaves]),
                  share([row['verdict'] == 'unexplained' for row in slow if row['number'] in leaves])),
              '* failed: %d of %d' % (len(rows) - len(good), len(rows))]
    return lines, confusion(seen)


def confusion(rows):
    counts = collections.Counter((row['hidden'], row['set'][0] if row['set'] else row['verdict']) for row in rows)
    names = sorted({hidden for hidden, _ in counts})
    found = sorted({first for _, first in counts}, key=lambda f: (f not in names, f))
    return names, found, [[counts[name, first] for first in found] for name in names]


def confusion_table(names, found, counts):
    lines = ['| hidden \\ first found | ' + ' | '.join(found) + ' |', '|---|' + '---|' * len(found)]
    for name, row in zip(names, counts):
        lines.append('| %s | %s |' % (name, ' | '.join(str(count) if count else '' for count in row)))
    return lines


def picture(names, found, counts, path):
    figure, axis = plt.subplots(figsize=(1.5 + 0.7 * len(found), 1.2 + 0.45 * len(names)))
    shares = [[count / max(1, sum(row)) for count in row] for row in counts]
    axis.imshow(shares, cmap='Blues', vmin=0, vmax=1, aspect='auto')
    for i, row in enumerate(counts):
        for j, count in enumerate(row):
            if count:
                axis.text(j, i, count, ha='center', va='center', color='white' if shares[i][j] > 0.5 else '#333333')
    axis.set_xticks(range(len(found)), [name.replace('_', ' ') for name in found], rotation=35, ha='right')
    axis.set_yticks(range(len(names)), [name.replace('_', ' ') for name in names])
    axis.set_xlabel('found first')
    axis.set_ylabel('hidden')
    save(figure, path, 110)


def keep(rows, path):
    """One draw a line."""
    lines = [json.dumps(row, sort_keys=True) for row in sorted(rows, key=lambda row: row['number'])]
    with open(path, 'w') as file:
        file.write('[' + ',\n'.join(lines) + ']\n')


def main():
    parser = argparse.ArgumentParser(prog='hidden_effects')
    parser.add_argument('root')
    parser.add_argument('--draws', type=int, default=200)
    parser.add_argument('--jobs', type=int, default=os.cpu_count())
    parser.add_argument('--output')
    parser.add_argument('--resume', action='store_true', help='keep the draws that are in doc/hidden_effects.json already: of the same search')
    parser.add_argument('--page-only', action='store_true', help='write the page from those draws, without new ones')
    arguments = parser.parse_args()
    arguments.output = os.path.abspath(arguments.output or os.path.join(arguments.root, 'output', 'hidden_effects'))
    for tool in ('simulate', 'diagnose'):
        setattr(arguments, tool, os.path.join(arguments.root, 'build/devel/lib/tissue_stiffness', tool))
    os.makedirs(arguments.output, exist_ok=True)
    doc = os.path.join(arguments.root, 'doc')
    kept = os.path.join(doc, 'hidden_effects.json')
    planned = {task[1]: task for task in tasks(arguments)}
    rows = []
    if (arguments.resume or arguments.page_only) and os.path.exists(kept):
        with open(kept) as file:
            rows = [row for row in json.load(file) if row['number'] in planned]
    done = planned if arguments.page_only else {row['number'] for row in rows}
    with multiprocessing.Pool(arguments.jobs) as pool:
        for row in pool.imap_unordered(draw, [task for number, task in planned.items() if number not in done]):
            rows.append(row)
            what = row.get('failed') or '%s %s' % (row['verdict'], ' '.join(row['set']))
            print('%3d/%d %-28s %-22s %4.0f %% -> %s' % (len(rows), len(planned), row['scene'], row['hidden'] +
                  (' (absent)' if row['absent'] else ''), 100 * row['misfit'], what), flush=True)
            keep(rows, kept)
    lines, (names, found, counts) = tables(rows)
    with open(os.path.join(doc, 'hidden_effects.md'), 'w') as file:
        file.write('\n'.join(['# How often the hidden effect is found', '',
                              '`scripts/hidden_effects --draws %d` writes this page. `benchmark/hidden_effects/scenes.py` says what '
                              'is hidden and how, and `doc/hidden_effects.json` holds the result of each draw.' % arguments.draws,
                              ''] + lines +
                             ['', '![confusion](hidden_effects.png)', ''] + confusion_table(names, found, counts)) + '\n')
    picture(names, found, counts, os.path.join(doc, 'hidden_effects.png'))
    print('\n'.join(lines))


if __name__ == '__main__':
    sys.exit(main())
