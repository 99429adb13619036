"""How honest `diagnose` is on recordings of an independent simulator: see scripts/hidden_effects."""
import argparse
import collections
import json
import multiprocessing
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time

import numpy as np

import foreign_draws
from figures import plt, save
from foreign_draws import honest, ignored
from foreign_truths import truth_list
from study_arguments import study_arguments
from study import MODULUS, TIME_LIMIT, VISIBLE, confusion_table, picture
from tool_runs import Failed, call
from trust_study import shown_share

OFF = 0.03          # of E
SOUND = ('adequate', 'numerics')
NONE = ('outside', 'removed')  # nothing in the library is the cause
MENTIONED = 0.02    # probability from which on a statement counts for the calibration
BINS = 10
EVIDENT = 10.0      # nats that a detectable effect gains


def truth_folder(arguments, name):
    return os.path.join(arguments.output, 'truths', name)


def suffix(arguments):
    """Of the files of a sample, which are kept beside those of all draws."""
    return '' if arguments.sample is None else '_sample'


def simulated(arguments, name):
    return os.path.exists(os.path.join(truth_folder(arguments, name), 'truth.json'))


def simulate_truths(arguments, names):
    """One after the other; one that is there stays."""
    script = os.path.join(arguments.root, 'benchmark/hidden_effects/foreign_truths.py')
    todo = [name for name in names if not simulated(arguments, name)]
    for k, name in enumerate(todo):
        folder = truth_folder(arguments, name)
        os.makedirs(folder, exist_ok=True)
        command = ['nice', '-n', '10', sys.executable, script, arguments.simulator, name, folder]
        # A compiler's cache of its own: one that was left by an ended run would be waited for.
        with open(os.path.join(folder, 'log'), 'w') as log, tempfile.TemporaryDirectory() as cache:
            environment = dict(os.environ, XDG_CACHE_HOME=cache)
            failed = subprocess.run(command, stdout=log, stderr=log, env=environment).returncode != 0
        print('%d of %d: %s' % (k + 1, len(todo), name + (' FAILED, see its log' if failed else '')), flush=True)


def draw(task):
    """One recording, and what the diagnosis says of it."""
    arguments, drawn = task
    row = dict(drawn)
    folder = os.path.join(arguments.output, 'foreign_draws', '%04d' % drawn['number'])
    os.makedirs(folder, exist_ok=True)
    begun = time.time()
    try:
        truth = foreign_draws.write_draw(drawn, truth_folder(arguments, drawn['truth']), folder)
        command = [arguments.diagnose, os.path.join(folder, 'model.yaml'), os.path.join(folder, 'recording.bag'),
                   '--auto', '--quiet', '--allow-outside', '--output', folder]
        for effect in ignored(drawn):
            command += ['--ignore', effect]
        call(command, TIME_LIMIT)
        with open(os.path.join(folder, 'diagnosis.json')) as file:
            row.update(answer(json.load(file), truth))
        if row['class'] == 'two' and not both(row):
            row['second_gains'] = second_gains(arguments, row, folder)
    except (Failed, OSError) as error:
        row['failed'] = str(error)
    row['whole'] = round(time.time() - begun, 1)
    if not arguments.keep:
        shutil.rmtree(folder)
    return row


def second_gains(arguments, row, folder):
    """The log evidence that the effect which was not found gains beside the other one."""
    found = sorted(row['hidden'], key=lambda effect: effect not in row['final'])
    with tempfile.TemporaryDirectory() as output:
        call([arguments.diagnose, os.path.join(folder, 'model.yaml'), os.path.join(folder, 'recording.bag'), '--quiet',
              '--allow-outside', '--output', output] + [word for effect in found for word in ('--add', effect)], TIME_LIMIT)
        with open(os.path.join(output, 'diagnosis.json')) as file:
            return short(json.load(file)['steps'][-1]['log_bayes_factor'])


def short(value):
    return float('%.5g' % value) if value is not None else None


