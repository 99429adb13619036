#!/usr/bin/env python3
"""A frame whose sensor has no pose yet waits for it: it is used as soon as the pose comes, and an ending node does not wait."""
import signal
import sys
import threading
import unittest

import rosbag
import rospy
import rostest
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import PointCloud2
from tf2_msgs.msg import TFMessage

from disturbed_test import DisturbedTest
from estimator_status import OwnEstimator
from tissue_stiffness.msg import StiffnessEstimate

TOPIC, FRAMES = '/tissue/vertices', 10
TIMEOUT = 60  # s, that a frame waits


class PosesTest(OwnEstimator, unittest.TestCase):
    patience = 0.5 * TIMEOUT

    @classmethod
    def setUpClass(cls):
        with rosbag.Bag(rospy.get_param('~bag')) as bag:
            cls.frames = [DisturbedTest.plain(message) for _, message, _ in bag.read_messages(TOPIC)][:FRAMES + 1]
        cls.used = []
        cls.subscribers = [cls.watch_status(), rospy.Subscriber('stiffness', StiffnessEstimate, cls.on_estimate, queue_size=100)]
        cls.publisher = rospy.Publisher(TOPIC, PointCloud2, queue_size=100)
        cls.poses = rospy.Publisher('/tf', TFMessage, queue_size=10)
        cls.run_node('_transform_timeout:=%d' % TIMEOUT, '_diagnosis_period:=0')
        while not (cls.publisher.get_num_connections() and cls.poses.get_num_connections() >= 2):  # mesh_node is the other
            threading.Event().wait(0.05)

    @classmethod
    def on_estimate(cls, message):
        with cls.changed:
            cls.used.append(message.header.stamp)
            cls.changed.notify_all()

    def publish(self, frame, frame_id):
        frame.header.frame_id = frame_id
        self.publisher.publish(frame)

    def test_1_a_pose_that_comes_late_is_waited_for(self):
        for frame in self.frames[:FRAMES]:
            self.publish(frame, 'probe')
        self.wait_for(lambda: self.values.get('frames waiting', '0') != '0', 'the frames do not wait')
        self.assertEqual(self.used, [])
        for shift in (-1.0, 1.0):
            pose = TransformStamped()
            pose.header.stamp = self.frames[FRAMES // 2].header.stamp + rospy.Duration(shift)
            pose.header.frame_id, pose.child_frame_id = 'model', 'probe'
            pose.transform.rotation.w = 1.0
            self.poses.publish(TFMessage([pose]))
        self.wait_for(lambda: self.values.get('frames used') == str(FRAMES), 'the frames are not used')
        self.assertEqual(self.used[-1], self.frames[FRAMES - 1].header.stamp)
        self.assertNotIn('bad messages', self.values)

    def test_2_a_node_that_ends_does_not_wait(self):
        self.wait_for(lambda: self.values.get('frames waiting') == '0', 'frames still wait')
        self.publish(self.frames[FRAMES], 'nowhere')
        self.wait_for(lambda: self.values.get('frames waiting') == '1', 'the frame does not wait')
        self.node.send_signal(signal.SIGINT)
        self.assertEqual(self.node.wait(self.patience), 0)


if __name__ == '__main__':
    rospy.init_node('poses_test')
    rostest.rosrun('tissue_stiffness', 'poses', PosesTest, sys.argv)
