"""Draws recordings whose inputs or model are wrong in a known way, and counts how often the published interval holds the
truth: see scripts/measure_trust."""
import argparse
import collections
import csv
import json
import multiprocessing
import multiprocessing.pool
import os
import shutil
import subprocess
import sys

import numpy as np
import yaml

import errors
import foreign
from figures import plt, save
from organs import organs
from scenes import scenes
from study import HIDDEN, ORGANS, MODULUS, load_for, observations, simulate
from tool_runs import Failed, call

LEVELS = (0.02, 0.05, 0.1, 0.2, 0.5)  # of the load
BEYOND = {'density': 2.5}             # default tolerances that a constant is off, if it is not one; others: 5
STRENGTHS = (0.1, 0.3, 1.0)           # of a hidden effect; 1: about as large as tissue has it
VARIANTS = 2                          # bodies of each scene
STEP = 0.002                          # s, of a truth of our own
STARTS = (0.5, 0.7, 1.5, 2.0)         # prior over truth
HEAVY = ('block', 'ventricle filled')  # bodies of our own whose meshes take long: two draws of five
READY = 30                            # frames after which a clean recording should be converged
TIME_LIMIT = 300                      # s a run
COLOURS = {'converged': '#1a7f37', 'doubtful': '#d29922', 'model_invalid': '#cf222e', 'converging': '#57606a',
           'drifting': '#8250df', 'stale': '#6e7781', 'no_data': '#000000'}


def loaded(name):
    return name.startswith(('cube', 'ventricle', 'case_06', 'case_10', 'case_11', 'bar pushed', 'slab', 'block'))


def weighed(name):
    return name.startswith(('bar_', 'bar released', 'case_01', 'case_02', 'case_04', 'case_11', 'case_12'))


def wrong_inputs(names, rng, repeats):
    """(name, kind, level): each kind at each level so many times, in bodies that have such an input."""
    rows = []
    with_load = [name for name in names if loaded(name)]
    with_force = [name for name in with_load if not name.startswith(('ventricle', 'case_06'))]
    for kind in errors.LOADS:
        for level in LEVELS:
            for name in rng.choice(with_force if kind == 'direction' else with_load, repeats):
                rows.append((str(name), kind, level))
    for kind in errors.CONSTANTS:
        for sigmas in (1.0, BEYOND.get(kind, 5.0)):
            for name in rng.choice([n for n in names if kind != 'gravity' or weighed(n)], repeats):
                rows.append((str(name), kind, sigmas))
    return rows


def tasks(arguments):
    rng = np.random.default_rng(11)
    own = [scene.name for scene in scenes() + organs()]
    rows = [('own', str(name), 'none', 0.0) for name in rng.choice(own, 70)]
    rows += [('own', str(name), 'typical', 1.0) for name in rng.choice([n for n in own if loaded(n)], 50)]
    rows += [('own', *row) for row in wrong_inputs(own, rng, 8)]
    choices = {**HIDDEN, **ORGANS}
    for strength in STRENGTHS:
        for name in rng.choice(own, 25):
            hidden = str(rng.choice([effect for effect in choices[name] if effect != 'none']))
            rows.append(('own', str(name), 'hidden ' + hidden, strength))
    truths = sorted(foreign.TOLD) + foreign.CLEAN
    rows += [('foreign', name, 'none', 0.0) for name in truths]
    rows += [('foreign', str(name), 'typical', 1.0) for name in rng.choice([n for n in truths if loaded(n)], 20)]
    rows += [('foreign', *row) for row in wrong_inputs(truths, rng, 3)]
    rows += [('foreign', 'case_%02d' % k, 'hidden', 0.0) for k in range(2, 13) if k != 6]
    rows += [('foreign', name, 'hidden', 0.0) for name in foreign.HIDDEN]
    order = np.random.default_rng(12).permutation(len(rows))  # any beginning is a fair sample
    rows = [(number, *row) for number, row in enumerate(rows)]
    order = [k for k in order if not rows[k][2].startswith(HEAVY) or k % 5 < 2]
    return [(arguments, *rows[k]) for k in order[:arguments.draws or None]]


