#!/usr/bin/env python3
"""estimator_node configured by parameters instead of a file, with remapped topics."""
import sys
import threading
import unittest

import rospy
import rostest

from tissue_stiffness.msg import StiffnessEstimate

FRAMES, TRUTH = 72, 550e3  # of the recording; the modulus [Pa]


class ParametersTest(unittest.TestCase):
    def test_the_estimate_is_the_same(self):
        estimates, done = [], threading.Event()

        def on_estimate(message):  # the background may reprocess the frames after the last one has come
            estimates.append(message.young_modulus)
            if len(estimates) >= FRAMES and abs(estimates[-1] / TRUTH - 1.0) < 0.015:
                done.set()
        rospy.Subscriber('/remapped/stiffness', StiffnessEstimate, on_estimate, queue_size=1000)
        self.assertTrue(done.wait(150), '%d estimates, the last ones %s Pa' % (len(estimates), estimates[-3:]))


if __name__ == '__main__':
    rospy.init_node('parameters_test')
    rostest.rosrun('tissue_stiffness', 'parameters', ParametersTest, sys.argv)
