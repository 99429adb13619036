#!/usr/bin/env python3
"""dvrk.launch: a wrench in a turning tool's frame, with the other sign and without a frame, gives the estimate that the force in
the model frame gives."""
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
from geometry_msgs.msg import PoseStamped, WrenchStamped

from tissue_stiffness.msg import StiffnessEstimate

DEMO = os.path.join(rospkg.RosPack().get_path('tissue_stiffness'), 'config', 'demo')
BASE_YAW, BASE_PITCH, BASE_ROLL = 0.5, 0.2, -0.3  # as in dvrk.test


def turn(axis, angle):
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    out = np.eye(3)
    out[i, i] = out[j, j] = c
    out[i, j], out[j, i] = -s, s
    return out


MODEL_FROM_BASE = turn(2, BASE_YAW) @ turn(1, BASE_PITCH) @ turn(0, BASE_ROLL)


def as_an_arm(force, header, angle):
    """Pose of a tool turned by `angle` about its base's x, and the wrench that the tissue does to it, in its own frame."""
    pose, wrench = PoseStamped(), WrenchStamped()
    pose.header.stamp = wrench.header.stamp = header.stamp
    pose.pose.orientation.x, pose.pose.orientation.w = np.sin(angle / 2), np.cos(angle / 2)
    felt = -(MODEL_FROM_BASE @ turn(0, angle)).T @ np.array([force.x, force.y, force.z])
    wrench.wrench.force.x, wrench.wrench.force.y, wrench.wrench.force.z = felt
    return pose, wrench


def write_recording(file):
    with rosbag.Bag(os.path.join(DEMO, 'recording.bag')) as demo, rosbag.Bag(file, 'w') as out:
        start = None
        for topic, message, stamp in demo.read_messages():
            start = start or stamp
            if topic == '/tissue/vertices':
                out.write('/tracker/points', message, stamp)
            elif topic == '/tool/wrench':
                pose, wrench = as_an_arm(message.wrench.force, message.header, 0.8 * (stamp - start).to_sec())
                out.write('/PSM1/measured_cp', pose, stamp)
                out.write('/PSM1/body/measured_cf', wrench, stamp)


class DvrkTest(unittest.TestCase):
    def test_the_estimate_is_that_of_the_force_in_the_model_frame(self):
        estimates, changed = [], threading.Condition()

        def on_estimate(message):
            with changed:
                estimates.append(message.young_modulus)
                changed.notify_all()
        rospy.Subscriber('stiffness', StiffnessEstimate, on_estimate, queue_size=1000)
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, 'arm.bag')
            write_recording(file)
            player = roslib.packages.find_node('rosbag', 'play')[0]
            subprocess.run([player, '--clock', '--wait-for-subscribers', '--quiet', '--rate=0.5', file], timeout=60, check=True,
                           stdout=subprocess.DEVNULL)
        with changed:
            changed.wait_for(lambda: len(estimates) >= 90, 15)
        print('%d frames, E = %.2f kPa' % (len(estimates), estimates[-1] / 1e3))
        self.assertGreaterEqual(len(estimates), 85)
        self.assertAlmostEqual(estimates[-1] / 19.1e3, 1.0, delta=0.04)  # as demo.launch finds without viscoelasticity


if __name__ == '__main__':
    rospy.init_node('dvrk_test', disable_rostime=True)
    rostest.rosrun('tissue_stiffness', 'dvrk', DvrkTest, sys.argv)