def own_truth(arguments, name, hidden, strength, variant):
    """Simulates one of our own bodies without noise, where it is not there yet; returns its folder."""
    folder = os.path.join(arguments.output, 'own', '%s %s %g %d' % (name, hidden, strength, variant))
    if os.path.exists(os.path.join(folder, 'truth.yaml')):
        return folder
    os.makedirs(folder, exist_ok=True)
    scene = next(s for s in scenes() + organs() if s.name == name)
    modulus = float(scene.modulus * np.random.default_rng(variant).uniform(0.7, 1.4))
    load = load_for(hidden, strength)
    simulate(arguments, folder, scene, modulus, hidden, strength, load, True, step=STEP)
    mesh = scene.write_mesh(folder, 'mesh', False)
    effects = [{'elasticity': {'law': 'linear', 'young_modulus': None, 'poisson_ratio': 0.45}}] + scene.effects_under(load)
    errors.write_yaml(os.path.join(folder, 'model.yaml'), {'mesh': mesh, 'regions': scene.regions, 'effects': effects,
                                                           'observations': observations(scene)})
    errors.write_yaml(os.path.join(folder, 'truth.yaml'), {'young_modulus': modulus})
    return folder


def truth_of(arguments, ground, name, kind, level, number):
    """Folder with model.yaml and recording.bag, file with the true modulus, and the noise that is still to be added [m]."""
    if ground == 'own':
        hidden, strength = (kind[7:], level) if kind.startswith('hidden') else ('none', 0.0)
        folder = own_truth(arguments, name, hidden, strength, number % VARIANTS)
        return folder, os.path.join(folder, 'truth.yaml'), next(s for s in scenes() + organs() if s.name == name).noise
    if name.startswith('case'):
        return (os.path.join(arguments.shared, 'cases', name), os.path.join(arguments.shared, 'cases_truth', name + '.yaml'), 0.0)
    folder = os.path.join(arguments.output, 'foreign', name)
    return folder, os.path.join(folder, 'truth.yaml'), foreign.NOISE


def read_yaml(path):
    with open(path) as file:
        return yaml.safe_load(file)


def draw(task):
    """One recording with something wrong, and what the estimator publishes, frame by frame."""
    arguments, number, ground, name, kind, level = task
    rng = np.random.default_rng(5000 + number)
    folder = os.path.join(arguments.output, 'draw_%04d' % number)
    os.makedirs(folder, exist_ok=True)
    row = {'number': number, 'ground': ground, 'name': name, 'kind': kind, 'level': level}
    try:
        source, truth, noise = truth_of(arguments, ground, name, kind, level, number)
        model, modulus = read_yaml(os.path.join(source, 'model.yaml')), read_yaml(truth)['young_modulus']
        model['mesh']['file'] = os.path.join(source, model['mesh']['file'])
        if ground == 'foreign' and not kind.startswith('hidden'):
            model['effects'] += foreign.TOLD.get(name, [])
        change = move = None
        if kind in errors.LOADS:
            change = lambda times, load: errors.wrong_load(kind, level, times, load, rng)  # noqa: E731
        elif kind == 'typical':
            change = lambda times, load: errors.typical_load(times, load, rng)  # noqa: E731
        elif kind in errors.CONSTANTS:
            move = errors.wrong_constant(kind, level, model, folder, rng)
        recording = os.path.join(folder, 'wrong.bag')
        errors.rewrite(os.path.join(source, 'recording.bag'), recording, change, move, noise, rng)
        prior = {'prior': float(modulus * rng.choice(STARTS)), 'factor': 3.0}
        errors.of_effect(model, 'elasticity')[0]['young_modulus'] = prior
        model_file = errors.write_yaml(os.path.join(folder, 'model.yaml'), model)
        call([arguments.estimate, model_file, recording, '--output', folder, '--quiet', '--allow-outside'], TIME_LIMIT)
        row.update(published(os.path.join(folder, 'estimates.csv'), modulus))
    except Failed as error:
        row['failed'] = str(error)
    if not arguments.keep:
        shutil.rmtree(folder)
    return row


def published(path, modulus):
    """States, and whether the interval holds the truth in the frames that are called converged."""
    with open(path) as file:
        frames = list(csv.DictReader(file))
    columns = {part: '%s.%s [Pa]' % (MODULUS, part) for part in ('mean', 'lower95', 'upper95')}
    values = {part: np.array([float(frame[column] or 'nan') for frame in frames]) / modulus for part, column in columns.items()}
    state = np.array([frame['state'] for frame in frames])
    converged = state == 'converged'
    holds = (values['lower95'] <= 1.0) & (values['upper95'] >= 1.0)
    return {'frames': len(frames), 'converged': int(converged.sum()), 'held': int((converged & holds).sum()),
            'state': str(state[-1]), 'reason': frames[-1]['state_reason'], 'ready': bool(converged[READY:READY + 1].any()),
            'holds': bool(holds[-1]), **{part: float('%.4g' % v[-1]) for part, v in values.items()}}


