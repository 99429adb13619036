"""Runs the commands of pages and compares what they print with what the pages show: see scripts/follow_tutorials."""
import argparse
import difflib
import os
import re
import subprocess
import sys
import tempfile
import time

ALL = ('recipe', 'first_recording', 'displacement_in_force_out', 'what_is_missing', 'add_an_effect', 'on_your_robot')
BLOCK = re.compile(r'^```sh\n(?P<commands>.*?)^```\n(?:\n*(?P<shown>(?:    [^\n]*\n)+))?', re.S | re.M)
MARK = '== block of commands %d'
WALL_TIME = re.compile(r'; [\d.e+]+ (?:frames/)?s$')     # no two runs have the same
LIVE = re.compile(r'-?\d+\.\d{9,}(?:e-?\d+)?')           # a number as rostopic prints it
LIVE_WITHIN = 0.05                                       # threads decide when a live correction comes
NEAR = 0.5                                               # of a line's letters are the same: it stands for the other line


def page_of(root, name):
    for path in ('doc/tutorials/%s.md' % name, 'doc/%s.md' % name):
        if os.path.exists(os.path.join(root, path)):
            return os.path.join(root, path)
    sys.exit('follow_tutorials: found no page %s; allowed: %s' % (name, ', '.join(ALL)))


def shown_lines(match):
    return [line[4:] for line in (match.group('shown') or '').splitlines()]


def blocks(page):
    """(commands, the lines of output that the page shows below them), for each block of shell code."""
    return [(match.group('commands'), shown_lines(match)) for match in BLOCK.finditer(page)]


def program(page):
    """All commands in one shell script, which says where the output of each block begins."""
    return ''.join('echo "%s"\n%s' % (MARK % k, commands) for k, (commands, _) in enumerate(blocks(page)))


def outputs(printed, count):
    """The lines that each block of a page printed."""
    lists = [[] for _ in range(count)]
    block = -1
    for line in printed.splitlines():
        if block + 1 < count and line == MARK % (block + 1):
            block += 1
        elif block >= 0:
            lists[block].append(line.rstrip())
    return lists


def same(shown, printed):
    """Whether a line of a page is what was printed, but for wall times and the digits of a live number."""
    shown, printed = (WALL_TIME.sub('', line.rstrip()) for line in (shown, printed))
    if LIVE.sub('live', shown) != LIVE.sub('live', printed):
        return False
    return all(abs(float(a) - float(b)) <= LIVE_WITHIN * abs(float(b))
               for a, b in zip(LIVE.findall(shown), LIVE.findall(printed)))


def shape(line):
    """A line with its words and numbers made equal, and its blanks single: rows of one table have the same."""
    return ' '.join(re.sub(r'[A-Za-z_]+', 'a', re.sub(r'[\d.]+', '0', line)).split())


def likeness(shown, printed):
    """How well a printed line stands for a line of a page; 0 is not at all. Two lines that are near outdo one that is the same."""
    if same(shown, printed):
        return 1.2
    letters = difflib.SequenceMatcher(None, shown, printed, autojunk=False)
    if shape(shown) != shape(printed) and (letters.quick_ratio() < NEAR or letters.ratio() < NEAR):
        return 0.0
    return 1.0 + 0.1 * letters.ratio()


def paired(shown, printed):
    """(line of the page, the line that was printed in its place or None), in the page's order: the most alike of all such lists."""
    like = [[likeness(line, other) for other in printed] for line in shown]
    best = [[0.0] * (len(printed) + 1) for _ in range(len(shown) + 1)]  # of all lines from here on
    for i in range(len(shown) - 1, -1, -1):
        for k in range(len(printed) - 1, -1, -1):
            best[i][k] = max(best[i][k + 1], best[i + 1][k], like[i][k] + best[i + 1][k + 1] if like[i][k] else 0.0)
    pairs, k = [], 0
    for i, line in enumerate(shown):
        while k < len(printed) and best[i][k] == best[i][k + 1]:
            k += 1
        if k < len(printed) and like[i][k] and best[i][k] == like[i][k] + best[i + 1][k + 1]:
            pairs.append((line, printed[k]))
            k += 1
        else:
            pairs.append((line, None))
    return pairs


def different(shown, printed):
    return [(line, found) for line, found in paired(shown, printed) if found is None or not same(line, found)]


def current(shown, printed):
    """A line of the page with what was printed, but for wall times."""
    if printed is None or WALL_TIME.sub('', shown) == WALL_TIME.sub('', printed):
        return shown
    return re.sub(r'; [\d.e+]+ frames/s$', '', printed)


def updated(page, printed):
    lists = iter(outputs(printed, len(blocks(page))))

    def block(match):
        lines = [current(*pair) for pair in paired(shown_lines(match), next(lists))]
        before = match.group(0)[:match.start('shown') - match.start()] if lines else match.group(0)
        return before + ''.join('    %s\n' % line for line in lines)
    return BLOCK.sub(block, page)


def run(script, folder):
    """The exit code of a script and all that it prints, which is shown while it runs."""
    with tempfile.TemporaryDirectory() as own:
        with open(os.path.join(own, 'commands'), 'w') as file:
            file.write(script)
        # A file instead of a pipe: what a failed command leaves running would hold a pipe open.
        with open(os.path.join(own, 'printed'), 'w') as out, open(os.path.join(own, 'printed'), errors='replace') as printed:
            # Job control (-m): a tutorial ends what it started with an interrupt.
            process = subprocess.Popen(['bash', '-em', os.path.join(own, 'commands')], cwd=folder, stdin=subprocess.DEVNULL,
                                       stdout=out, stderr=subprocess.STDOUT)
            text = ''
            while True:
                ended = process.poll() is not None
                more = printed.read()
                text += more
                sys.stdout.write(more)
                sys.stdout.flush()
                if ended:
                    return process.returncode, text
                time.sleep(0.2)


def follow(root, clone, name, write):
    """The number of lines that differ; ends everything when a command fails."""
    path = page_of(root, name)
    with open(path) as file:
        page = file.read()
    print('== %s' % name, flush=True)
    code, printed = run(program(page), clone)
    if code != 0:
        sys.exit('follow_tutorials: a command of %s failed with code %d' % (os.path.relpath(path, root), code))
    count = 0
    for (_, shown), lines in zip(blocks(page), outputs(printed, len(blocks(page)))):
        for line, near in different(shown, lines):
            count += 1
            print('%s shows:    %s\n  was printed: %s' % (name, line, 'nothing like it' if near is None else near))
    print('== %s: %d lines differ' % (name, count), flush=True)
    if write:
        with open(path, 'w') as file:
            file.write(updated(page, printed))
    return count


def main():
    parser = argparse.ArgumentParser(prog='follow_tutorials')
    parser.add_argument('--write', action='store_true')
    parser.add_argument('root')
    parser.add_argument('clone')
    parser.add_argument('names', nargs='*')
    arguments = parser.parse_args()
    counts = [follow(arguments.root, arguments.clone, name, arguments.write) for name in arguments.names or ALL]
    sys.exit(1 if any(counts) else 0)


if __name__ == '__main__':
    main()
