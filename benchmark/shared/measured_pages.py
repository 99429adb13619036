"""What scripts write into the documentation: the text between `<!-- measured: NAME -->` and `<!-- end -->`."""
import os
import re
import time

MARK = re.compile(r'(<!-- measured: (\w+) -->\n).*?(<!-- end -->)', re.S)


def busy_cores(seconds=2.0):
    """How many cores are busy now. The load average would count what has ended already."""
    def busy_and_all():
        with open('/proc/stat') as file:
            ticks = [int(word) for word in file.readline().split()[1:9]]
        return sum(ticks) - ticks[3] - ticks[4], sum(ticks)  # all but idle and waiting
    before = busy_and_all()
    time.sleep(seconds)
    busy, all_of_them = (after - first for after, first in zip(busy_and_all(), before))
    return os.cpu_count() * busy / max(1, all_of_them)


def machine():
    """The machine in words, and how busy it is now, which should be before the measurement."""
    with open('/proc/cpuinfo') as file:
        name = re.search(r'model name\s*:\s*(.*)', file.read()).group(1)
    others = busy_cores()
    busy = f' Other work kept {others:.1f} of them busy at the start.' if others > 0.5 else ''
    return f'The machine has {os.cpu_count()} cores of {name}.{busy}\n'


def table(head, rows):
    lines = ['| ' + ' | '.join(head) + ' |', '|' + '---|' * len(head)]
    return '\n'.join(lines + ['| ' + ' | '.join(row) + ' |' for row in rows]) + '\n'


def write(path, texts):
    """Replaces the marked parts of a page that `texts` names, and leaves the others."""
    with open(path) as file:
        page = file.read()
    page = MARK.sub(lambda m: m.group(1) + texts[m.group(2)] + m.group(3) if m.group(2) in texts else m.group(0), page)
    with open(path, 'w') as file:
        file.write(page)
