#!/usr/bin/env python3
"""estimator_node configured by parameters instead of a file, with remapped topics."""
import sys
import threading
import unittest

import rospy
import rostest

from tissue_stiffness.msg import StiffnessEstimate


class ParametersTest(unittest.TestCase):
    def test_the_estimate_is_the_same(self):
        estimates, done = [], threading.Event()

        def on_estimate(message):
            estimates.append(message)
            if len(estimates) == 72:
                done.set()
        rospy.Subscriber('/remapped/stiffness', StiffnessEstimate, on_estimate, queue_size=1000)
        self.assertTrue(done.wait(45), '%d estimates' % len(estimates))
        self.assertAlmostEqual(estimates[-1].young_modulus / 550e3, 1.0, delta=0.015)


if __name__ == '__main__':
    rospy.init_node('parameters_test')
    rostest.rosrun('tissue_stiffness', 'parameters', ParametersTest, sys.argv)
