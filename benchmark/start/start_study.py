"""Recordings that begin in mid-motion: the first part of a recording of the independent simulator is cut off. Is E right,
and does its interval hold, with `initial_motion`, and what does the estimator say without it?
usage: start_study.py ROOT [--output FOLDER] [--truths N] [--estimate PROGRAM]"""
import argparse
import json
import os
import shutil
import subprocess
import sys

import numpy as np
import rosbag
import yaml

from draw_folders import estimated, write_model
from foreign_draws import draw_list, write_draw
from foreign_study import simulate_truths, truth_folder
from study_arguments import study_arguments
from study_pages import judged_modulus, write_page
from tool_runs import Failed

SHARES = (0.3, 0.55)  # of the recording that are cut off
KINDS = ('stated', 'correlated', 'one side', 'few sensors')
LENGTH, SPEED = 0.1, 1.0  # priors of the motions, 1 sigma, over the body's size [1, 1/s]
WANTED = 0.03


def draws(count):
    """One clean draw of each truth; the sensors vary."""
    out, names = [], set()
    for draw in draw_list():
        if draw['class'] != 'clean' or draw['truth'] in names:
            continue
        names.add(draw['truth'])
        out.append(dict(draw, kind=KINDS[len(out) % len(KINDS)]))
    return out[:count]


def cut(source, target, share):
    with rosbag.Bag(source) as bag, rosbag.Bag(target, 'w') as out:
        begin, end = bag.get_start_time(), bag.get_end_time()
        for topic, message, time in bag.read_messages(raw=False):
            if topic == '/tf_static' or time.to_sec() >= begin + share * (end - begin):
                out.write(topic, message, time)


def size_of(mesh):
    """The diagonal of a legacy VTK file's points."""
    with open(mesh) as file:
        words = file.read().split()
    first = words.index('POINTS')
    points = np.array(words[first + 3:first + 3 + 3 * int(words[first + 1])], float).reshape(-1, 3)
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def with_motion(model, size):
    def vector(std):
        return {'mean': [0.0, 0.0, 0.0], 'std': float(std)}
    length, speed = LENGTH * size, SPEED * size
    model['effects'].append({'initial_motion': {
        'displacement': vector(length), 'velocity': vector(speed),
        'second_displacement': vector(0.1 * length), 'second_velocity': vector(speed)}})
    return model


def answered(args, model, folder, name):
    """The results, or None and why there are none."""
    write_model(folder, model, name)
    try:
        return estimated(args.estimate, folder, name, bags=['cut.bag'], options=['--allow-outside']), ''
    except Failed as error:
        return None, str(error)


def diagnosed(args, bag, folder, name):
    """The verdict on the right model, whose recording hides nothing."""
    output = os.path.join(folder, 'diagnosis')
    subprocess.run([os.path.join(os.path.dirname(args.estimate), 'diagnose'), os.path.join(folder, name + '.yaml'), bag, '--allow-outside', '--output',
                    output], capture_output=True, check=False)
    with open(os.path.join(output, 'diagnosis.json')) as file:
        return json.load(file)['verdict']


def page(rows):
    known = [row for row in rows if row['with'] and row['with']['state'] == 'converged']
    errors = np.abs([row['with']['error'] for row in known])
    inside = sum(row['with']['inside'] for row in known)
    lines = ['# A recording that begins in mid-motion', '',
             'The truths are those of [hidden effects](hidden_effects_foreign.md), from an independent simulator. The first part of each '
             'recording is cut off, so the body is loaded and moves when it begins. The model says so with `initial_motion`, whose priors are wide. '
             '`scripts/measure_start` prints this page.', '',
             '%d recordings: %d converged. Their error is %.1f %% in the median and %.1f %% at most (wanted: %.0f %%); it is within %.0f %% in %d. '
             'The interval holds the truth in %d of %d. `diagnose` says `adequate` or `numerics` in %d, `missing` in %d.' % (
                 len(rows), len(known), 100 * np.median(errors), 100 * errors.max(), 100 * WANTED, 100 * WANTED,
                 int((errors <= WANTED).sum()), inside, len(known),
                 sum(row['verdict'] in ('adequate', 'numerics') for row in rows), sum(row['verdict'] == 'missing' for row in rows)), '',
             '| truth | cut off | sensors | E | interval | state | diagnosis | E and state without the effect |', '|---|---|---|---|---|---|---|---|']
    for row in rows:
        own, plain = row['with'], row['without']
        told = 'refused' if own is None else '%+.1f %% | +-%.1f %%, %s | %s' % (
            100 * own['error'], 100 * own['width'], 'holds' if own['inside'] else '**misses**', own['state'])
        without = 'refused' if plain is None else '%+.0f %%, %s' % (100 * plain['error'], plain['state'])
        lines.append('| %s | %.0f %% | %s | %s | %s | %s |' % (
            row['truth'], 100 * row['share'], row['kind'], told, row['verdict'], without))
    return '\n'.join(lines) + '\n'


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--truths', type=int, default=16)
    args = study_arguments(parser, 'estimate', 'hidden_effects')
    chosen = draws(args.truths)
    simulate_truths(args, [draw['truth'] for draw in chosen])
    rows = []
    for draw in chosen:
        source = truth_folder(args, draw['truth'])
        for share in SHARES:
            folder = os.path.join(args.output, 'starts', '%s_%.0f' % (draw['truth'], 100 * share))
            shutil.rmtree(folder, ignore_errors=True)
            os.makedirs(folder)
            truth = write_draw(draw, source, folder)['young_modulus'][0]
            bag = os.path.join(folder, 'cut.bag')
            cut(os.path.join(folder, 'recording.bag'), bag, share)
            with open(os.path.join(folder, 'model.yaml')) as file:
                model = yaml.safe_load(file)
            model['mesh']['file'] = os.path.abspath(os.path.join(folder, model['mesh']['file']))
            row = {'truth': draw['truth'], 'kind': draw['kind'], 'share': share}
            plain, error = answered(args, model, folder, 'plain')
            row['without'] = judged_modulus(plain, truth) if plain else None
            moving, error = answered(args, with_motion(model, size_of(model['mesh']['file'])), folder, 'moving')
            row['with'] = judged_modulus(moving, truth) if moving else None
            row['verdict'] = diagnosed(args, bag, folder, 'moving')
            rows.append(row)
            print(row['truth'], row['kind'], share, row['with'] or error, row['verdict'], row['without'], flush=True)
    write_page(args, 'start.md', page(rows))


if __name__ == '__main__':
    sys.exit(main())
