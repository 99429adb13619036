#!/usr/bin/env python3
"""/diagnostics of a running node: its content, and that no simulated clock silences it."""
import subprocess
import sys
import threading
import unittest

import roslib.packages
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import PointCloud2

LAST = 2**32 - 1  # s: the end of what ros::Time can hold
PATIENCE = 30     # s


class DiagnosticsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.changed, cls.messages = threading.Condition(), []
        cls.clock = rospy.Publisher('/clock', Clock, queue_size=1, latch=True)
        cls.points = rospy.Publisher('/sensors/points', PointCloud2, queue_size=10)
        cls.subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, cls.on_diagnostics, queue_size=1000)

    @classmethod
    def on_diagnostics(cls, message):
        with cls.changed:
            cls.messages.append(message)
            cls.changed.notify_all()

    def wait_for(self, condition, text):
        with self.changed:
            self.assertTrue(self.changed.wait_for(condition, PATIENCE), '%s; the last messages: %s' % (text, self.messages[-3:]))

    def values(self):
        return {entry.key: entry.value for status in self.messages[-1:] for entry in status.status[0].values}

    def expect_three_at(self, seconds):
        before = len(self.messages)
        self.wait_for(lambda: sum(message.header.stamp.to_sec() == seconds for message in self.messages[before:]) >= 3,
                      'too few messages at %g s' % seconds)

    def test_1_before_there_is_a_clock(self):
        self.expect_three_at(0)
        status = self.messages[-1].status[0]
        self.assertEqual(status.name, '/fault_injector: faults')
        self.assertEqual(status.hardware_id, 'none')
        self.assertEqual(status.level, DiagnosticStatus.OK)
        self.assertEqual(status.message, 'relaying')

    def test_2_counts_and_texts(self):
        while not self.points.get_num_connections():
            threading.Event().wait(0.05)
        self.points.publish(PointCloud2())
        self.wait_for(lambda: self.values().get('messages of /points') == '1', 'the relayed message is not counted')
        self.assertNotIn('last bad message', self.values())

    def test_3_a_clock_that_stands_still_or_jumps_back(self):
        for seconds in (100, 10):
            self.clock.publish(rospy.Time(seconds))
            self.expect_three_at(seconds)

    def test_4_a_clock_at_the_end_of_time_ends_no_node(self):
        self.clock.publish(rospy.Time(LAST))
        self.clock.publish(rospy.Time(20))
        self.expect_three_at(20)

    def test_5_a_period_that_is_changed_later_is_not_read(self):
        self.clock.publish(rospy.Time(0, 1))
        for period in (-1.0, float('inf')):
            rospy.set_param('/fault_injector/diagnostic_period', period)
            self.expect_three_at(1e-9)

    def test_6_a_wrong_period_is_refused(self):
        program = roslib.packages.find_node('tissue_stiffness', 'fault_injector')[0]
        done = subprocess.run([program, '__name:=wrong', '_topics:=[{input: /a, output: /b}]', '_diagnostic_period:=0.01'],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=PATIENCE, universal_newlines=True)
        self.assertEqual(done.returncode, 2, done.stdout)
        for part in ('diagnostic_period', '0.01', '0.1 to 60'):
            self.assertIn(part, done.stdout)


if __name__ == '__main__':
    rospy.init_node('diagnostics_test', disable_rostime=True)
    rostest.rosrun('tissue_stiffness', 'diagnostics', DiagnosticsTest, sys.argv)
