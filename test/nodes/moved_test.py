#!/usr/bin/env python3
"""A pose in an arm's frame and a wrench in the jaw's own turned frame drive the running node: E comes out, and the force is among
what is compared."""
import os
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np
import rosbag
import roslib.packages
import rospkg
import rospy
import rostest
import yaml
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from tissue_stiffness.msg import Misfit, StiffnessEstimate

PACKAGE = rospkg.RosPack().get_path('tissue_stiffness')
MODEL = os.path.join(PACKAGE, 'test', 'nodes', 'moved_model.yaml')
TRUTH = 11e3  # Pa
ARM_TURN = np.array([1.0, 2.0, -3.0, 4.0]) / np.sqrt(30.0)  # quaternion x, y, z, w: model_from_arm
ARM_PLACE = np.array([0.4, -0.3, 0.2])


def product(a, b):
    """Of two quaternions."""
    return np.append(a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3]), a[3] * b[3] - a[:3] @ b[:3])


def turned_back(v):
    """A vector of the model in the arm's frame."""
    back = ARM_TURN * [-1, -1, -1, 1]
    return product(product(back, np.append(v, 0.0)), ARM_TURN)[:3]


def write_scene(file):
    with open(MODEL) as stream:
        scene = yaml.safe_load(stream)
    scene['mesh'] = {'file': os.path.join(PACKAGE, 'config', 'demo', 'mesh.vtk')}
    scene['effects'][1]['elasticity']['young_modulus'] = TRUTH
    scene['simulation'] = {
        'duration': 2, 'rate': 30, 'step': 0.002, 'sensors': {'/tissue/vertices': {'every': 5}},
        'loads': {'/jaw/pose': {'rate': 100, 'position': [0.0, 0.0, 0.05], 'terms': [
            {'direction': [0.3, 0, 0.9], 'raised_cosine': {'amplitude': 0.004, 'frequency': 1}},
            {'axis': [0, 1, 0], 'raised_cosine': {'amplitude': 0.05, 'frequency': 1}}]}}}
    with open(file, 'w') as stream:
        yaml.safe_dump(scene, stream)


def turned(file, out):
    """The recording with the pose and the wrench in the arm's frame."""
    with rosbag.Bag(file) as bag, rosbag.Bag(out, 'w') as turned_bag:
        fixed = TransformStamped()
        fixed.header.frame_id, fixed.child_frame_id = 'model', 'arm'
        t, r = fixed.transform.translation, fixed.transform.rotation
        t.x, t.y, t.z = ARM_PLACE
        r.x, r.y, r.z, r.w = ARM_TURN
        first = True
        for topic, message, stamp in bag.read_messages():
            if first:
                turned_bag.write('/tf_static', TFMessage([fixed]), stamp)
                first = False
            if topic == '/jaw/pose':
                message.header.frame_id = 'arm'
                p, q = message.pose.position, message.pose.orientation
                p.x, p.y, p.z = turned_back(np.array([p.x, p.y, p.z]) - ARM_PLACE)
                q.x, q.y, q.z, q.w = product(ARM_TURN * [-1, -1, -1, 1], np.array([q.x, q.y, q.z, q.w]))
            elif topic == '/jaw/wrench':
                message.header.frame_id = 'arm'
                f = message.wrench.force
                f.x, f.y, f.z = turned_back(np.array([f.x, f.y, f.z]))
            turned_bag.write(topic, message, stamp)


class MovedTest(unittest.TestCase):
    def test_e_comes_out_of_a_pose_and_a_force(self):
        estimates, rows, changed = [], [], threading.Condition()

        def on_estimate(message):
            with changed:
                estimates.append(message)
                changed.notify_all()
        rospy.Subscriber('stiffness', StiffnessEstimate, on_estimate, queue_size=1000)
        rospy.Subscriber('misfit', Misfit, lambda message: rows.append(message.count), queue_size=1000)
        with tempfile.TemporaryDirectory() as folder:
            scene, plain, arm = (os.path.join(folder, name) for name in ('scene.yaml', 'plain.bag', 'arm.bag'))
            write_scene(scene)
            simulate = roslib.packages.find_node('tissue_stiffness', 'simulate')[0]
            subprocess.run([simulate, scene, '--allow-outside', '--output', plain], check=True, stdout=subprocess.DEVNULL)
            turned(plain, arm)
            player = roslib.packages.find_node('rosbag', 'play')[0]
            subprocess.run([player, '--clock', '--wait-for-subscribers', '--quiet', '--rate=0.5', arm], timeout=80,
                           check=True, stdout=subprocess.DEVNULL)
        with changed:
            changed.wait_for(lambda: len(estimates) >= 58, 15)
        last = estimates[-1]
        print('%d frames, E = %.2f kPa (%.2f to %.2f), %s' % (len(estimates), last.young_modulus / 1e3, last.lower95[0] / 1e3,
                                                             last.upper95[0] / 1e3, last.state_reason))
        self.assertGreaterEqual(len(estimates), 55)
        self.assertAlmostEqual(last.young_modulus / TRUTH, 1.0, delta=0.03)
        self.assertEqual(rows[-1] % 3, 0)


if __name__ == '__main__':
    rospy.init_node('moved_test', disable_rostime=True)
    rostest.rosrun('tissue_stiffness', 'moved', MovedTest, sys.argv)
