"""What scripts write into the documentation: the text between `<!-- measured: NAME -->` and `<!-- end -->`."""
import os
import re

MARK = re.compile(r'(<!-- measured: (\w+) -->\n).*?(<!-- end -->)', re.S)


def machine():
    """The machine in words, and how busy it is now, which should be before the measurement."""
    with open('/proc/cpuinfo') as file:
        name = re.search(r'model name\s*:\s*(.*)', file.read()).group(1)
    load = os.getloadavg()[0]
    busy = f' Other work kept it busy, with a load of {load:.1f} at the start.' if load > 1.0 else ''
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
