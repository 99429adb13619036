#!/usr/bin/env python3
"""What scripts/measure_first_hour takes from the recipe, and what it writes into the pages."""
import os
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [os.path.join(ROOT, 'scripts'), os.path.join(ROOT, 'benchmark', 'shared')]
import measure_first_hour  # noqa: E402
import measured_pages  # noqa: E402

MARKS = {'README.md': 'build_time', 'doc/recipe.md': 'recipe_time', 'doc/performance.md': 'first_hour'}


def read(page):
    with open(os.path.join(ROOT, page)) as file:
        return file.read()


RESULTS = """{"parameters": {"elasticity.young_modulus": {"mean": 12e3, "interval95": [11e3, 13e3]}}, "state": "converged"}"""
RECIPE = """```sh
scripts/build
mkdir out
cp results.json out/results.json && true --output out
```
"""


def small_repository(root, build='true'):
    """A repository whose scripts do nearly nothing, with the places for the times in its pages."""
    files = {'results.json': RESULTS, 'scripts/install_dependencies': 'echo installing a b', 'scripts/build': build,
             'scripts/demo': 'test "$CCACHE_DISABLE" = 1'}
    for page, name in MARKS.items():
        files[page] = (RECIPE if 'recipe' in page else '') + '<!-- measured: %s -->\n<!-- end -->\n' % name
    for path, text in files.items():
        path = os.path.join(root, path)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, 'w') as file:
            file.write(text)
        os.chmod(path, 0o755)
    os.makedirs(os.path.join(root, 'build'))
    for command in (['init', '--quiet'], ['add', *files],
                    ['-c', 'user.name=a', '-c', 'user.email=a@b', 'commit', '--quiet', '-m', 'a']):
        subprocess.run(['git', '-C', root, *command], check=True)


def measured(root):
    environment = dict(os.environ, PYTHONPATH=os.path.join(ROOT, 'benchmark', 'shared'))
    return subprocess.run([sys.executable, os.path.join(ROOT, 'scripts', 'measure_first_hour.py'), root], env=environment,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)


class FirstHourTest(unittest.TestCase):
    def test_the_recipe_goes_from_the_build_to_an_estimate(self):
        commands = measure_first_hour.commands_of(measure_first_hour.until_its_time(read('doc/recipe.md')))
        self.assertEqual(commands[0], 'scripts/build')
        self.assertIn(' estimate ', commands[-1])
        self.assertEqual(measure_first_hour.folder_of_last(commands), 'silicone/result')
        for command in commands:
            for word in command.split():
                if word.startswith(('scripts/', 'config/')):
                    self.assertTrue(os.path.exists(os.path.join(ROOT, word)), word)

    def test_a_last_command_without_results_is_refused(self):
        for command in ('scripts/build', 'scripts/run estimate a b --output'):
            with self.assertRaisesRegex(SystemExit, 'allowed: one with --output'):
                measure_first_hour.folder_of_last([command])

    def test_a_small_repository_is_measured_from_the_clone_to_e(self):
        with tempfile.TemporaryDirectory() as root:
            small_repository(root)
            done = measured(root)
            self.assertEqual(done.returncode, 0, done.stderr)
            texts = {}
            for page in MARKS:
                with open(os.path.join(root, page)) as file:
                    texts[page] = file.read()
        self.assertIn('E is 12.0 kPa (95 %: 11.0 to 13.0 kPa), and the state is `converged`.', texts['doc/performance.md'])
        for row in ('| `scripts/install_dependencies` | 0 | installed 2 packages |', '| `scripts/build` | 0 | without ccache |',
                    '| `mkdir out` | 0 | recipe |', '| all but the demo | 0 |'):
            self.assertIn(row, texts['doc/performance.md'])
        self.assertIn('the build took 0 s, and the demo 0 s more', texts['README.md'])
        self.assertIn('all of this took 0 s, of which the build took 0 s', texts['doc/recipe.md'])

    def test_a_command_that_fails_ends_it_with_its_output(self):
        with tempfile.TemporaryDirectory() as root:
            small_repository(root, 'echo no compiler; exit 2')
            done = measured(root)
        self.assertEqual(done.returncode, 1)
        self.assertIn('"scripts/build" failed with code 2:\nno compiler', done.stderr)

    def test_only_shell_blocks_are_commands(self):
        page = 'Text\n```sh\na\n\nb c\n```\n```yaml\nkey: 1\n```\n```sh\nd\n```\n'
        self.assertEqual(measure_first_hour.commands_of(page), ['a', 'b c', 'd'])

    def test_what_follows_the_time_is_not_counted(self):
        with tempfile.TemporaryDirectory() as root:
            small_repository(root)
            path = os.path.join(root, 'doc', 'recipe.md')
            with open(path, 'a') as file:
                file.write('```sh\nfalse\n```\n')
            subprocess.run(['git', '-C', root, '-c', 'user.name=a', '-c', 'user.email=a@b', 'commit', '-qam', 'b'], check=True)
            self.assertEqual(measured(root).returncode, 0)

    def test_every_page_has_a_place_for_its_times(self):
        for page, name in MARKS.items():
            self.assertIn(name, [match.group(2) for match in measured_pages.MARK.finditer(read(page))], page)

    def test_writing_replaces_what_is_named_and_nothing_else(self):
        before = 'x\n<!-- measured: a -->\nold\n<!-- end -->\ny\n<!-- measured: b -->\nkept\n<!-- end -->\n'
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'page.md')
            with open(path, 'w') as file:
                file.write(before)
            measured_pages.write(path, {'a': 'new\n', 'c': 'nowhere\n'})
            with open(path) as file:
                self.assertEqual(file.read(), before.replace('old', 'new'))


if __name__ == '__main__':
    unittest.main()
