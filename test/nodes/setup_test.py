#!/usr/bin/env python3
"""estimator_node names the topic that nobody publishes, with the similar one that somebody does, and goes on."""
import sys
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from sensor_msgs.msg import PointCloud2

from tissue_stiffness.srv import ListEffects


class SetupTest(unittest.TestCase):
    def test_a_topic_that_nobody_publishes(self):
        rospy.Publisher('/tissue/vertexes', PointCloud2, queue_size=1)
        end = rospy.Time.now() + rospy.Duration(40)
        message, level = '', DiagnosticStatus.OK
        while '/tissue/vertexes' not in message and rospy.Time.now() < end:
            for status in rospy.wait_for_message('/diagnostics', DiagnosticArray, 20).status:
                if status.name.endswith('estimator'):
                    message, level = status.message, status.level
        self.assertIn('no node publishes the topic /tissue/vertices (did you mean `/tissue/vertexes`?)', message)
        self.assertEqual(level, DiagnosticStatus.WARN)
        rospy.wait_for_service('list_effects', 10)
        self.assertTrue(rospy.ServiceProxy('list_effects', ListEffects)().running)


if __name__ == '__main__':
    rospy.init_node('setup_test')
    rostest.rosrun('tissue_stiffness', 'setup', SetupTest, sys.argv)
