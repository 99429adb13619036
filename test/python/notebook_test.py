"""The notebook, its cells one after the other as Jupyter runs them."""
import ast
import importlib.util
import json
import os
import unittest

from bench import ROOT

FOLDER = os.path.join(ROOT, 'examples', 'python')


def run_cell(source, names):
    """Runs a cell and returns the value of its last expression, as Jupyter shows it."""
    body = ast.parse(source).body
    last = body.pop() if isinstance(body[-1], ast.Expr) else None
    exec(compile(ast.Module(body, []), 'cell', 'exec'), names)
    return None if last is None else eval(compile(ast.Expression(last.value), 'cell', 'eval'), names)


MISSING = [name for name in ('pandas', 'matplotlib') if importlib.util.find_spec(name) is None]


@unittest.skipIf(MISSING, 'not installed: ' + ', '.join(MISSING))
class NotebookTest(unittest.TestCase):
    def test_its_cells_find_what_is_missing(self):
        with open(os.path.join(FOLDER, 'what_is_missing.ipynb')) as file:
            notebook = json.load(file)
        self.assertEqual(notebook['nbformat'], 4)
        here = os.getcwd()
        self.addCleanup(os.chdir, here)
        os.chdir(FOLDER)
        names = {'__name__': '__main__'}
        cells = [''.join(cell['source']) for cell in notebook['cells'] if cell['cell_type'] == 'code']
        shown = [run_cell(cell, names) for cell in cells]
        self.assertEqual(names['before'].state, 'model_invalid')
        self.assertEqual(names['after'].state, 'converged')
        low, high = names['after'].interval
        self.assertTrue(low < 12e3 < high, (low, high))
        self.assertLess(names['after'].rms_error, 0.5 * names['before'].rms_error)
        self.assertGreater(names['diagnosis'].probabilities['viscoelasticity'], 0.9)
        self.assertEqual(len(shown[1]), 5)  # the table's last rows
        for cell in notebook['cells']:
            self.assertFalse(cell.get('outputs'), 'outputs belong to whoever runs it')


if __name__ == '__main__':
    unittest.main()
