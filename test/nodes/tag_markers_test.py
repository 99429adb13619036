#!/usr/bin/env python3
"""tag_markers: detections become a cloud with the rows of `rest`, and the first ones tell where the markers are at rest. The
type of the detections is made from its definition, because no package of the test has it."""
import math
import subprocess
import sys
import threading
import unittest

import roslib.packages
import rospy
import rostest
import sensor_msgs.point_cloud2
from genpy.dynamic import generate_dynamic
from geometry_msgs.msg import PoseWithCovarianceStamped, TransformStamped
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

ARRAY, DETECTION = 'apriltag_ros/AprilTagDetectionArray', 'apriltag_ros/AprilTagDetection'
LINE = '=' * 80 + '\nMSG: '


def definition():
    parts = PoseWithCovarianceStamped._full_text
    own, rest = parts.split(LINE, 1)
    return ('Header header\napriltag_ros/AprilTagDetection[] detections\n' + LINE + DETECTION +
            '\nint32[] id\nfloat64[] size\ngeometry_msgs/PoseWithCovarianceStamped pose\n' + LINE +
            'geometry_msgs/PoseWithCovarianceStamped\n' + own + LINE + rest)


KINDS = generate_dynamic(ARRAY, definition())


def detection(ids, x, y, z):
    out = KINDS[DETECTION](id=ids, size=[0.02] * len(ids))
    out.pose.header.frame_id = 'camera'
    position = out.pose.pose.pose.position
    position.x, position.y, position.z = x, y, z
    return out


class TagMarkersTest(unittest.TestCase):
    def setUp(self):
        self.changed, self.clouds, self.errors = threading.Condition(), [], []
        rospy.Subscriber('markers', PointCloud2, self.keep(self.clouds), queue_size=100)
        rospy.Subscriber('/rosout', Log, self.keep(self.errors), queue_size=100)

    def keep(self, kept):
        def on_message(message):
            with self.changed:
                kept.append(message)
                self.changed.notify_all()
        return on_message

    def wait_for(self, condition):
        with self.changed:
            self.assertTrue(self.changed.wait_for(condition, 20))

    @staticmethod
    def publisher(topic, kind, listeners, **options):
        out = rospy.Publisher(topic, kind, queue_size=100, **options)
        while out.get_num_connections() < listeners and not rospy.is_shutdown():
            rospy.sleep(0.01)
        return out

    def test_detections_become_markers_and_their_rest_is_learnt(self):
        # The camera looks along the model's -y from 0.5 m, with its x axis along the model's.
        pose = TransformStamped(child_frame_id='camera')
        pose.header.frame_id = 'model'
        pose.transform.translation.y = 0.5
        pose.transform.rotation.x = pose.transform.rotation.w = math.sqrt(0.5)
        self.publisher('/tf_static', TFMessage, 1, latch=True).publish(TFMessage([pose]))
        detections = self.publisher('tag_detections', KINDS[ARRAY], 1)
        stamps = [rospy.Time.from_sec(10.0 + 0.1 * k) for k in range(7)]
        for k, stamp in enumerate(stamps):
            array = KINDS[ARRAY]()
            array.header.stamp = stamp
            array.header.frame_id = 'camera'
            shift = [0.002, -0.001, 0.0, 0.001, -0.001, 0.08, 0.08][k]  # it moves after the rest
            array.detections = [detection([3], 0.01, 0.02, 0.4 + shift), detection([7], -0.03, 0.0, 0.45),
                                detection([5], 0.0, 0.0, 0.4), detection([1, 2], 0.0, 0.0, 0.4)]
            if k == 6:
                array.detections.append(detection([7], 0.1, 0.1, 0.4))  # two tags of one number
            detections.publish(array)
        self.wait_for(lambda: len(self.clouds) == len(stamps))
        for cloud, stamp in zip(self.clouds, stamps):
            self.assertEqual((cloud.header.frame_id, cloud.header.stamp), ('camera', stamp))
        points = {p[3]: p[:3] for p in sensor_msgs.point_cloud2.read_points(self.clouds[0], ('x', 'y', 'z', 'marker'))}
        self.assertEqual(sorted(points), [0, 1])
        for found, expected in zip(points[0] + points[1], (-0.03, 0.0, 0.45, 0.01, 0.02, 0.402)):
            self.assertAlmostEqual(found, expected, places=6)
        last = list(sensor_msgs.point_cloud2.read_points(self.clouds[-1], ('marker',)))
        self.assertEqual(last, [(1,)], 'nobody knows which of two equal tags is on the body')

        while not rospy.has_param('/tag_markers/rest'):
            rospy.sleep(0.05)
        rest = rospy.get_param('/tag_markers/rest')
        for found, expected in zip(rest[0] + rest[1], (-0.03, 0.05, 0.0, 0.01, 0.1, 0.02)):
            self.assertAlmostEqual(found, expected, places=9)

    def test_another_type_is_named(self):
        detections = self.publisher('wrong_detections', String, 1)
        detections.publish(String('tags'))
        expected = '/wrong_detections: found std_msgs/String; allowed: ' + ARRAY
        self.wait_for(lambda: any(error.msg.endswith(expected) for error in self.errors))

    def test_wrong_parameters_are_named(self):
        program = roslib.packages.find_node('tissue_stiffness', 'tag_markers')[0]
        for argument, words in (('_tags:=[1, 1]', 'tags: found [1, 1]; allowed: a list of different whole numbers'),
                                ('_rest_frames:=-1', 'rest_frames: found -1; allowed: a whole number from 0')):
            more = [] if 'tags' in argument else ['_tags:=[1]']
            run = subprocess.run([program, '__name:=wrong', argument] + more, capture_output=True, text=True, timeout=30,
                                 check=False)
            self.assertEqual(run.returncode, 1)
            self.assertIn('/wrong/' + words, run.stderr)


if __name__ == '__main__':
    rospy.init_node('tag_markers_test', disable_rostime=True)
    rostest.rosrun('tissue_stiffness', 'tag_markers', TagMarkersTest, sys.argv)
