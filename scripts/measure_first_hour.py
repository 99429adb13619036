"""How long it takes from a clone to E: see scripts/measure_first_hour."""
import argparse
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import time

from measured_pages import machine, table, write

MODULUS = 'elasticity.young_modulus'
BLOCK = re.compile(r'^```sh\n(.*?)^```$', re.S | re.M)
STEP = {'scripts/install_dependencies': 'install', 'scripts/build': 'build', 'scripts/demo': 'demo'}


def commands_of(page):
    """The commands of a page, one a line of its blocks of shell code."""
    return [line for block in BLOCK.findall(page) for line in block.splitlines() if line.strip()]


def until_its_time(page):
    """What a page says before it states its time: the time counts these commands."""
    return page.split('<!-- measured: recipe_time', 1)[0]


def folder_of_last(commands):
    """The folder that the last command writes its results to."""
    words = shlex.split(commands[-1])
    if '--output' not in words[:-1]:
        sys.exit('measure_first_hour: the last command of doc/recipe.md is "%s"; allowed: one with --output' % commands[-1])
    return words[words.index('--output') + 1]


def run(command, clone, log):
    """The seconds that a command takes and what it prints; ends everything when it fails."""
    environment = dict(os.environ, CCACHE_DISABLE='1')
    environment.pop('PYTHONPATH', None)
    begun = time.monotonic()
    done = subprocess.run(['bash', '-c', command], cwd=clone, env=environment, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
    seconds = time.monotonic() - begun
    log.write('== %s: %.0f s\n%s' % (command, seconds, done.stdout))
    log.flush()
    print('%6.0f s  %s' % (seconds, command), flush=True)
    if done.returncode != 0:
        sys.exit('measure_first_hour: "%s" failed with code %d:\n%s' % (command, done.returncode, done.stdout[-3000:]))
    return seconds, done.stdout


def remark(command, output):
    if command == 'scripts/install_dependencies':
        names = re.search(r'^installing (.*)$', output, re.M)
        return 'installed %d packages' % len(names.group(1).split()) if names else 'the packages were there already'
    return 'without ccache' if command == 'scripts/build' else ''


def result_in_words(path):
    with open(path) as file:
        results = json.load(file)
    value = results['parameters'][MODULUS]
    low, high = value['interval95']
    return 'E is %.1f kPa (95 %%: %.1f to %.1f kPa), and the state is `%s`.\n' % (
        value['mean'] / 1e3, low / 1e3, high / 1e3, results['state'])


def minutes(seconds):
    return '%.0f s' % seconds if seconds < 90 else '%.0f minutes' % (seconds / 60)


def measure(root, clone):
    """The texts of the pages' marked parts, by name."""
    about = machine()
    begun = time.monotonic()
    subprocess.run(['git', 'clone', '--quiet', root, clone], check=True)
    rows, seconds = [('git clone', '%.0f' % (time.monotonic() - begun), 'from this machine')], {}
    with open(os.path.join(clone, 'doc', 'recipe.md')) as file:
        recipe = commands_of(until_its_time(file.read()))
    with open(os.path.join(root, 'build', 'first_hour.log'), 'w') as log:
        for command in ['scripts/install_dependencies', 'scripts/build', 'scripts/demo']:
            seconds[STEP[command]], output = run(command, clone, log)
            rows.append(('`%s`' % command, '%.0f' % seconds[STEP[command]], remark(command, output)))
        seconds['recipe'] = 0.0
        for command in recipe:
            taken = run(command, clone, log)[0]
            seconds['recipe'] += taken
            rows.append(('`%s`' % command, '%.0f' % taken, 'recipe'))
    whole = seconds['install'] + seconds['build'] + seconds['recipe']
    rows.append(('all but the demo', '%.0f' % whole, 'from the clone to E with its interval'))
    result = result_in_words(os.path.join(clone, folder_of_last(recipe), 'results.json'))
    busy = ', while other work kept it busy' if 'busy' in about else ''
    return {'first_hour': about + result + '\n' + table(['step', 'time [s]', ''], rows),
            'build_time': 'On %d cores%s the build took %s, and the demo %s more.\n' % (
                os.cpu_count(), busy, minutes(seconds['build']), minutes(seconds['demo'])),
            'recipe_time': 'On %d cores%s all of this took %s, of which the build took %s.\n' % (
                os.cpu_count(), busy, minutes(whole), minutes(seconds['build']))}


def main():
    parser = argparse.ArgumentParser(prog='measure_first_hour')
    parser.add_argument('root')
    parser.add_argument('--keep', metavar='FOLDER', help='a new folder for the clone, which stays; default: a temporary one')
    arguments = parser.parse_args()
    if arguments.keep and os.path.exists(arguments.keep):
        parser.error('--keep: %s exists; allowed: a folder that does not' % arguments.keep)
    with tempfile.TemporaryDirectory() as folder:
        texts = measure(arguments.root, arguments.keep or os.path.join(folder, 'tissue_stiffness'))
    print('\n' + texts['first_hour'])
    for page in ('README.md', 'doc/recipe.md', 'doc/performance.md'):
        write(os.path.join(arguments.root, page), texts)


if __name__ == '__main__':
    main()