def answer(found, truth):
    first, last, final = found['steps'][0], found['steps'][-1], found['final']
    modulus = final['parameters'][MODULUS]
    values = [modulus['mean']] + modulus['interval95']
    candidates = collections.defaultdict(float)  # two entries of an effect are one name
    for c in found['candidates']:
        candidates[c['effect']] += c['probability'] or 0.0
    return {'verdict': found['verdict'], 'set': found['set'], 'z': short(found['z']),
            'adequate': short(found['probability_adequate']), 'none_of_these': short(found['none_of_these']),
            'candidates': {effect: short(min(1.0, p)) for effect, p in candidates.items() if p >= 1e-3},
            'final_verdict': final['verdict'], 'final': final['effects'],
            'modulus': [[short(x / e) if x is not None else None for x in values] for e in truth['young_modulus']],
            'share': [h['share'] for h in truth['hidden']],
            'given': short(first['held_out_rms'] / first['noise_floor']),
            'held_out': short(last['held_out_rms'] / last['noise_floor']), 'seconds': short(found['seconds'])}


# What is right and wrong.

def names_of(row):
    """All honest names of what is wrong."""
    return set().union(*honest(row))


def holds(row):
    """E's interval holds the truth, or one of the two that a jump is between."""
    return any(low is None or high is None or low <= 1.0 <= high for _, low, high in row['modulus'])


def off(row):
    return min(abs(mean - 1.0) for mean, _, _ in row['modulus']) > OFF and not holds(row)


def named_wrongly(row):
    return row['verdict'] == 'missing' and not in_set(row)


def adequate_wrongly(row):
    return row['final_verdict'] in SOUND and off(row)


def detectable(row):
    return row['class'] != 'clean' and (row['verdict'] not in SOUND or row['given'] > VISIBLE)


def abstains(row):
    named = max(row['candidates'].values(), default=0.0)
    return row['verdict'] == 'unexplained' or row['none_of_these'] > max(named, row['adequate'])


def first_named(row):
    return row['set'][0] if row['verdict'] == 'missing' and row['set'] else row['verdict']


def in_set(row):
    return bool(names_of(row) & set(row['set']))


def first_is_honest(row):
    return first_named(row) in names_of(row)


def wrongs(row):
    """Why a draw went wrong, in words; empty: it did not."""
    out = []
    if row['class'] == 'clean' and row['verdict'] not in SOUND:
        out.append('false alarm')
    if named_wrongly(row):
        out.append('confidently wrong: names %s' % ', '.join(row['set']))
    if adequate_wrongly(row):
        out.append('confidently wrong: ends adequate beside E')
    if row['class'] in ('one', 'declared') and detectable(row) and not in_set(row):
        out.append('truth not in the set')
    if row['class'] == 'two' and both_detectable(row) and not both(row):
        out.append('not both in the final set')
    if row['class'] in NONE and detectable(row) and not abstains(row) and not named_wrongly(row) and not names_of(row):
        out.append('does not abstain')
    return out


def both(row):
    return all(group & set(row['final']) for group in honest(row))


def both_detectable(row):
    """Each of two effects gains evidence beside the other one."""
    return detectable(row) and row.get('second_gains', EVIDENT) >= EVIDENT


# Figures.

def share_line(name, wanted, values):
    return '| %s | %s | %d/%d | %s |' % (name, wanted, sum(values), len(values), shown_share(sum(values), len(values)))


def statements(rows):
    """(stated probability, whether it is so): an honest name, any other name, none of these."""
    out = []
    for row in rows:
        if row['class'] not in ('clean',) and not detectable(row):
            continue  # the given model is right as far as anybody can see
        said = [(p, False) for effect, p in row['candidates'].items() if effect not in names_of(row)]
        for group in honest(row):
            said.append((min(1.0, sum(p for effect, p in row['candidates'].items() if effect in group)), True))
        said.append((row['none_of_these'], row['class'] in NONE))
        out += [(p, so) for p, so in said if p >= MENTIONED]
    return out


