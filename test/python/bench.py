"""A folder for each test, with recordings of a bar whose properties are known. TOOLS is the tools' folder."""
import os
import shutil
import subprocess
import tempfile
import unittest

import numpy as np
import tissue_stiffness as ts

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BAR = os.path.join(ROOT, 'examples', 'estimate_from_arrays', 'bar.vtk')
MODEL = '''
mesh: {file: bar.vtk, boundary: faceted, discretisation_error: false}
regions:
  clamp: {box: {min: [-1, -1, -1], max: [1.0e-6, 1, 1]}}
  end: {box: {min: [0.099999, -1, -1], max: [1, 1, 1]}}
  near: {box: {min: [-1, -1, -1], max: [0.05, 1, 1]}}
  far: {box: {min: [0.05, -1, -1], max: [1, 1, 1]}}
effects:
'''
INERTIA = '- inertia: {density: 1060}\n- fixed: {region: clamp}\n'
PULL = '- traction: {region: end, topic: /wrench}\n'
GRAVITY = '- gravity: {acceleration: [0, 0, -9.81]}\n'
DAMPING = '- viscous_damping: {beta: 4.0e-3}\n'
SEEN = 'observations:\n- vertices: {topic: /vertices, noise: 2.0e-4}\n'
PULLED = '''simulation:
  duration: 1
  rate: 30
  step: 0.001
  seed: 3
  loads:
    /wrench:
      rate: 200
      terms:
      - {direction: [1, 0, 0], raised_cosine: {amplitude: 0.1, frequency: 1}}
      - {direction: [0, 0, 1], sine: {amplitude: 0.002, frequency: 1}}
'''
FALLEN = 'simulation: {duration: 0.5, rate: 60, step: 0.001}\n'


def elasticity(modulus, region=None):
    where = ', region: %s' % region if region else ''
    return '- elasticity: {law: linear, young_modulus: %s, poisson_ratio: 0.3%s}\n' % (modulus, where)


def unknown(modulus):
    return '{prior: %s, factor: 3}' % modulus


def arrays(bag, topic='/vertices', load='/wrench'):
    """Frames as (stamp, points, ids), and loads as (stamps, values): read by ROS's own Python."""
    import rosbag
    from sensor_msgs import point_cloud2
    frames, stamps, values = [], [], []
    with rosbag.Bag(bag) as content:
        for name, message, _ in content.read_messages(topics=[topic, load]):
            stamp = message.header.stamp.to_sec()
            if name == topic:
                rows = list(point_cloud2.read_points(message, field_names=('x', 'y', 'z', 'vertex')))
                frames.append((stamp, np.array([row[:3] for row in rows]), np.array([row[3] for row in rows])))
            else:
                force, torque = message.wrench.force, message.wrench.torque
                stamps.append(stamp)
                values.append([force.x, force.y, force.z, torque.x, torque.y, torque.z])
    return frames, stamps, values


class Bench(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        shutil.copy(BAR, self.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), 'w') as file:
            file.write(text)
        return self.path(name)

    def tool(self, *arguments):
        done = subprocess.run([os.path.join(os.environ['TOOLS'], arguments[0]), *arguments[1:], '--quiet'],
                              stderr=subprocess.PIPE, universal_newlines=True)
        self.assertIn(done.returncode, (0, 3), done.stderr)  # 3: answered, but not to be used

    def simulate(self, effects, simulation):
        """The path of a bag."""
        scene = self.write('scene.yaml', MODEL + effects + SEEN + simulation)
        self.tool('simulate', scene, '--output', self.path('recording.bag'))
        return self.path('recording.bag')

    def write_model(self, effects):
        return self.write('model.yaml', MODEL + effects + SEEN)

    def refuses(self, call, *words):
        """Checks that the call raises InputError with all the words, on one line."""
        with self.assertRaises(ts.InputError) as caught:
            call()
        text = str(caught.exception)
        self.assertIsInstance(caught.exception, ValueError)
        self.assertNotIn('\n', text)
        for word in words:
            self.assertIn(word, text)