def wilson(hits, count):
    """95 % interval of a share."""
    z, p = 1.96, hits / count
    middle, half = p + z * z / (2 * count), z * np.sqrt(p * (1 - p) / count + z * z / (4 * count * count))
    return max(0.0, middle - half) / (1 + z * z / count), (middle + half) / (1 + z * z / count)


def shown_share(hits, count):
    return '-' if count == 0 else '%.1f %% of %d (%.0f to %.0f)' % (100.0 * hits / count, count,
                                                                    *(100.0 * bound for bound in wilson(hits, count)))


def frame_share(rows):
    """Of the frames that are called converged; its interval by resampling draws, whose frames go together."""
    held, all_frames = (np.array([row[key] for row in rows], float) for key in ('held', 'converged'))
    if all_frames.sum() == 0:
        return '-'
    picks = np.random.default_rng(13).integers(len(rows), size=(2000, len(rows)))
    totals = all_frames[picks].sum(axis=1)
    shares = held[picks].sum(axis=1)[totals > 0] / totals[totals > 0]
    return '%.1f %% of %d (%.0f to %.0f)' % (100.0 * held.sum() / all_frames.sum(), all_frames.sum(),
                                             *(100.0 * np.percentile(shares, q) for q in (2.5, 97.5)))


def group(row):
    return 'hidden effect' if row['kind'].startswith('hidden') else row['kind']


def table(rows, key):
    groups = collections.defaultdict(list)
    for row in rows:
        groups[key(row)].append(row)
    lines = ['| what is wrong | draws | converged frames that hold the truth | draws that end converged: hold the truth | all '
             'draws: last interval holds the truth | last states |', '|---|---|---|---|---|---|']
    for name in sorted(groups) + ['all']:
        some = rows if name == 'all' else groups[name]
        sure = [row for row in some if row['state'] == 'converged']
        states = collections.Counter(row['state'] for row in some)
        lines.append('| %s | %d | %s | %s | %s | %s |' % (
            name, len(some), frame_share(some), shown_share(sum(row['holds'] for row in sure), len(sure)),
            shown_share(sum(row['holds'] for row in some), len(some)),
            ', '.join('%d %s' % (count, state) for state, count in states.most_common())))
    return lines


def page(rows):
    good = [row for row in rows if 'failed' not in row]
    clean = [row for row in good if row['kind'] == 'none']
    lines = ['## By what is wrong', ''] + table(good, group)
    lines += ['', '## By whose truth', ''] + table(good, lambda row: row['ground'] + (' recordings' if row['ground'] == 'own' else ' truths'))
    lines += ['', '## By the size of a load\'s error', ''] + table([r for r in good if r['kind'] in errors.LOADS],
                                                                   lambda row: '%02.0f %% of the load' % (100 * row['level']))
    lines += ['', '## By the size of a constant\'s error', ''] + table([r for r in good if r['kind'] in errors.CONSTANTS],
                                                                      lambda row: '%g times its tolerance' % row['level'])
    lines += ['', '## Clean recordings', '',
              '* converged at frame %d: %s' % (READY, shown_share(sum(row['ready'] for row in clean), len(clean))),
              '* width of the last 95 %% interval over E: median %.3f' % np.median([row['upper95'] - row['lower95'] for row in clean]),
              '* failed runs of the study: %d of %d' % (len(rows) - len(good), len(rows)),
              '', '## Wrong and sure of it', '', 'These draws end `converged` beside the truth.', '',
              '| draw | truth | what is wrong | level | E over truth (95 %) |', '|---|---|---|---|---|']
    for row in sorted(good, key=lambda row: row['number']):
        if row['state'] == 'converged' and not row['holds']:
            lines.append('| %d | %s | %s | %g | %.3f (%.3f to %.3f) |' % (row['number'], row['name'], row['kind'], row['level'],
                                                                        row['mean'], row['lower95'], row['upper95']))
    return lines


