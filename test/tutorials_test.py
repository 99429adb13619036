#!/usr/bin/env python3
"""How scripts/follow_tutorials compares what commands print with what a page shows."""
import os
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(ROOT, 'scripts'))
import follow_tutorials  # noqa: E402

PAGE = '''Text.

```sh
name=tissue
echo "E is 12.3 kPa; 3 s"
echo a line that the page leaves out
echo "$name converged"
```

    E is 12.3 kPa; 8 s
    tissue converged

More text.

```sh
echo $name again
```

```yaml
- not: a command
```

    no output of a command
'''


def follow(page, *options):
    """The exit code, what was printed, and the page as it is then."""
    with tempfile.TemporaryDirectory() as root:
        os.makedirs(os.path.join(root, 'doc', 'tutorials'))
        path = os.path.join(root, 'doc', 'tutorials', 'short.md')
        with open(path, 'w') as file:
            file.write(page)
        done = subprocess.run([sys.executable, os.path.join(ROOT, 'scripts', 'follow_tutorials.py'), *options, root, root, 'short'],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
        with open(path) as file:
            return done.returncode, done.stdout + done.stderr, file.read()


class TutorialsTest(unittest.TestCase):
    def test_a_page_that_shows_what_is_printed_passes(self):
        code, printed, page = follow(PAGE)
        self.assertEqual(code, 0, printed)
        self.assertIn('tissue again', printed)  # the blocks share one shell
        self.assertEqual(page, PAGE)

    def test_a_stale_number_is_shown_and_written(self):
        stale = PAGE.replace('    E is 12.3 kPa; 8 s', '    E is 12.4 kPa; 8 s')
        code, printed, page = follow(stale)
        self.assertEqual((code, page), (1, stale))
        self.assertIn('short shows:    E is 12.4 kPa; 8 s\n  was printed: E is 12.3 kPa; 3 s', printed)
        code, printed, page = follow(stale, '--write')
        self.assertEqual((code, page), (1, PAGE.replace('8 s', '3 s')))

    def test_rows_that_changed_their_order_are_written_in_it(self):
        rows = ['gel_layer     16.8 %  0.100', 'added_mass    12.1 %  0.101', 'gravity        6.4 %  0.105']
        page = '```sh\n' + ''.join('echo "%s"\n' % row for row in ['head', *rows, 'foot']) + '```\n\n'
        shown = ''.join('    %s\n' % line for line in ['head', rows[1], 'friction       6.5 %  0.102', rows[0], 'foot'])
        code, _, written = follow(page + shown, '--write')
        self.assertEqual(code, 1)
        self.assertEqual(written, page + ''.join('    %s\n' % line for line in ['head', *rows, 'foot']))

    def test_live_digits_may_differ_and_are_written(self):
        live = PAGE.replace('echo "$name converged"', 'echo 11919.059539308575').replace('    tissue converged', '    11920.000000000001')
        self.assertEqual(follow(live)[0], 0)
        code, _, page = follow(live, '--write')
        self.assertEqual((code, page), (0, live.replace('    11920.000000000001', '    11919.059539308575')))

    def test_a_line_in_another_block_or_order_is_not_the_same(self):
        self.assertEqual(follow(PAGE.replace('    tissue converged', '    tissue again'))[0], 1)
        swapped = PAGE.replace('    E is 12.3 kPa; 8 s\n    tissue converged', '    tissue converged\n    E is 12.3 kPa; 8 s')
        self.assertEqual(follow(swapped)[0], 1)

    def test_a_command_that_fails_ends_it(self):
        code, printed, _ = follow(PAGE.replace('name=tissue', 'false'))
        self.assertEqual(code, 1)
        self.assertIn('a command of doc/tutorials/short.md failed with code 1', printed)

    def test_only_wall_times_and_live_digits_may_differ(self):
        same = follow_tutorials.same
        self.assertTrue(same('frames        90 used', 'frames        90 used; 51.2 frames/s'))
        self.assertTrue(same('11919.059539308575', '12100.159539308571'))
        self.assertFalse(same('11919.059539308575', '13100.159539308571'))
        self.assertFalse(same('11919.059539308575', 'converged'))
        self.assertFalse(same('11919.059539308575', ''))
        self.assertFalse(same('E is 12.3 kPa', 'E is 12.4 kPa'))
        self.assertFalse(same('at 0.97 s', 'at 0.98 s'))

    def test_every_page_has_commands(self):
        for name in follow_tutorials.ALL:
            with open(follow_tutorials.page_of(ROOT, name)) as file:
                self.assertTrue(follow_tutorials.blocks(file.read()), name)


if __name__ == '__main__':
    unittest.main()
