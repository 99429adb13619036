"""What the experiments share: running the tools, clouds in bags, tables in doc/paper.md."""
import collections
import json
import os
import re
import subprocess
import sys
import time

import numpy as np
import rosbag
import rospy
import sensor_msgs.point_cloud2 as point_cloud2
import yaml
from sensor_msgs.msg import PointField
from std_msgs.msg import Header

TOPIC = '/tissue/vertices'
MODULUS = 'elasticity.young_modulus'
TIME_LIMIT = 600  # s a run of a tool
SECTION = '<!-- measured: %s -->\n'
END = '<!-- end -->'


Place = collections.namedtuple('Place', 'root tools output shared')


class Workshop:
    """Where the experiments run: tools, a folder for what they make, a line of progress for each piece of work."""

    def __init__(self, place, steps, name):
        self.root, self.tools, self.folder = place.root, place.tools, os.path.join(place.output, name)
        self.steps, self.name, self.done, self.since = steps, name, 0, time.time()
        os.makedirs(self.folder, exist_ok=True)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def progress(self, what):
        self.done += 1
        print('%s %d/%d, %.0f s: %s' % (self.name, self.done, self.steps, time.time() - self.since, what), file=sys.stderr,
              flush=True)

    def write(self, name, content):
        with open(self.path(name), 'w') as file:
            yaml.safe_dump(content, file, default_flow_style=None, sort_keys=False)
        return self.path(name)

    def call(self, tool, *arguments):
        command = [os.path.join(self.tools, tool)] + list(arguments)
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True,
                              timeout=TIME_LIMIT)
        if done.returncode not in (0, 3):  # 3: answered, but not to be used
            sys.exit('paper_experiments: %s\n%s' % (' '.join(command), done.stderr.strip()))
        return done.stdout

    def simulate(self, name, scene):
        bag = self.path(name + '.bag')
        self.call('simulate', self.write(name + '.yaml', scene), '--output', bag, '--quiet')
        return bag

    def estimate(self, name, model, bag):
        """results.json and the rows of estimates.csv."""
        out = self.path(name)
        self.call('estimate', self.write(name + '.yaml', model), bag, '--output', out, '--quiet')
        with open(os.path.join(out, 'results.json')) as file:
            results = json.load(file)
        columns = np.genfromtxt(os.path.join(out, 'estimates.csv'), delimiter=',', names=True, dtype=None, encoding='utf8')
        return results, np.atleast_1d(columns)


def read_cloud(bag, topic=TOPIC, name='vertex'):
    """Times since the first stamp [s], numbers of the points, positions of frame x point x 3 [m]."""
    times, frames, ids = [], [], None
    with rosbag.Bag(bag) as file:
        for _, cloud, _ in file.read_messages(topic):
            rows = np.array(list(point_cloud2.read_points(cloud, ('x', 'y', 'z', name))))
            ids = rows[:, 3].astype(int)
            times.append(cloud.header.stamp.to_sec())
            frames.append(rows[:, :3])
    return np.array(times) - times[0], ids, np.array(frames)


def write_vertices(path, times, ids, frames):
    """Tracked vertices at these times [s]; the first frame says when the recording starts."""
    fields = [PointField(axis, 4 * i, PointField.FLOAT32, 1) for i, axis in enumerate('xyz')]
    fields.append(PointField('vertex', 12, PointField.INT32, 1))
    with rosbag.Bag(path, 'w') as file:
        for t, points in zip(times, frames):
            stamp = rospy.Time.from_sec(1e9 + t)
            rows = [(p[0], p[1], p[2], i) for p, i in zip(points, ids.tolist())]
            file.write(TOPIC, point_cloud2.create_cloud(Header(stamp=stamp, frame_id='model'), fields, rows), stamp)
    return path


def table(head, rows):
    lines = ['| ' + ' | '.join(head) + ' |', '|' + '---|' * len(head)]
    return '\n'.join(lines + ['| ' + ' | '.join(row) + ' |' for row in rows]) + '\n'


def publish(root, name, text):
    """Prints a table and puts it where doc/paper.md has a place of that name."""
    print(text, flush=True)
    page = os.path.join(root, 'doc', 'paper.md')
    with open(page) as file:
        old = file.read()
    place = re.compile('(' + re.escape(SECTION % name) + ').*?(?=' + re.escape(END) + ')', re.S)
    if not place.search(old):
        sys.exit('paper_experiments: doc/paper.md has no place for ' + name)
    with open(page, 'w') as file:
        file.write(place.sub(lambda match: match.group(1) + text, old))


def modulus(results):
    """Mean, standard deviation and interval of Young's modulus [kPa]."""
    found = results['parameters'][MODULUS]
    return found['mean'] / 1e3, found['std'] / 1e3, [bound / 1e3 for bound in found['interval95']]
