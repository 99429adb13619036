"""Mutants of the core layers: see scripts/mutate.

A mutant is a source file with one change, drawn with a seed: another comparison, sign, factor, bound or logic, a negated
condition, a statement left out, a number doubled. The tests of its layer are built and run until one fails, the quick ones
first. A mutant is killed when a test fails or the tests take several times as long as usual. What does not compile is not
counted. With --page it writes what it found, with the reasons of test/mutants.json why survivors survive.
"""
import argparse
import collections
import json
import os
import random
import re
import subprocess
import sys
import tempfile

# The tests that ought to notice a change in a layer; the first one that does ends the search.
TESTS = {'filter': ['filter'], 'fem': ['fem'], 'effects': ['effects'], 'estimation': ['estimation'], 'fit': ['fit'],
         'diagnosis': ['diagnosis']}
QUICK, LONGEST = 0.5, 8.0  # s, of one test: quick ones are run first, and those beyond the second bound are not run
SLOWER = 5.0               # times the usual duration
LEAST = 20.0               # s
REASONS = os.path.join('test', 'mutants.json')

Stage = collections.namedtuple('Stage', 'test names limit')

# (name, pattern, what stands there instead)
OPERATORS = [('bound', r' <= ', ' < '), ('bound', r' < (?=[^<>]*[;)&|])', ' <= '), ('bound', r' >= ', ' > '), ('bound', r' > (?=[^<>]*[;)&|])', ' >= '),
             ('comparison', r' == ', ' != '), ('comparison', r' != ', ' == '), ('comparison', r' < (?=[^<>]*[;)&|])', ' > '),
             ('logic', r' && ', ' || '), ('logic', r' \|\| ', ' && '), ('logic', r'\bif \((?=[^;]*\) )', 'if (!('),
             ('sign', r' \+ ', ' - '), ('sign', r' - ', ' + '), ('sign', r' \+= ', ' -= '), ('sign', r' -= ', ' += '),
             ('factor', r' \* ', ' / '), ('factor', r' / ', ' * '), ('extreme', r'std::min\b', 'std::max'), ('extreme', r'std::max\b', 'std::min'),
             ('truth', r'\btrue\b', 'false'), ('truth', r'\bfalse\b', 'true'),
             ('number', r'(?<= = )(\d+\.\d+(?:e-?\d+)?)(?=;)', r'2.0 * \1'), ('left out', r'^  +[\w.>\-\[\]()]+ [-+*]?= [^;]*;$', '')]


def code_of(line):
    """The line without its comment; empty for includes, declarations of templates and lines with texts."""
    if re.match(r'\s*(//|#|template|using|static_assert|namespace|case )', line) or '"' in line:
        return ''
    return line.split('//')[0].rstrip()


def changed(code, operator):
    """All lines that the operator makes of one."""
    name, pattern, instead = operator
    for found in re.finditer(pattern, code):
        line = code[:found.start()] + found.expand(instead) + code[found.end():]
        if instead == 'if (!(':  # the condition ends before the last ') ' of the line
            end = line.rindex(') ')
            line = line[:end] + ')' + line[end:]
        if line != code:
            yield name, line


def mutants_of(root, path):
    with open(os.path.join(root, path)) as file:
        for number, line in enumerate(file.read().split('\n')):
            code = code_of(line)
            for operator in OPERATORS if code else ():
                for name, new in changed(code, operator):
                    yield {'file': path, 'line': number + 1, 'operator': name, 'before': code.strip(), 'after': new}


def sample(root, layer, count, seed):
    folder = os.path.join(root, 'src', layer)
    every = [mutant for name in sorted(os.listdir(folder)) if name.endswith('.cpp')
             for mutant in mutants_of(root, os.path.join('src', layer, name))]
    random.Random(seed).shuffle(every)
    return len(every), every[:count]


def build(root, tests):
    targets = ['test_' + test for test in tests]
    done = subprocess.run(['cmake', '--build', os.path.join(root, 'build'), '--parallel', '2', '--target', *targets], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT)
    return done.returncode == 0


def run(root, test, *options, limit=None):
    """Whether all tests of a program pass in time."""
    program = os.path.join(root, 'build', 'devel', 'lib', 'tissue_stiffness', 'test_' + test)
    try:
        done = subprocess.run([program, *options], cwd=os.path.join(root, 'test'), stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, timeout=limit)
    except subprocess.TimeoutExpired:
        return False
    return done.returncode == 0


def passes(root, stage):
    return run(root, stage.test, '--gtest_break_on_failure', '--gtest_filter=' + ':'.join(stage.names), limit=stage.limit)


def verdict(root, mutant, tests, stages):
    path = os.path.join(root, mutant['file'])
    with open(path) as file:
        text = file.read()
    lines = text.split('\n')
    lines[mutant['line'] - 1] = mutant['after']
    try:
        with open(path, 'w') as file:
            file.write('\n'.join(lines))
        if not build(root, tests):
            return 'not compiled'
        return 'survived' if all(passes(root, stage) for stage in stages) else 'killed'
    finally:
        with open(path, 'w') as file:
            file.write(text)


