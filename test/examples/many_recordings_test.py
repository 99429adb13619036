"""Many recordings: killed and resumed, and by the engines of examples/many_recordings where they are installed.

The environment names the folder of the tools in TOOLS.
"""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
EXAMPLES = os.path.join(ROOT, 'examples', 'many_recordings')
sys.path.insert(0, os.path.join(ROOT, 'scripts'))
import one_machine_slurm  # noqa: E402
from measure_many import Bench  # noqa: E402

COUNT = 7


def answers(*command):
    return shutil.which(command[0]) and subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                                       timeout=600).returncode == 0


class ManyRecordings(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        run = os.path.join(cls.folder, 'run')
        with open(run, 'w') as file:
            file.write('#!/bin/sh\ntool=$1\nshift\nexec "%s/$tool" "$@"\n' % os.environ['TOOLS'])
        os.chmod(run, 0o755)
        os.environ['RUN'] = run
        cls.bench = Bench(ROOT, os.path.join(cls.folder, 'many'), run)
        cls.bench.simulate(COUNT)
        with open(os.path.join(cls.bench.folder, 'r003.bag'), 'w') as file:
            file.write('no recording')
        subprocess.run(cls.bench.command('whole'), check=True)
        cls.table = cls.bench.merge('whole')

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def test_each_recording_has_a_row(self):
        rows = self.table.decode().splitlines()[1:]
        codes = [row.split(',')[3] for row in rows]
        self.assertEqual(len(rows), COUNT)
        self.assertEqual(codes[3], '2')
        self.assertTrue(all(code in ('0', '3') for code in codes[:3] + codes[4:]), codes)

    def test_killed_shards_are_resumed(self):
        self.bench.killed_and_resumed('shared', 3, 4)
        self.assertEqual(self.bench.merge('shared'), self.table)
        self.assertEqual(len(os.listdir(os.path.join(self.bench.folder, 'shared'))), COUNT)

    def check(self, *command):
        """The engine's table has the bytes of the run in one go."""
        subprocess.run(command, check=True, cwd=self.bench.folder, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)

    def table_of(self, name):
        with open(os.path.join(self.bench.folder, name), 'rb') as file:
            return file.read()

    @unittest.skipUnless(answers('parallel', '--version'), 'GNU parallel is not installed')
    def test_gnu_parallel(self):
        self.check(os.path.join(EXAMPLES, 'parallel.sh'), self.bench.list, 'by_parallel', '3', 'by_parallel.csv')
        self.assertEqual(self.table_of('by_parallel.csv'), self.table)

    @unittest.skipUnless(answers('snakemake', '--version'), 'Snakemake is not installed')
    def test_snakemake(self):
        self.check('snakemake', '-s', os.path.join(EXAMPLES, 'Snakefile'), '--cores', '2', '--config', 'list=' + self.bench.list,
                   'results=by_snakemake', 'table=by_snakemake.csv', 'shards=3')
        self.assertEqual(self.table_of('by_snakemake.csv'), self.table)

    @unittest.skipUnless(one_machine_slurm.installed(), 'Slurm is not installed')
    def test_slurm(self):
        with one_machine_slurm.controller():
            self.check('sbatch', '--wait', os.path.join(EXAMPLES, 'slurm.sh'), self.bench.list,
                       os.path.join(self.bench.folder, 'by_slurm'))
        self.assertEqual(self.bench.merge('by_slurm'), self.table)

    @unittest.skipUnless(answers('nextflow', '-version'), 'Nextflow is not installed')
    def test_nextflow(self):
        table = os.path.join(self.bench.folder, 'by_nextflow.csv')
        self.check('nextflow', 'run', os.path.join(EXAMPLES, 'main.nf'), '--list', self.bench.list, '--results',
                   os.path.join(self.bench.folder, 'by_nextflow'), '--table', table, '--shards', '3')
        self.assertEqual(self.table_of('by_nextflow.csv'), self.table)

    def test_the_scripts_are_shell(self):
        for name in ('parallel.sh', 'slurm.sh'):
            subprocess.run(['bash', '-n', os.path.join(EXAMPLES, name)], check=True)


if __name__ == '__main__':
    unittest.main(verbosity=2)
