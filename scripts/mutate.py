"""Mutants of the core layers: see scripts/mutate.

A mutant is a source file with one change, drawn with a seed: another comparison, sign, factor, bound or logic, a negated
condition, a statement left out, a number doubled. The tests of its layer are built and run until one fails. A mutant is killed
when a test fails or takes ten times as long as usual. What does not compile is not counted. Prints the survivors.
"""
import argparse
import json
import os
import random
import re
import subprocess
import sys
import time

# The tests that ought to notice a change in a layer; the first one that does ends the search.
TESTS = {'filter': ['filter'], 'fem': ['fem'], 'effects': ['effects', 'forward'], 'estimation': ['estimation'], 'fit': ['fit', 'estimation'],
         'diagnosis': ['diagnosis']}
SLOWER = 10.0  # times the usual duration
LEAST = 60.0   # s

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


def passes(root, test, limit):
    program = os.path.join(root, 'build', 'devel', 'lib', 'tissue_stiffness', 'test_' + test)
    try:
        done = subprocess.run([program, '--gtest_break_on_failure'], cwd=os.path.join(root, 'test'), stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, timeout=limit)
    except subprocess.TimeoutExpired:
        return False
    return done.returncode == 0


def verdict(root, mutant, tests, limits):
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
        return 'survived' if all(passes(root, test, limits[test]) for test in tests) else 'killed'
    finally:
        with open(path, 'w') as file:
            file.write(text)


def usual_durations(root, tests):
    if not build(root, tests):
        sys.exit('mutate: the tests do not build')
    limits = {}
    for test in tests:
        begun = time.time()
        if not passes(root, test, None):
            sys.exit('mutate: test_%s fails without a change' % test)
        limits[test] = max(LEAST, SLOWER * (time.time() - begun))
    return limits


def main():
    parser = argparse.ArgumentParser(prog='mutate', description=__doc__.split('\n')[0])
    parser.add_argument('root')
    parser.add_argument('--layers', default=','.join(TESTS))
    parser.add_argument('--each', type=int, default=10, help='mutants of each layer')
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--output', help='what is known so far; default: mutants.json in .mutate')
    arguments = parser.parse_args()
    output = arguments.output or os.path.join(arguments.root, '..', 'mutants.json')
    known = {}
    if os.path.exists(output):
        with open(output) as file:
            known = json.load(file)
    for layer in arguments.layers.split(','):
        if layer not in TESTS:
            parser.error('--layers: found %s; allowed: %s' % (layer, ', '.join(TESTS)))
        total, drawn = sample(arguments.root, layer, arguments.each, arguments.seed)
        limits = None
        for mutant in drawn:
            key = '%(file)s:%(line)d: %(before)s -> %(after)s' % dict(mutant, after=mutant['after'].strip())
            if key not in known:
                limits = limits or usual_durations(arguments.root, TESTS[layer])
                known[key] = verdict(arguments.root, mutant, TESTS[layer], limits)
                with open(output + '.part', 'w') as file:
                    json.dump(known, file, indent=1)
                os.replace(output + '.part', output)
            print('%-12s %s' % (known[key], key), flush=True)
            mutant['verdict'] = known[key]
        found = [mutant['verdict'] for mutant in drawn]
        print('%s: %d of %d mutants drawn: %d killed, %d survived, %d not compiled' % (
            layer, len(drawn), total, found.count('killed'), found.count('survived'), found.count('not compiled')), flush=True)


if __name__ == '__main__':
    main()