def reliability(said):
    """(mean stated, share that is so, count) of each bin, and the expected calibration error."""
    bins = []
    for k in range(BINS):
        some = [(p, so) for p, so in said if min(int(p * BINS), BINS - 1) == k]
        if some:
            bins.append((np.mean([p for p, _ in some]), np.mean([so for _, so in some]), len(some)))
    error = sum(count * abs(p - so) for p, so, count in bins) / max(1, len(said))
    return bins, error


def figures(rows):
    of = collections.defaultdict(list)
    for row in rows:
        of[row['class']].append(row)
    single = [row for row in of['one'] + of['declared'] if detectable(row)]
    pairs = [row for row in of['two'] if detectable(row)]
    none = [row for row in of['outside'] + of['removed'] if detectable(row)]
    ended = [row for g in ('clean', 'one', 'two', 'declared') for row in of[g] if row['final_verdict'] in SOUND]
    lines = ['| figure | wanted | draws | share (95 % interval) |', '|---|---|---|---|',
             share_line('confidently wrong', '<= 2 %', [named_wrongly(r) or adequate_wrongly(r) for r in rows]),
             share_line('... `missing` without the truth or its equivalent', '', [named_wrongly(r) for r in rows]),
             share_line('... `adequate` or `numerics` in the end, E off and outside its interval', '',
                        [adequate_wrongly(r) for r in rows]),
             share_line('a detectable truth is in the set', '>= 97 %', [in_set(r) for r in single]),
             share_line('it is first', '>= 92 %', [first_is_honest(r) for r in single]),
             share_line('both of two in the final set, where each gains 10 nats beside the other', '>= 85 %',
                        [both(r) for r in pairs if both_detectable(r)]),
             share_line('... of all pairs', '', [both(r) for r in pairs]),
             share_line('false alarms on clean', '0', [r['verdict'] not in SOUND for r in of['clean']]),
             share_line('abstains when it is none of these', '>= 95 %', [abstains(r) for r in none]),
             share_line('... or names what it nearly is', '', [abstains(r) or first_is_honest(r) for r in none]),
             share_line('E\'s interval holds the truth, where the end is `adequate` or `numerics`', '93 to 97 %',
                        [holds(r) for r in ended]),
             share_line('... of them after adding', '', [holds(r) for r in ended if r['final']])]
    said = statements(rows)
    lines += ['| expected calibration error | <= 0.05 | %d statements | %.3f |' % (len(said), reliability(said)[1]),
              time_line('seconds a diagnosis, alone on the machine: median, p95', '8, 20', rows, 'quiet_seconds'),
              time_line('... with others beside it', '', rows, 'seconds')]
    return lines


def time_line(what, wanted, rows, key):
    seconds = [row[key] for row in rows if key in row]
    told = '%.1f, %.1f' % tuple(np.percentile(seconds, (50, 95))) if seconds else 'not measured'
    return '| %s | %s | %d | %s |' % (what, wanted, len(seconds), told)


def by_kind(rows):
    """What is hidden or declared, class by class, and what became of it."""
    groups = collections.defaultdict(list)
    for row in rows:
        what = row['kind'] if row['class'] in ('clean', 'declared') else ' and '.join(row['hidden'])
        groups[row['class'], what].append(row)
    lines = ['| class | what | draws | detectable | in the set | first | abstains | sound | confidently wrong |',
             '|---|---|---|---|---|---|---|---|---|']
    for (group, what), some in sorted(groups.items()):
        counts = [sum(map(count, some)) for count in (
            detectable, in_set, first_is_honest, abstains, lambda r: r['verdict'] in SOUND,
            lambda r: named_wrongly(r) or adequate_wrongly(r))]
        cells = [group, what, len(some)] + [count or '' for count in counts]
        lines.append('| ' + ' | '.join(map(str, cells)) + ' |')
    return lines


