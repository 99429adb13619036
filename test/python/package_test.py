"""The package as a whole: its type hints, its example, and the page that describes it."""
import ast
import inspect
import os
import re
import subprocess
import sys
import tempfile
import unittest

import tissue_stiffness as ts
from bench import ROOT
from tissue_stiffness import _bag, _core

PACKAGE = os.path.join(ROOT, 'src', 'python', 'tissue_stiffness')


def defined(body):
    """Names that a stub defines, with those of each class."""
    return {node.name: defined(node.body) if isinstance(node, ast.ClassDef) else {}
            for node in body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}


def members(thing):
    return {name for name in vars(thing) if not name.startswith('_')}


def run(program, *arguments):
    done = subprocess.run([sys.executable, program, *arguments], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True)
    if done.returncode:
        raise AssertionError(done.stderr)
    return done.stdout


class PackageTest(unittest.TestCase):
    def test_the_stubs_have_what_the_modules_have(self):
        for module in (_core, _bag):
            with open(os.path.join(PACKAGE, module.__name__.split('.')[-1] + '.pyi')) as file:
                stub = defined(ast.parse(file.read()).body)
            self.assertEqual(set(stub), members(module))
            for name, thing in vars(module).items():
                if inspect.isclass(thing):
                    self.assertEqual({m for m in stub[name] if not m.startswith('_')}, members(thing), name)

    def test_every_name_exists_and_is_explained(self):
        for name in ts.__all__:
            self.assertTrue(inspect.getdoc(getattr(ts, name)), name)
        self.assertLessEqual(set(ts.__all__), set(dir(ts)))
        with self.assertRaises(AttributeError):
            ts.colour

    def test_the_page_names_everything_and_its_example_prints_what_it_says(self):
        with open(os.path.join(ROOT, 'doc', 'python.md')) as file:
            page = file.read()
        for name in ts.__all__:
            self.assertIn(name, page)
        code, output = re.search(r'```python\n(.*?)```.*?```text\n(.*?)```', page, re.S).groups()
        with tempfile.TemporaryDirectory() as folder:
            program = os.path.join(folder, 'example.py')
            with open(program, 'w') as file:
                file.write(code)
            printed = run(program)
        number = r'\d{4,}'
        self.assertEqual(re.sub(number, 'N', printed), re.sub(number, 'N', output))
        for got, wanted in zip(re.findall(number, printed), re.findall(number, output)):
            self.assertAlmostEqual(float(got) / float(wanted), 1.0, delta=0.1)  # BLAS libraries round differently

    def test_the_example_runs(self):
        with tempfile.TemporaryDirectory() as folder:
            out = run(os.path.join(ROOT, 'examples', 'python', 'estimate_from_arrays.py'), folder)
            self.assertTrue(os.path.isfile(os.path.join(folder, 'young_modulus.png')))
        moduli = [float(modulus) for modulus in re.findall(r'E = ([\d.]+) kPa', out)]
        self.assertEqual(len(moduli), 2, out)
        self.assertLess(max(abs(modulus / 12 - 1) for modulus in moduli), 0.05, out)
        self.assertIn('missing: viscoelasticity', out)


if __name__ == '__main__':
    unittest.main()
