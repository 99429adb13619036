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


def paired(shown, printed):
    """(line of the page, the line that was printed in its place or None), in the page's order."""
    pairs, at = [], 0
    for line in shown:
        found = next((k for k in range(at, len(printed)) if same(line, printed[k])), None)
        if found is None:
            near = difflib.get_close_matches(line, printed[at:], 1, NEAR)
            found = printed.index(near[0], at) if near else None
        pairs.append((line, None if found is None else printed[found]))
        at = at if found is None else found + 1
    return pairs


def different(shown, printed):
    return [(line, found) for line, found in paired(shown, printed) if found is None or not same(line, found)]


def updated(page, printed):
    """The page with what was printed, but for wall times."""
    lists = iter(outputs(printed, len(blocks(page))))

    def block(match):
        text = match.group(0)
        for line, found in paired(shown_lines(match), next(lists)):
            if found is not None and WALL_TIME.sub('', line) != WALL_TIME.sub('', found):
                text = text.replace('    %s\n' % line, '    %s\n' % re.sub(r'; [\d.e+]+ frames/s$', '', found), 1)
        return text
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
