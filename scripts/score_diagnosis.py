"""The table of what `diagnose` finds in recordings that hide an effect: see scripts/score_diagnosis."""
import argparse
import glob
import json
import os
import sys
import time

import yaml

from tool_runs import Failed, call

MODULUS = 'elasticity.young_modulus'
TIME_LIMIT = 300      # s a case
SECONDS = 20          # s, of a diagnosis
MODULUS_ERROR = 0.03  # after the effect is added
FACETED_ERROR = 0.05  # the same on a mesh whose flat facets stand for a curved wall
HELD_OUT = 1.2        # times the noise
FACETED = 'ventricle'


def run(arguments, name):
    case = os.path.join(arguments.shared, 'cases', name)
    output = os.path.join(arguments.output, name)
    command = [arguments.diagnose, os.path.join(case, 'model.yaml'), os.path.join(case, 'recording.bag'), '--auto', '--quiet',
               '--output', output]
    begun = time.monotonic()
    call(command, TIME_LIMIT)
    with open(os.path.join(output, 'diagnosis.json')) as file:
        return dict(json.load(file), whole=time.monotonic() - begun)


def score(diagnosis, truth):
    hidden, last = truth['effect'], diagnosis['steps'][-1]
    found = diagnosis['set']
    answer, modulus = diagnosis['final']['parameters'][MODULUS], float(truth['young_modulus'])
    error = answer['mean'] / modulus - 1
    low, high = answer['interval95']
    bound = FACETED_ERROR if FACETED in str(truth.get('scene', '')) else MODULUS_ERROR
    return {
        'verdict': diagnosis['verdict'] == ('adequate' if hidden == 'none' else 'missing'),
        'set': not found if hidden == 'none' else hidden in found,
        'first': not found if hidden == 'none' else found[:1] == [hidden],
        'E': abs(error) <= bound,
        'interval': low <= modulus <= high,
        'held-out': last['held_out_rms'] <= HELD_OUT * last['noise_floor'],
        'time': diagnosis['seconds'] <= SECONDS,
    }, error


def main():
    parser = argparse.ArgumentParser(prog='score_diagnosis')
    parser.add_argument('root')
    parser.add_argument('names', nargs='*')
    parser.add_argument('--diagnose')
    parser.add_argument('--shared')
    parser.add_argument('--output')
    arguments = parser.parse_intermixed_args()
    arguments.diagnose = arguments.diagnose or os.path.join(arguments.root, 'build/devel/lib/tissue_stiffness/diagnose')
    arguments.shared = arguments.shared or os.path.join(arguments.root, '..', 'shared')
    arguments.output = arguments.output or os.path.join(arguments.root, 'output', 'score_diagnosis')
    truths = sorted(glob.glob(os.path.join(arguments.shared, 'cases_truth', 'case_*.yaml')))
    names = arguments.names or [os.path.splitext(os.path.basename(path))[0] for path in truths]
    if not names:
        sys.exit('score_diagnosis: no case in %s/cases_truth' % arguments.shared)

    print('%-8s %-22s %-11s %-44s %-28s %8s %9s %6s %6s  %s' %
          ('case', 'hides', 'verdict', 'set', 'added', 'E off', 'held-out', 's', 'whole', 'wrong'))
    totals = {}
    for name in names:
        with open(os.path.join(arguments.shared, 'cases_truth', name + '.yaml')) as file:
            truth = yaml.safe_load(file)
        try:
            diagnosis = run(arguments, name)
        except Failed as error:
            print('%-8s %-22s %s' % (name, truth['effect'], error), flush=True)
            continue
        right, error = score(diagnosis, truth)
        for key, value in right.items():
            totals.setdefault(key, []).append(value)
        if truth['effect'] != 'none':
            totals.setdefault('first of hidden', []).append(right['first'])
        last = diagnosis['steps'][-1]
        print('%-8s %-22s %-11s %-44s %-28s %+7.2f%% %8.2fx %6.1f %6.1f  %s' %
              (name, truth['effect'], diagnosis['verdict'], ' '.join(diagnosis['set']),
               ' '.join(diagnosis['final']['effects']), 100 * error, last['held_out_rms'] / last['noise_floor'],
               diagnosis['seconds'], diagnosis['whole'], ', '.join(key for key, value in right.items() if not value)), flush=True)
    for key, values in totals.items():
        print('%-16s %d of %d' % (key, sum(values), len(values)))
    cases = len(names)
    hidden = len(totals.get('first of hidden', []))
    enough = (sum(totals.get('verdict', [])) >= cases - 1 and sum(totals.get('set', [])) >= cases - 1 and
              sum(totals.get('first of hidden', [])) >= hidden - 1)
    sys.exit(0 if enough else 1)


if __name__ == '__main__':
    main()
