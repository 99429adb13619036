"""A recording played into the three nodes with roslaunch and rosbag: see scripts/acceptance."""
import os
import re
import signal
import subprocess

ESTIMATE = re.compile(r'(\S+) = (\S+) \S* ?\(95 %: (\S+) to (\S+)\)')
FRAMES = re.compile(r'after (\d+) frames')


def play(model, bag, output, time_limit, rate=1.0):
    """{mean, interval95, frames} of each parameter as the nodes publish it last, or a text that says why there is none.

    Needs the build's environment and a port for a master of our own (ROS_MASTER_URI).
    """
    os.makedirs(output, exist_ok=True)
    result, log = os.path.join(output, 'live.txt'), os.path.join(output, 'roslaunch.log')
    if os.path.exists(result):
        os.remove(result)
    command = ['roslaunch', '-p', os.environ['ROS_MASTER_URI'].rsplit(':', 1)[1], 'tissue_stiffness', 'demo.launch',
               'model:=' + os.path.abspath(model), 'bag:=' + os.path.abspath(bag), 'rate:=%g' % rate,
               'result:=' + os.path.abspath(result), 'improve:=false', 'diagnosis_period:=0']
    with open(log, 'w') as file:
        launch = subprocess.Popen(command, stdout=file, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
    try:
        launch.wait(timeout=time_limit)
    except subprocess.TimeoutExpired:
        return 'not done after %d s, see %s' % (time_limit, log)
    finally:
        if launch.poll() is None:
            launch.send_signal(signal.SIGINT)
            launch.wait()
    if not os.path.exists(result):
        return 'the nodes gave no estimate, see ' + log
    with open(result) as file:
        return parse(file.read())


def parse(text):
    found = {name: {'mean': float(mean), 'interval95': [float(low), float(high)]}
             for name, mean, low, high in ESTIMATE.findall(text)}
    frames = FRAMES.search(text)
    if not found or not frames:
        return 'cannot read ' + text.strip()
    for entry in found.values():
        entry['frames'] = int(frames.group(1))
    return found
