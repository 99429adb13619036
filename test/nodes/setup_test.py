#!/usr/bin/env python3
"""estimator_node names the topic that nobody publishes, with the similar one that somebody does, and goes on."""
import sys
import threading
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from sensor_msgs.msg import PointCloud2

from tissue_stiffness.srv import ListEffects


class SetupTest(unittest.TestCase):
    def test_a_topic_that_nobody_publishes(self):
        rospy.Publisher('/tissue/vertexes', PointCloud2, queue_size=1)
        heard, told = threading.Event(), []

        def on_diagnostics(message):  # of every node
            for status in message.status:
                if status.name.endswith('estimator') and '/tissue/vertexes' in status.message:
                    told.append(status)
                    heard.set()
        rospy.Subscriber('/diagnostics', DiagnosticArray, on_diagnostics)
        self.assertTrue(heard.wait(60), 'the topic is not named')
        self.assertIn('no node publishes the topic /tissue/vertices (did you mean `/tissue/vertexes`?)', told[0].message)
        self.assertEqual(told[0].level, DiagnosticStatus.WARN)
        rospy.wait_for_service('list_effects', 10)
        self.assertTrue(rospy.ServiceProxy('list_effects', ListEffects)().running)


if __name__ == '__main__':
    rospy.init_node('setup_test')
    rostest.rosrun('tissue_stiffness', 'setup', SetupTest, sys.argv)
