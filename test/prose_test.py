#!/usr/bin/env python3
"""What scripts/check_prose says of sentences that break its rules, and of this package's pages and headers."""
import os
import subprocess
import sys
import tempfile
import unittest

SCRIPT = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'scripts', 'check_prose')
LONG = ' '.join(['word'] * 36) + '.'


def checked(text, name='page.md'):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, name)
        with open(path, 'w') as file:
            file.write(text)
        done = subprocess.run([sys.executable, SCRIPT, path], stdout=subprocess.PIPE, universal_newlines=True)
    return done.returncode, done.stdout


class ProseTest(unittest.TestCase):
    def refused(self, text, words, name='page.md'):
        code, said = checked(text, name)
        self.assertEqual(code, 1, said)
        self.assertIn(words, said)

    def test_pages_and_headers_keep_the_rules(self):
        done = subprocess.run([sys.executable, SCRIPT], stdout=subprocess.PIPE, universal_newlines=True)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn('README.md', done.stdout)
        self.assertIn('include/tissue_stiffness/estimation/estimator.hpp', done.stdout)

    def test_a_long_sentence_is_refused_wherever_it_stands(self):
        short = 'This sentence is short. ' * 9
        for text in (short + LONG, '- ' + LONG + '\n\n' + short, short + '\n\n| a | b |\n|---|---|\n| c | ' + LONG + ' |\n'):
            self.refused(text, ': 36 words; allowed: 35: word word')
        self.assertEqual(checked('    ' + LONG)[0], 0)  # code

    def test_the_average_and_the_first_word_count(self):
        self.refused(' '.join(['word'] * 18) + '.', '18.0 words on average; allowed: fewer than 18')
        self.refused('Of this nothing is known.', 'begins with "Of"')

    def test_comments_of_a_header_are_read(self):
        declared = 'int a = 0;  ///< a short one\nint b = 0;  ///< %s\n'
        self.refused('/// %s\nint a;\n' % LONG, ': 36 words', 'a.hpp')
        self.refused(declared % ('of this\n            ///< ' + LONG), ':2: 38 words', 'a.hpp')
        self.assertEqual(checked(declared % 'another one' * 9, 'a.hpp')[0], 0)
        self.assertEqual(checked('// %s\nint a;\n' % LONG, 'a.hpp')[0], 0)


if __name__ == '__main__':
    unittest.main()
