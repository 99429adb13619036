"""A long run of the nodes with faults: see scripts/soak."""
import argparse
import json
import os
import signal
import statistics
import struct
import subprocess
import sys
import tempfile
import threading
import time

import roslib.packages
import rospy
from diagnostic_msgs.msg import DiagnosticArray

import fault_runs
from figures import plt, save
from measure_memory import processes, resident
from tissue_stiffness.msg import InjectedFault, StiffnessEstimate

LENGTH = 60.0              # s, of the recording
QUIET, ACTIVE = 6.0, 4.0   # s, of no faults and of faults, between stamps
RECOVERY = 5.0             # s
MUTES = 0.2                # Hz, of each topic
SINGLE = [kind for kind in fault_runs.KINDS if kind != 'mute']
STATES = ('converged', 'converging', 'doubtful', 'drifting', 'stale', 'model_invalid', 'no_data')
COLOURS = ('#2c7fb8', '#a6bddb', '#c8664f', '#e6a15c', '#999999', '#333333', '#dddddd')
INJECTOR = '/fault_injector'
TOPICS = ('/tissue/vertices', '/tool/wrench')
LONGEST = 10.0             # s, of a latency; what is apart for longer belongs to two replays
SAMPLING = 0.5             # s, between samples of the memory
SPAN = 10                  # minutes, within which a model check has ended and the next one has not begun
GROWTH = 0.02              # of the memory between model checks, from the first third to the last
MOST_SHOWN = 20            # wrong estimates that the raw data keep in full


def rate_of_faults(arguments):
    """The probability of each single fault per message that gives as many faults as wanted."""
    messages = 60.0 * arguments.minutes * arguments.rate * (fault_runs.CLOUDS + fault_runs.WRENCHES)
    share = ACTIVE / (ACTIVE + QUIET)
    rate = arguments.faults / (messages * share * len(SINGLE))
    if not 0.0 < rate <= 0.1:
        sys.exit('soak: --faults: found %d; allowed: up to %d in %g minutes' %
                 (arguments.faults, 0.1 * messages * share * len(SINGLE), arguments.minutes))
    return rate


