"""The memory of the nodes over a recording that is played again and again: see scripts/measure_memory."""
import argparse
import os
import signal
import statistics
import subprocess
import sys
import time

STEP = 5.0  # s between samples


def processes(launch):
    """Process numbers of the nodes, by name."""
    found = {}
    children = subprocess.run(['ps', '--ppid', str(launch), '-o', 'pid=,args='], stdout=subprocess.PIPE,
                              universal_newlines=True).stdout
    for line in children.splitlines():
        number, command = line.split(None, 1)
        program = os.path.basename(command.split()[0])
        if program in ('estimator_node', 'mesh_node', 'segmentation_node'):
            found[program] = int(number)
    return found


def resident(number):
    with open('/proc/%d/status' % number) as file:
        for line in file:
            if line.startswith('VmRSS'):
                return int(line.split()[1]) / 1024.0
    return float('nan')


def worked(number):
    """Seconds of a processor's time."""
    with open('/proc/%d/stat' % number) as file:
        fields = file.read().rsplit(')', 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


def main():
    parser = argparse.ArgumentParser(prog='measure_memory')
    parser.add_argument('root')
    parser.add_argument('model')
    parser.add_argument('recording')
    parser.add_argument('--minutes', type=float, default=20.0)
    arguments = parser.parse_args()
    launch = subprocess.Popen(['roslaunch', 'tissue_stiffness', 'replay.launch', 'options:=--loop',
                               'model:=' + os.path.abspath(arguments.model), 'bag:=' + os.path.abspath(arguments.recording)],
                              stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
    courses, busy = {}, {}
    try:
        time.sleep(4 * STEP)
        nodes = processes(launch.pid)
        if 'estimator_node' not in nodes:
            sys.exit('measure_memory: no estimator_node among the processes of roslaunch')
        end = time.time() + 60.0 * arguments.minutes
        while time.time() < end:
            time.sleep(STEP)
            if launch.poll() is not None:
                sys.exit('measure_memory: the nodes ended')
            for name, number in nodes.items():
                courses.setdefault(name, []).append(resident(number))
                busy[name] = worked(number)
    finally:
        launch.send_signal(signal.SIGINT)
        launch.wait(timeout=60)
    print('%.0f minutes; a model check comes and goes meanwhile, so that what is held goes up and down.\n' % arguments.minutes)
    print('| node | median of the first third [MB] | of the last third | growth | most | processor [s] |')
    print('|---|---|---|---|---|---|')
    for name, course in sorted(courses.items()):
        third = len(course) // 3
        first, last = statistics.median(course[:third]), statistics.median(course[-third:])
        print('| %s | %.1f | %.1f | %+.1f %% | %.1f | %.0f |' %
              (name, first, last, 100 * (last / first - 1), max(course), busy[name]))


if __name__ == '__main__':
    main()
