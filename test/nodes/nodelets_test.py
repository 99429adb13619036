#!/usr/bin/env python3
"""Images through the nodelets give what they give through the nodes, and what the nodelets hand on is one process's."""
import math
import os
import subprocess
import sys
import tempfile
import threading
import unittest

import roslib.packages
import rosbag
import rosgraph
import rospkg
import rospy
import rostest

from estimator_status import EstimatorStatus
from tissue_stiffness.msg import StiffnessEstimate

PACKAGE = rospkg.RosPack().get_path('tissue_stiffness')
SCENES = os.path.join(PACKAGE, 'test', 'report', 'browser')
MODEL, SCENE = os.path.join(SCENES, 'camera_model.yaml'), os.path.join(SCENES, 'camera_scene.yaml')
FRAMES = 18  # of the 0.5 s at 40 Hz
MANAGER = '/tissue_stiffness_manager'


class Replay(EstimatorStatus):
    """A recording replayed into nodes or nodelets: the estimates, and who subscribed to the images."""

    def __init__(self, bag, nodelets):
        self.estimates, self.listeners = [], set()
        with rosbag.Bag(bag) as recording:
            self.last_stamp = max(message.header.stamp for _, message, _ in recording.read_messages('/camera/image_raw'))
        self.all_came = threading.Event()
        status = self.watch_status()
        subscriber = rospy.Subscriber('/stiffness', StiffnessEstimate, self.on_estimate, queue_size=100)
        launch = subprocess.Popen(
            ['roslaunch', 'tissue_stiffness', 'replay.launch', 'model:=' + MODEL, 'allow_outside:=true', 'bag:=' + bag, 'rate:=0.5',
             'diagnosis_period:=0', 'nodelets:=' + ('true' if nodelets else 'false')],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        try:
            if self.all_came.wait(90):
                self.wait_for_reprocessing(60)  # a busy machine reprocesses the recording later than it sees the last frame
        finally:
            launch.terminate()
            self.output = launch.communicate(timeout=30)[0]
            subscriber.unregister()
            status.unregister()

    def on_estimate(self, message):
        if not self.estimates:
            _, subscribers, _ = rosgraph.Master('/nodelets_test').getSystemState()
            for topic, nodes in subscribers:
                if topic in ('/camera/image_raw', '/contour'):
                    self.listeners.update(nodes)
        self.estimates.append(message)
        if message.header.stamp == self.last_stamp:
            self.all_came.set()


class NodeletsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        bag = os.path.join(cls.folder.name, 'camera.bag')
        simulate = roslib.packages.find_node('tissue_stiffness', 'simulate')[0]
        subprocess.run([simulate, SCENE, '--allow-outside', '--output', bag], check=True, timeout=120, stdout=subprocess.PIPE)
        cls.nodes, cls.nodelets = Replay(bag, False), Replay(bag, True)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_the_estimates_are_the_same(self):
        self.assertGreaterEqual(len(self.nodelets.estimates), FRAMES, self.nodelets.output)
        stamps = [{e.header.stamp for e in replay.estimates} for replay in (self.nodes, self.nodelets)]
        self.assertGreaterEqual(len(stamps[0] & stamps[1]), FRAMES - 1)
        # Which frame is the first after a reprocessing is a matter of timing, and changes the estimate a little.
        one, other = (replay.estimates[-1] for replay in (self.nodes, self.nodelets))
        self.assertAlmostEqual(one.mean[0] / other.mean[0], 1.0, delta=0.005)
        self.assertAlmostEqual(math.log(one.covariance[0] / other.covariance[0]), 0.0, delta=math.log(1.1))
        for replay in (self.nodes, self.nodelets):
            live = [estimate for estimate in replay.estimates if estimate.state != 'stale'][-1]
            self.assertIn(live.state, ('converging', 'converged'), live.state_reason)

    def test_the_nodelets_are_one_process(self):
        self.assertEqual(self.nodelets.listeners, {MANAGER})
        self.assertEqual(self.nodes.listeners, {'/segmentation_node', '/estimator_node'})


if __name__ == '__main__':
    rospy.init_node('nodelets_test', disable_rostime=True)
    rostest.rosrun('tissue_stiffness', 'nodelets', NodeletsTest, sys.argv)