def confusion(rows):
    def label(row):
        usual = ' and '.join(row['hidden'])
        return {'clean': 'nothing', 'two': 'two effects', 'declared': row['kind'],
                'removed': usual + ' (removed)'}.get(row['class'], usual)
    some = [row for row in rows if row['class'] == 'clean' or detectable(row)]
    counts = collections.Counter((label(row), first_named(row)) for row in some)
    classes = list(foreign_draws.COUNTS)
    order = {label(row): (classes.index(row['class']), label(row)) for row in some}
    names = sorted(order, key=order.get)
    found = sorted({first for _, first in counts}, key=lambda f: (f in SOUND + ('unexplained',), f))
    return names, found, [[counts[name, first] for first in found] for name in names]


def failures(rows):
    lines = ['| draw | class | truth | kind | verdict | set | final | E over truth (95 %) | why |',
             '|---|---|---|---|---|---|---|---|---|']
    for row in sorted(rows, key=lambda row: row['number']):
        why = wrongs(row)
        if why:
            mean, low, high = row['modulus'][0]
            told = ', '.join('%s %.2g' % (effect, row['candidates'].get(effect, 0.0)) for effect in row['set'])
            lines.append('| %d | %s | %s | %s | %s, z %.1f, none %.2g | %s | %s %s | %.3f (%s to %s) | %s |' % (
                row['number'], row['class'], row['truth'], row['kind'], row['verdict'], row['z'] or 0.0,
                row['none_of_these'], told, row['final_verdict'], ', '.join(row['final']), mean, low, high,
                '; '.join(why)))
    return lines


def reliability_picture(rows, path):
    bins, error = reliability(statements(rows))
    figure, axis = plt.subplots(figsize=(5, 4.6))
    axis.plot([0, 1], [0, 1], color='#8c959f', linewidth=0.8)
    for p, so, count in bins:
        axis.plot(p, so, 'o', markersize=4 + 2.5 * np.log10(count), color='#0969da')
        axis.annotate(str(count), (p, so), textcoords='offset points', xytext=(7, -9), fontsize=8)
    axis.set_xlabel('stated probability')
    axis.set_ylabel('share that is so')
    axis.set_title('expected calibration error %.3f' % error, fontsize=10)
    save(figure, path, 110, [axis])


def page(arguments, rows, doc):
    good = [row for row in rows if 'failed' not in row]
    broken = [row for row in rows if 'failed' in row]
    names, found, counts = confusion(good)
    figures_page = figures(good)
    classes = collections.Counter(row['class'] for row in good)
    bins, _ = reliability(statements(good))
    base = 'hidden_effects_foreign' + suffix(arguments)
    option = ' --sample %d' % arguments.sample if suffix(arguments) else ''
    lines = ['# How honest a diagnosis of foreign recordings is', '',
             '`scripts/hidden_effects foreign%s` writes this page. ' % option +
             '`benchmark/hidden_effects/foreign_truths.py` says what is '
             'simulated. `foreign_draws.py` says what is made wrong and what an honest answer is. '
             '`doc/%s.json` holds the result of each draw.' % base, '',
             'Draws: %s.' % ', '.join('%d %s' % (count, name) for name, count in classes.items()),
             '', *figures_page, '', '* failed: %d of %d' % (len(broken), len(rows))]
    lines += ['  * draw %d, %s, %s: %s' % (row['number'], row['truth'], row['kind'], row['failed']) for row in broken]
    lines += ['', '## By what is wrong', ''] + by_kind(good)
    lines += ['', '## What is named first', '', 'The table counts all clean recordings, and the others '
              'where the given model leaves a misfit.', '',
              '![confusion](%s.png)' % base, ''] + confusion_table(names, found, counts)
    lines += ['', '## What is stated and what is so', '', '![reliability](%s_reliability.png)' % base, '',
              '| stated | is so | statements |', '|---|---|---|'] + ['| %.2f | %.2f | %d |' % row for row in bins]
    lines += ['', '## Every draw that went wrong', ''] + failures(good)
    base = os.path.join(doc, base)
    with open(base + '.md', 'w') as file:
        file.write('\n'.join(lines) + '\n')
    with open(base + '.json', 'w') as file:
        ordered = sorted(rows, key=lambda row: row['number'])
        file.write('[' + ',\n'.join(json.dumps(row, sort_keys=True) for row in ordered) + ']\n')
    if good:
        picture(names, found, counts, base + '.png')
        reliability_picture(good, base + '_reliability.png')
    print('\n'.join(figures_page))


