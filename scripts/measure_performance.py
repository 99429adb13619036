"""The tables of doc/performance.md: see scripts/measure_performance."""
import argparse
import json
import os
import subprocess
import tempfile

from measured_pages import machine, table, write

PEER = ((10, 3, 12), (16, 6, 4))  # cells along, cells across, frames
STEPS = 4  # implicit steps a frame of the full model, the peer's too
# law, nodes, counter, sense, bound: what the package is to reach
TARGETS = (
    ('linear', 5577, 'median_ms', 2.0, 'ms a frame'),
    ('linear', 20727, 'median_ms', 5.0, 'ms a frame'),
    ('linear', 20727, 'start_s', 3.0, 's to the first estimate'),
    ('neo_hookean', 1029, 'median_ms', 1000.0 / 30, 'ms a frame'),
    ('neo_hookean', 5577, 'median_ms', 8.0, 'ms a frame'),
    ('neo_hookean', 20727, 'median_ms', 20.0, 'ms a frame'),
    ('neo_hookean', 5577, 'start_s', 2.0, 's to the first estimate'),
    ('neo_hookean', 20727, 'start_s', 8.0, 's to the first estimate'),
)


def run_benchmark(program, choice):
    with tempfile.NamedTemporaryFile(suffix='.json') as out:
        subprocess.run([program, '--benchmark_out=' + out.name, '--benchmark_out_format=json',
                        '--benchmark_filter=bandwidth|' + choice], check=True)
        runs = json.load(out)['benchmarks']
    for run in runs:
        if run.get('error_occurred'):
            raise SystemExit(run['name'] + ': ' + run['error_message'])
    return {tuple(run['name'].split('/')[:2]): run for run in runs}


def run_peer(program, root):
    peers = {}
    for cells, across, frames in PEER:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([program, '--export', folder, str(cells), str(across), str(frames)], check=True)
            script = os.path.join(root, 'benchmark', 'performance', 'peer.py')
            out = subprocess.run(['python3', script, folder, str(STEPS)], check=True, stdout=subprocess.PIPE,
                                 env=dict(os.environ, OPENBLAS_NUM_THREADS='1'))
            peer = json.loads(out.stdout)
        nodes = (2 * cells + 1) * (2 * across + 1)**2
        peers[nodes] = peer
        print('peer', nodes, peer, flush=True)
    return peers


def digits(value):
    return f'{value:.2f}' if value < 10 else f'{value:,.0f}' if value >= 100 else f'{value:.1f}'


def cost_table(runs, law):
    rows = []
    in_full = law != 'linear'  # in the second and third frame
    for (name, _), r in runs.items():
        if name == law:
            first = [digits(r['first_ms']), f"{r['first_ms'] / r['median_ms']:.1f}"] if in_full else []
            rows.append([f"{r['nodes']:,.0f}", *first, digits(r['median_ms']), digits(r['p99_ms']), digits(r['start_s']),
                         digits(r['replay_s']), f"{r['heap_kB']:,.0f}", f"{r['heap_requests']:,.0f}",
                         f"{r['peak_MB']:,.0f}", f"{r['basis_um']:.1f}" if r['basis_um'] > 0 else '-',
                         f"{r['error_pct']:+.3f} %"])
    first = ['frame in full [ms]', 'over the median'] if in_full else []
    return table(['nodes', *first, 'frame, median [ms]', 'p99 [ms]', 'first estimate [s]', 'reprocessing [s]',
                  'heap [kB a frame]', 'requests', 'peak memory [MB]', 'basis error [um]', 'E off'], rows)


def peer_table(runs, peers):
    rows = []
    for nodes, peer in peers.items():
        if ('linear', str(nodes)) not in runs:
            continue
        ours, theirs = runs[('linear', str(nodes))]['median_ms'], 1e3 * peer['seconds_per_frame']
        rows.append([f'{nodes:,}', digits(theirs), digits(ours), f'{theirs / ours:,.0f}'])
    return table(['nodes', 'peer [ms a frame]', 'ours [ms a frame]', 'ratio'], rows)


def limit_table(runs):
    speed = runs[('bandwidth', 'iterations:1')]['GB_per_s']
    rows = []
    for (law, _), r in runs.items():
        if law == 'bandwidth':
            continue
        limit = 2.0 * STEPS * r['factor_MB'] / speed  # ms: a solve reads the factor forwards and backwards
        rows.append([law.replace('_', '-'), f"{r['nodes']:,.0f}", digits(r['factor_MB']), digits(limit),
                     digits(r['median_ms']), digits(r['median_ms'] / limit)])
    return f'Memory is read at {speed:.1f} GB/s.\n\n' + table(
        ['law', 'nodes', 'factor [MB]', 'limit [ms a frame]', 'ours [ms a frame]', 'ours over limit'], rows)


def target_table(runs):
    rows = []
    for law, nodes, counter, bound, unit in TARGETS:
        if (law, str(nodes)) not in runs:
            continue
        value = runs[(law, str(nodes))][counter]
        rows.append([law.replace('_', '-'), f'{nodes:,}', f'{bound:.3g} {unit}', digits(value),
                     'yes' if value < bound else 'NO'])
    return table(['law', 'nodes', 'wanted, below', 'measured', 'reached'], rows)


def main():
    parser = argparse.ArgumentParser(prog='measure_performance')
    parser.add_argument('root')
    parser.add_argument('program')
    parser.add_argument('--output', help='the page whose tables are written; doc/performance.md')
    parser.add_argument('--filter', default='.', help='regular expression: benchmarks to run, as neo_hookean/5577')
    arguments = parser.parse_args()
    about = machine()
    runs = run_benchmark(arguments.program, arguments.filter)
    peers = run_peer(arguments.program, arguments.root)
    tables = {'machine': about, 'targets': target_table(runs), 'linear': cost_table(runs, 'linear'),
              'neo_hookean': cost_table(runs, 'neo_hookean'), 'peer': peer_table(runs, peers),
              'limit': limit_table(runs)}
    for text in tables.values():
        print(text)
    write(arguments.output or os.path.join(arguments.root, 'doc', 'performance.md'), tables)


if __name__ == '__main__':
    main()
