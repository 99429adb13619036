"""Many recordings, shared out, killed and resumed: see scripts/measure_many."""
import os
import random
import shutil
import signal
import subprocess
import sys
import time

from measured_pages import table as page_table, write

SCENE = '''mesh: {{file: bar.vtk, boundary: faceted, discretisation_error: false}}
regions:
  clamp: {{box: {{min: [-1, -1, -1], max: [1.0e-6, 1, 1]}}}}
  end: {{box: {{min: [0.099999, -1, -1], max: [1, 1, 1]}}}}
effects:
  - inertia: {{density: 1000}}
  - elasticity: {{law: linear, young_modulus: {modulus}, poisson_ratio: 0.4}}
  - fixed: {{region: clamp}}
  - traction: {{region: end, topic: force}}
observations:
  - vertices: {{topic: end, noise: 1.0e-4}}
inputs: exact
'''
MOTION = '''simulation:
  duration: 0.3
  rate: 40
  step: 0.001
  seed: {seed}
  loads: {{force: {{rate: 200, terms: [{{direction: [0, 0, 1], raised_cosine: {{amplitude: 0.05, frequency: 3}}}}]}}}}
'''


class Bench:
    def __init__(self, root, folder, run):
        self.run = run
        self.folder = folder
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        shutil.copy(os.path.join(root, 'examples', 'estimate_from_arrays', 'bar.vtk'), folder)
        self.list = os.path.join(folder, 'list.csv')

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, 'w') as file:
            file.write(text)
        return path

    def simulate(self, count):
        """A recording a row, each with its own modulus and noise; every fiftieth is none."""
        self.write('model.yaml', SCENE.format(modulus='{prior: 40.0e+3, factor: 3}'))
        rows = ['truth,model,recording']
        for k in range(count):
            bag = os.path.join(self.folder, 'r%03d.bag' % k)
            modulus = 20e3 * 3 ** (k / count)
            if k % 50 == 49:
                self.write('r%03d.bag' % k, 'no recording')
            else:
                scene = self.write('scene.yaml', SCENE.format(modulus=modulus) + MOTION.format(seed=k))
                subprocess.run([self.run, 'simulate', scene, '--output', bag, '--quiet'], check=True)
            rows.append('%.1f,model.yaml,r%03d.bag' % (modulus, k))
        self.write('list.csv', '\n'.join(rows) + '\n')

    def command(self, results, *more):
        return [self.run, 'estimate', '--manifest', self.list, '--output', os.path.join(self.folder, results), '--quiet', *more]

    def merge(self, results):
        table = os.path.join(self.folder, results + '.csv')
        subprocess.run(self.command(results, '--merge', table), check=True)
        with open(table, 'rb') as file:
            return file.read()

    def shard(self, results, number, shards):
        return subprocess.Popen(self.command(results, '--shard', '%d/%d' % (number, shards), '--resume'),
                                stderr=subprocess.DEVNULL, start_new_session=True)

    def killed_and_resumed(self, results, shards, kills):
        """All shards at once; one of them is killed at a random instant, with SIGKILL or SIGTERM, and begun again."""
        chance = random.Random(1)
        running = {number: self.shard(results, number, shards) for number in range(1, shards + 1)}
        done = 0
        while done < kills and any(process.poll() is None for process in running.values()):
            time.sleep(chance.uniform(0.1, 3.0))
            number = chance.choice([n for n, process in running.items() if process.poll() is None] or [0])
            if number == 0:
                break
            sent = chance.choice([signal.SIGKILL, signal.SIGTERM])
            running[number].send_signal(sent)
            running[number].wait()
            done += 1
            running[number] = self.shard(results, number, shards)
        for number, process in running.items():
            if process.wait() != 0:
                sys.exit('measure_many: shard %d ended with %d' % (number, process.returncode))
        return done


def main():
    root, folder = sys.argv[1:3]
    count, shards, kills = [int(x) for x in sys.argv[3:]] + [300, 3, 30][len(sys.argv) - 3:]
    bench = Bench(root, folder, os.path.join(root, 'scripts', 'run'))
    bench.simulate(count)
    start = time.monotonic()
    subprocess.run(bench.command('whole', '--threads', '2'), check=True)
    seconds = time.monotonic() - start
    table = bench.merge('whole')
    killed = bench.killed_and_resumed('shared', shards, kills)
    same = bench.merge('shared') == table
    folders = len(os.listdir(os.path.join(folder, 'shared')))
    answered = sum(line.split(',')[3] in ('0', '3') for line in table.decode().splitlines()[1:])
    print('%d recordings, %d of them answered: %d rows' % (count, answered, table.count(b'\n') - 1))
    print('in one go: %.2f s a recording with two processes on %d cores' % (seconds / count, os.cpu_count()))
    print('in %d shards, killed %d times and resumed: %s table, %d folders' %
          (shards, killed, 'an identical' if same else 'ANOTHER', folders))
    if not same or table.count(b'\n') != count + 1 or folders != count:
        sys.exit(1)
    write(os.path.join(root, 'doc', 'many_recordings.md'), {'many_recordings': page_table(
        ['recordings', 'answered', 'shards', 'times killed', 'rows', 'table'],
        [[str(n) for n in (count, answered, shards, killed, table.count(b'\n') - 1)] + ['identical']])})


if __name__ == '__main__':
    main()