def picture(rows, path):
    good = sorted((row for row in rows if 'failed' not in row), key=lambda row: (group(row), row['level'], row['mean']))
    figure, axis = plt.subplots(figsize=(14, 5))
    for x, row in enumerate(good):
        low, high = np.clip([row['lower95'], row['upper95']], 0.1, 10.0)
        axis.plot([x, x], [low, high], color=COLOURS[row['state']], linewidth=0.9, alpha=0.7)
        axis.plot(x, np.clip(row['mean'], 0.1, 10.0), '.', markersize=2.5, color=COLOURS[row['state']])
    names = [group(row) for row in good]
    edges = [x for x in range(1, len(names)) if names[x] != names[x - 1]]
    for edge in edges:
        axis.axvline(edge - 0.5, color='#d0d7de', linewidth=0.8)
    middles = [(a + b) / 2 for a, b in zip([0] + edges, edges + [len(names)])]
    axis.set_xticks(middles, [names[int(m)].replace('_', ' ') for m in middles], rotation=35, ha='right')
    axis.axhline(1.0, color='black', linewidth=0.8)
    axis.set_yscale('log')
    axis.set_ylim(0.1, 10.0)
    axis.set_xlim(-1, len(good))
    axis.set_ylabel('E over its truth, 95 % interval')
    for state in sorted({row['state'] for row in good}):
        axis.plot([], [], color=COLOURS[state], label=state)
    axis.legend(frameon=False, ncol=6, loc='upper left')
    save(figure, path, 110, [axis])


def simulate_own(task):
    try:
        own_truth(*task)
    except Failed as error:
        print(task[1:], error)  # its draws fail and are counted


def simulate_foreign(arguments, name):
    folder = os.path.join(arguments.output, 'foreign', name)
    if not os.path.exists(os.path.join(folder, 'truth.yaml')):
        os.makedirs(folder, exist_ok=True)
        script = os.path.join(arguments.root, 'benchmark/trust/foreign.py')
        subprocess.run([sys.executable, script, os.path.join(arguments.shared, 'simulator'), name, folder], check=True)
    print('simulated', name, flush=True)


def main():
    parser = argparse.ArgumentParser(prog='measure_trust')
    parser.add_argument('root')
    parser.add_argument('--draws', type=int, default=0, help='only so many (default: all)')
    parser.add_argument('--jobs', type=int, default=os.cpu_count())
    parser.add_argument('--output')
    parser.add_argument('--keep', action='store_true', help='keep the recordings of all draws')
    parser.add_argument('--resume', action='store_true', help='keep the draws that are in doc/trust.json already')
    parser.add_argument('--page-only', action='store_true', help='write the page from those draws, without new ones')
    arguments = parser.parse_args()
    arguments.output = os.path.abspath(arguments.output or os.path.join(arguments.root, 'output', 'trust'))
    arguments.shared = os.path.join(arguments.root, '..', 'shared')
    for tool in ('simulate', 'estimate'):
        setattr(arguments, tool, os.path.join(arguments.root, 'build/devel/lib/tissue_stiffness', tool))
    doc = os.path.join(arguments.root, 'doc')
    kept = os.path.join(doc, 'trust.json')
    rows = []
    if (arguments.resume or arguments.page_only) and os.path.exists(kept):
        with open(kept) as file:
            rows = json.load(file)
    if not arguments.page_only:
        with multiprocessing.pool.ThreadPool(arguments.jobs) as pool:
            pool.map(lambda name: simulate_foreign(arguments, name), foreign.CLEAN + foreign.HIDDEN)
        done = {row['number'] for row in rows}
        planned = [task for task in tasks(arguments) if task[1] not in done]
        truths = {(name, kind[7:], level, number % VARIANTS) if kind.startswith('hidden') else (name, 'none', 0.0, number % VARIANTS)
                  for _, number, ground, name, kind, level in planned if ground == 'own'}
        with multiprocessing.Pool(arguments.jobs) as pool:
            for k, _ in enumerate(pool.imap_unordered(simulate_own, [(arguments, *truth) for truth in sorted(truths)])):
                print('simulated %d of %d' % (k + 1, len(truths)), flush=True)
            for row in pool.imap_unordered(draw, planned):
                rows.append(row)
                print('%4d %-28s %-24s %4g -> %s' % (len(rows), row['name'], row['kind'], row['level'], row.get('failed') or
                      '%s %.3f (%.3f to %.3f)' % (row['state'], row['mean'], row['lower95'], row['upper95'])), flush=True)
                with open(kept, 'w') as file:
                    lines = [json.dumps(r, sort_keys=True) for r in sorted(rows, key=lambda r: r['number'])]
                    file.write('[' + ',\n'.join(lines) + ']\n')
    lines = page(rows)
    with open(os.path.join(doc, 'trust.md'), 'w') as file:
        file.write('\n'.join(['# How far a published interval is to be trusted', '',
                              '`scripts/measure_trust` writes this page. `benchmark/trust` says what is made wrong and how, and '
                              '`doc/trust.json` holds the result of each draw. Brackets hold 95 % intervals of the shares.', '',
                              '![E and its interval against the truth](trust.png)', ''] + lines) + '\n')
    picture(rows, os.path.join(doc, 'trust.png'))
    print('\n'.join(lines))


if __name__ == '__main__':
    sys.exit(main())