def durations(root, test):
    """The usual seconds of each test of a program."""
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, 'times.json')
        if not run(root, test, '--gtest_output=json:' + file):
            sys.exit('mutate: test_%s fails without a change' % test)
        with open(file) as content:
            suites = json.load(content)['testsuites']
    return {'%s.%s' % (suite['name'], case['name']): float(case['time'].rstrip('s')) for suite in suites for case in suite['testsuite']}


def stages_of(root, tests):
    """All quick tests of all programs, then the slower ones."""
    if not build(root, tests):
        sys.exit('mutate: the tests do not build')
    quick, slow = [], []
    for test in tests:
        times = durations(root, test)
        for stages, least, most in ((quick, 0.0, QUICK), (slow, QUICK, LONGEST)):
            names = [name for name, seconds in times.items() if least <= seconds < most]
            if names:
                stages.append(Stage(test, names, max(LEAST, SLOWER * sum(times[name] for name in names))))
    return quick + slow


def key_of(mutant):
    return '%(file)s:%(line)d: %(before)s -> %(after)s' % dict(mutant, after=mutant['after'].strip() or '(left out)')


def place_of(key):
    """The key without the number of the line, which other changes move."""
    return re.sub(r':\d+: ', ': ', key, count=1)


def write_page(root, layers, path):
    """layers: {layer: (number of all mutants, the drawn ones with their verdicts)}"""
    with open(os.path.join(root, REASONS)) as file:
        reasons = {place_of(key): reason for key, reason in json.load(file).items()}
    lines = ['# Mutants', '',
             '`scripts/mutate` changes one place of the code at a time and runs the tests of the layer. A mutant is killed when a test '
             'fails. This page is written by `scripts/mutate --page`. Tests that take longer than %g s are left out, so the scores are '
             'lower bounds. But tests were written for survivors of these very samples, so another seed tells more.' % LONGEST, '', '| layer | mutants in all | drawn | not compiled | killed | survived | score |', '|---|---|---|---|---|---|---|']
    for layer, (total, drawn) in layers.items():
        found = collections.Counter(mutant['verdict'] for mutant in drawn)
        counted = found['killed'] + found['survived']
        lines.append('| %s | %d | %d | %d | %d | %d | %.0f %% |' % (
            layer, total, len(drawn), found['not compiled'], found['killed'], found['survived'], 100.0 * found['killed'] / max(1, counted)))
    lines += ['', '## Survivors', '', '| change | why it survives |', '|---|---|']
    for _, drawn in layers.values():
        for mutant in drawn:
            if mutant['verdict'] == 'survived':
                key = key_of(mutant)
                lines.append('| `%s` | %s |' % (key.replace('|', '\\|'), reasons.get(place_of(key), 'Nobody has looked yet.')))
    with open(path, 'w') as file:
        file.write('\n'.join(lines) + '\n')


def main():
    parser = argparse.ArgumentParser(prog='mutate', description=__doc__.split('\n')[0])
    parser.add_argument('root')
    parser.add_argument('--layers', default=','.join(TESTS), help='as in filter:20,fem')
    parser.add_argument('--each', type=int, default=10, help='mutants of each layer that has no number')
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--again', action='store_true', help='try those again that survived, as after a change of the tests')
    parser.add_argument('--page', help='file for the scores and the survivors')
    parser.add_argument('--output', help='what is known so far; default: mutants.json in .mutate')
    arguments = parser.parse_args()
    output = arguments.output or os.path.join(arguments.root, '..', 'mutants.json')
    known, layers = {}, {}
    if os.path.exists(output):
        with open(output) as file:
            known = json.load(file)
    for wanted in arguments.layers.split(','):
        layer, _, count = wanted.partition(':')
        if layer not in TESTS or not (count or '1').isdigit():
            parser.error('--layers: found %s; allowed: %s, each with a number behind a colon or without' % (wanted, ', '.join(TESTS)))
        total, drawn = sample(arguments.root, layer, int(count or arguments.each), arguments.seed)
        stages = None
        for mutant in drawn:
            key = key_of(mutant)
            if known.get(key, 'survived') == 'survived' and (arguments.again or key not in known):
                stages = stages or stages_of(arguments.root, TESTS[layer])
                known[key] = verdict(arguments.root, mutant, TESTS[layer], stages)
                with open(output + '.part', 'w') as file:
                    json.dump(known, file, indent=1)
                os.replace(output + '.part', output)
            print('%-12s %s' % (known[key], key), flush=True)
            mutant['verdict'] = known[key]
        layers[layer] = (total, drawn)
        found = collections.Counter(mutant['verdict'] for mutant in drawn)
        print('%s: %d of %d mutants drawn: %d killed, %d survived, %d not compiled' % (
            layer, len(drawn), total, found['killed'], found['survived'], found['not compiled']), flush=True)
    if arguments.page:
        write_page(arguments.root, layers, arguments.page)


if __name__ == '__main__':
    main()