def read_rows(path):
    """The last row of each draw."""
    if not os.path.exists(path):
        return {}
    with open(path) as file:
        return {row['number']: row for row in map(json.loads, file)}


def parse():
    parser = argparse.ArgumentParser(prog='hidden_effects foreign')
    parser.add_argument('--draws', type=int, help='only the first so many')
    parser.add_argument('--sample', type=int, metavar='SEED',
                        help='a random order, of the truths that are there: what is done by any time is a random sample')
    parser.add_argument('--classes', help='only these: %s' % ','.join(foreign_draws.COUNTS))
    parser.add_argument('--jobs', type=int, default=os.cpu_count())
    parser.add_argument('--simulate-only', action='store_true', help='only the truths that the draws need')
    parser.add_argument('--fresh', action='store_true', help='forget the draws so far; truths are kept')
    parser.add_argument('--page-only', action='store_true', help='write the page from the draws so far')
    parser.add_argument('--time-every', type=int, metavar='N',
                        help='diagnose every N-th draw again, one at a time, to time it on a quiet machine')
    parser.add_argument('--keep', action='store_true', help='keep the recordings and reports of all draws')
    return study_arguments(parser, 'diagnose', 'hidden_effects')


def main():
    arguments = parse()
    os.makedirs(arguments.output, exist_ok=True)
    classes = (arguments.classes or ','.join(foreign_draws.COUNTS)).split(',')
    planned = [drawn for drawn in foreign_draws.draw_list() if drawn['class'] in classes]
    if arguments.sample is not None:
        planned = [drawn for drawn in planned if simulated(arguments, drawn['truth'])]
        random.Random(arguments.sample).shuffle(planned)
    planned = planned[:arguments.draws]
    needed = {drawn['truth'] for drawn in planned}
    if not arguments.page_only:
        simulate_truths(arguments, [row[0] for row in truth_list() if row[0] in needed])
    if arguments.simulate_only:
        return
    kept = os.path.join(arguments.output, 'foreign%s.jsonl' % suffix(arguments))
    if arguments.fresh and os.path.exists(kept):
        os.remove(kept)
    rows = {number: row for number, row in read_rows(kept).items() if number in {drawn['number'] for drawn in planned}}
    todo = [drawn for drawn in planned if 'verdict' not in rows.get(drawn['number'], {})]
    with multiprocessing.Pool(arguments.jobs) as pool:
        for row in pool.imap_unordered(draw, [(arguments, drawn) for drawn in todo] if not arguments.page_only else []):
            rows[row['number']] = row
            with open(kept, 'a') as file:
                file.write(json.dumps(row, sort_keys=True) + '\n')
            what = row.get('failed') or ' '.join([row['verdict']] + row['set'] + ['!! ' + why for why in wrongs(row)])
            print('%3d/%d %4d %-9s %-46s %-18s -> %s' % (len(rows), len(planned), row['number'], row['class'],
                                                         row['truth'], row['kind'], what), flush=True)
    for number in sorted(rows)[::arguments.time_every] if arguments.time_every else []:
        row = rows[number]
        if 'verdict' not in row or 'quiet_seconds' in row:
            continue
        again = draw((arguments, next(drawn for drawn in planned if drawn['number'] == number)))
        row['quiet_seconds'] = again['seconds']
        with open(kept, 'a') as file:
            file.write(json.dumps(row, sort_keys=True) + '\n')
        print('%4d %-46s %.1f s alone' % (number, row['truth'], row['quiet_seconds']), flush=True)
    page(arguments, list(rows.values()), os.path.join(arguments.root, 'doc'))


if __name__ == '__main__':
    sys.exit(main())
