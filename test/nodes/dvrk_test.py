#!/usr/bin/env python3
"""dvrk.launch: a wrench in a turning tool's frame, with the other sign and without a frame, gives the estimate that the force in
the model frame gives."""
import os
import subprocess
import sys
import tempfile
import threading
import unittest

import roslib.packages
import rospkg
import rospy
import rostest
from arm_recording import write_recording

from tissue_stiffness.msg import StiffnessEstimate

DEMO = os.path.join(rospkg.RosPack().get_path('tissue_stiffness'), 'config', 'demo', 'recording.bag')


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
            write_recording(DEMO, file)
            player = roslib.packages.find_node('rosbag', 'play')[0]
            subprocess.run([player, '--clock', '--wait-for-subscribers', '--quiet', '--rate=0.5', file], timeout=60, check=True,
                           stdout=subprocess.DEVNULL)
        with changed:
            changed.wait_for(lambda: len(estimates) >= 90, 15)
        print('%d frames, E = %.2f kPa' % (len(estimates), estimates[-1] / 1e3))
        self.assertGreaterEqual(len(estimates), 85)
        self.assertAlmostEqual(estimates[-1] / 12e3, 1.0, delta=0.04)  # the truth


if __name__ == '__main__':
    rospy.init_node('dvrk_test', disable_rostime=True)
    rostest.rosrun('tissue_stiffness', 'dvrk', DvrkTest, sys.argv)