class Recorder:
    """Hears faults, clouds and estimates, and keeps what a minute's row needs."""

    def __init__(self):
        self.lock = threading.Lock()
        self.loop, self.last = {}, {}
        self.arrivals, self.answers, self.latencies, self.states = {}, {}, [], {}
        self.faults, self.estimates, self.counts = [], [], {}
        self.wrong, self.broken, self.values, self.total = [], [], {}, 0
        self.subscribers = [
            rospy.Subscriber('/faults', InjectedFault, self.on_fault, queue_size=10000),
            rospy.Subscriber(TOPICS[0], rospy.AnyMsg, self.on_cloud, queue_size=10000, tcp_nodelay=True),
            rospy.Subscriber('/stiffness', StiffnessEstimate, self.on_estimate, queue_size=10000, tcp_nodelay=True),
            rospy.Subscriber('/diagnostics', DiagnosticArray, self.on_diagnostics, queue_size=100)]

    def replay_number(self, name, stamp):
        """Counts the replays by the stamps, which begin again with each of them."""
        if stamp < self.last.get(name, 0.0) - 0.5 * LENGTH:
            self.loop[name] = self.loop.get(name, 0) + 1
            self.last[name] = 0.0
        self.last[name] = max(stamp, self.last.get(name, 0.0))
        return self.loop.get(name, 0)

    def on_fault(self, message):
        with self.lock:
            number = self.replay_number(message.topic, message.header.stamp.to_sec())
            self.faults.append((number, message))
            self.counts[message.fault] = self.counts.get(message.fault, 0) + 1

    def on_cloud(self, message):
        now = time.monotonic()
        if len(message._buff) < 12:  # a cut message
            return
        seconds, nanoseconds = struct.unpack_from('<II', message._buff, 4)
        with self.lock:
            self.pair(10**9 * seconds + nanoseconds, now, self.arrivals, self.answers)

    def pair(self, stamp, now, own, others):
        """Cloud and estimate of a stamp reach this process on two connections, so either may be the first."""
        other = others.pop(stamp, None)
        if other is None or now - other > LONGEST:
            own[stamp] = now
        else:
            self.latencies.append(1e3 * (now - other) * (1.0 if own is self.answers else -1.0))

    def on_estimate(self, message):
        now = time.monotonic()
        with self.lock:
            if message.state != 'stale':  # it has an old stamp
                self.pair(message.header.stamp.to_nsec(), now, self.answers, self.arrivals)
            number = self.replay_number('estimates', message.header.stamp.to_sec())
            self.total += 1
            self.states[message.state] = self.states.get(message.state, 0) + 1
            self.estimates.append((number, message))
            reason = fault_runs.broken(message)
            if reason:
                self.broken.append(reason)
            if message.state == 'converged' and fault_runs.excludes_truth(message):
                self.wrong.append({'replay': number, 'stamp': message.header.stamp.to_sec(), 'E': message.young_modulus,
                                   'interval95': [message.young_modulus_lower95, message.young_modulus_upper95]})

    def on_diagnostics(self, message):
        with self.lock:
            for status in message.status:
                if status.name.endswith('estimator'):
                    self.values = {entry.key: entry.value for entry in status.values}

    def take_row(self):
        """What was heard since the last row; the lists begin anew."""
        with self.lock:
            late, states = sorted(self.latencies), self.states
            self.latencies, self.states = [], {}
        return {'frames': len(late), 'p50_ms': late[len(late) // 2] if late else None,
                'p99_ms': late[int(0.99 * (len(late) - 1))] if late else None, 'states': states,
                'faults': sum(self.counts.values())}

    def recoveries(self):
        """Seconds of each spell of faults until every estimate was converged, and of each replay the first such estimate."""
        out = []
        for replay in sorted({number for number, _ in self.faults}):
            faults = [message for number, message in self.faults if number == replay]
            estimates = [message for number, message in self.estimates if number == replay]
            if not estimates:
                continue
            newest = max(estimate.header.stamp.to_sec() for estimate in estimates)
            for end, until in fault_runs.spells(faults, QUIET, ACTIVE):
                if end + RECOVERY < min(newest, until):
                    out.append({'replay': replay, 'end': end, 'seconds': fault_runs.recovery(estimates, end, until)})
        return out


def start_injector(arguments, rate):
    topics = [{'input': '/sensors' + topic, 'output': topic} for topic in TOPICS]
    settings = dict({kind: rate for kind in SINGLE}, topics=topics, seed=arguments.seed, mute=MUTES, longest_mute=2.0,
                    active=ACTIVE, quiet=QUIET)
    rospy.set_param(INJECTOR, settings)
    injector = roslib.packages.find_node('tissue_stiffness', 'fault_injector')[0]
    return subprocess.Popen([injector, '__name:=' + INJECTOR[1:]], stdin=subprocess.DEVNULL), settings


def start_nodes(bag, rate, log):
    return subprocess.Popen(['roslaunch', '-p', os.environ['ROS_MASTER_URI'].rsplit(':', 1)[1], 'tissue_stiffness', 'replay.launch',
                             'options:=--loop --prefix=/sensors', 'rate:=%g' % rate, 'model:=' + fault_runs.MODEL, 'allow_outside:=true', 'bag:=' + bag,
                             'load_timeout:=0.2'], stdout=log, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)


class MemoryWatch:
    """Samples a process's resident memory, which goes up and down with each model check."""

    def __init__(self, number):
        self.number, self.lock, self.samples, self.ended = number, threading.Lock(), [], threading.Event()
        threading.Thread(target=self.watch, daemon=True).start()

    def watch(self):
        while not self.ended.wait(SAMPLING):
            try:
                sample = resident(self.number)
            except OSError:  # the process has ended
                return
            with self.lock:
                self.samples.append(sample)

    def take_row(self):
        with self.lock:
            samples, self.samples = self.samples, []
        samples = samples or [float('nan')]
        return {'rss_mb': statistics.median(samples), 'least_rss_mb': min(samples), 'most_rss_mb': max(samples)}


def run(arguments, rate, bag, log):
    injector, settings = start_injector(arguments, rate)
    recorder = Recorder()
    launch = start_nodes(bag, arguments.rate, log)
    rows, died = [], ''
    try:
        deadline = time.time() + 60.0
        while recorder.total == 0:
            if time.time() > deadline or launch.poll() is not None:
                sys.exit('soak: no estimate came')
            time.sleep(0.5)
        memory = MemoryWatch(processes(launch.pid)['estimator_node'])
        recorder.take_row()
        begun = time.time()
        while len(rows) < arguments.minutes and not died:
            time.sleep(max(0.0, begun + 60.0 * (len(rows) + 1) - time.time()))
            ended = [name for name, process in (('the nodes', launch), ('fault_injector', injector)) if process.poll() is not None]
            died = ', '.join(ended)
            if not died:
                rows.append(dict(recorder.take_row(), minute=len(rows) + 1, **memory.take_row()))
                print(rows[-1], flush=True)
        memory.ended.set()
    finally:
        for process in (launch, injector):
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
                process.wait(timeout=60)
    return {'minutes': len(rows), 'rate': arguments.rate, 'settings': settings, 'rows': rows, 'died': died,
            'faults': recorder.counts, 'estimates': recorder.total, 'broken': recorder.broken,
            'wrong': len(recorder.wrong), 'wrong_estimates': recorder.wrong[:MOST_SHOWN],
            'recoveries': recorder.recoveries(), 'diagnostics': recorder.values, 'replays': max(recorder.loop.values(), default=0) + 1}


def draw(data, path):
    rows = data['rows']
    minutes = [row['minute'] for row in rows]
    figure, (memory, latency, states) = plt.subplots(1, 3, figsize=(11, 3.1))
    for key, name, colour in (('rss_mb', 'median', COLOURS[1]), ('least_rss_mb', 'least', COLOURS[0])):
        memory.plot(minutes, [row[key] for row in rows], color=colour, label=name)
    memory.legend(fontsize=8, frameon=False)
    memory.set_title('resident memory [MB]', fontsize=10)
    memory.set_ylim(bottom=0)
    for key, name, colour in (('p50_ms', 'median', COLOURS[0]), ('p99_ms', '99th percentile', COLOURS[2])):
        latency.plot(minutes, [row[key] for row in rows], color=colour, label=name)
    latency.set_yscale('log')
    latency.set_title('cloud to estimate [ms]', fontsize=10)
    latency.legend(fontsize=8, frameon=False)
    shares = [[100.0 * row['states'].get(state, 0) / max(1, sum(row['states'].values())) for row in rows] for state in STATES]
    states.stackplot(minutes, shares, labels=STATES, colors=COLOURS)
    states.set_title('estimates by state [%]', fontsize=10)
    states.set_ylim(0, 100)
    states.legend(fontsize=7, loc='lower left')
    for axis in (memory, latency, states):
        axis.set_xlabel('minute')
    save(figure, path, 90, (memory, latency, states))


def held_memory(rows):
    """What the estimator holds between model checks [MB] in the first and in the last third of the run."""
    spans = [min(row['least_rss_mb'] for row in rows[begin:begin + SPAN]) for begin in range(0, len(rows), SPAN)]
    third = max(1, len(spans) // 3)
    return statistics.median(spans[:third]), statistics.median(spans[-third:])


def grows(data):
    first, last = held_memory(data['rows'])
    return last > (1.0 + GROWTH) * first


def page(data):
    rows, faults = data['rows'], data['faults']
    first, last = held_memory(rows)
    states = {state: sum(row['states'].get(state, 0) for row in rows) for state in STATES}
    total = max(1, sum(states.values()))
    seconds = [entry['seconds'] for entry in data['recoveries']]
    values = data['diagnostics']
    middle = [row['p50_ms'] for row in rows if row['frames']]
    worst = [row['p99_ms'] for row in rows if row['frames']]
    lines = [
        '# Reliability', '',
        '`scripts/soak` plays a recording into the nodes again and again. `fault_injector` sits between the recording and the nodes, '
        'and it makes faults for %g s in every %g s of the recording. The model is exact and the truth is known. So every `converged` '
        'estimate whose interval excludes the truth is counted as wrong. The script writes this page and `reliability.json`.' % (
            ACTIVE, ACTIVE + QUIET), '',
        'This run took %d minutes at %g times the recorded speed. It held %d faults in %d replays, on a machine that other programs '
        'used too.' % (data['minutes'], data['rate'], sum(faults.values()), data['replays']), '',
        '| what | found |', '|---|---|',
        '| nodes that ended | %s |' % (data['died'] or 'none'),
        '| estimates | %d |' % data['estimates'],
        '| estimates with a number that is not finite, or a modulus or variance that is not positive | %d |' % len(data['broken']),
        '| `converged` estimates whose interval excludes the truth | %d |' % data['wrong'],
        '| spells of faults | %d |' % len(seconds),
        '| spells after which every estimate was `converged` within %g s of the recording | %d |' % (
            RECOVERY, sum(value <= RECOVERY for value in seconds)),
        '| time until then, median and longest [s] | %.1f, %.1f |' % (statistics.median(seconds or [0.0]), max(seconds or [0.0])),
        '| memory of estimator_node between model checks, in the first and the last third [MB] | %.1f, %.1f |' % (first, last),
        '| growth of it | %+.1f %% |' % (100.0 * (last / first - 1.0)),
        '| most of its memory, during a model check [MB] | %.1f |' % max(row['most_rss_mb'] for row in rows),
        '| latency from cloud to estimate, median of the minutes\' medians [ms] | %.0f |' % statistics.median(middle or [0.0]),
        '| median and largest of the minutes\' 99th percentiles [ms] | %.0f, %.0f |' % (
            statistics.median(worst or [0.0]), max(worst or [0.0])),
        '| messages refused and counted as `bad messages` | %s |' % values.get('bad messages', '0'),
        '| messages left out for their stamps | %s |' % values.get('broken stamps', '0').split(',')[0], '',
        '| fault | how many |', '|---|---|'] + ['| %s | %d |' % (kind, faults.get(kind, 0)) for kind in fault_runs.KINDS] + [
        '', '| state | share of the estimates |', '|---|---|'] + [
        '| `%s` | %.1f %% |' % (state, 100.0 * states[state] / total) for state in STATES if states[state]] + [
        '', '![Memory, latency and states in each minute](reliability.png)', '',
        'Each replay starts from the prior, so its first estimates are `converging`. A mute counts as one fault, however many messages '
        'it swallows. A model check takes hundreds of megabytes for a while. So the least memory in each %d minutes tells what the '
        'node holds, and the table gives the median of these.' % SPAN]
    return '\n'.join(lines) + '\n'


def main():
    parser = argparse.ArgumentParser(prog='soak')
    parser.add_argument('root')
    parser.add_argument('--minutes', type=int, default=60)
    parser.add_argument('--faults', type=int, default=40000, help='wanted in all')
    parser.add_argument('--rate', type=float, default=2.0, help='of the replay')
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--output', help='folder of the page; doc')
    arguments = parser.parse_args()
    rate = rate_of_faults(arguments)
    output = arguments.output or os.path.join(arguments.root, 'doc')
    os.makedirs(output, exist_ok=True)
    rospy.init_node('soak', disable_rostime=True, disable_signals=True)
    with tempfile.TemporaryDirectory() as folder, open(os.path.join(folder, 'nodes.log'), 'w') as log:
        bag = os.path.join(folder, 'recording.bag')
        fault_runs.write_recording(LENGTH, bag)
        data = run(arguments, rate, bag, log)
    with open(os.path.join(output, 'reliability.json'), 'w') as file:
        json.dump(data, file, indent=1)
        file.write('\n')
    draw(data, os.path.join(output, 'reliability.png'))
    with open(os.path.join(output, 'reliability.md'), 'w') as file:
        file.write(page(data))
    print(page(data))
    sys.exit(1 if data['died'] or data['wrong'] or data['broken'] or grows(data) else 0)


if __name__ == '__main__':
    main()
