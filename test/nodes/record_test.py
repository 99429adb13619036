#!/usr/bin/env python3
"""What the estimator publishes can be recorded, read and replayed like any sensor: stamps in order, one frame, finite numbers."""
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import rosbag
import roslib.packages
import rospy
import rostest
import rostopic
from std_srvs.srv import SetBool

TOPICS = ['/stiffness', '/misfit', '/tracked_surface', '/tracked_points', '/measured_points']


def wait_until(condition, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end and not condition():
        time.sleep(0.1)
    return condition()


class RecordTest(unittest.TestCase):
    def record(self, file):
        recorder = subprocess.Popen([roslib.packages.find_node('rosbag', 'record')[0], '--quiet', '-O', file] + TOPICS)
        heard, last = {}, [time.monotonic()]

        def hear(message, topic):
            heard[topic] = heard.get(topic, 0) + 1
            last[0] = time.monotonic()
        for topic in TOPICS:
            rospy.Subscriber(topic, rospy.AnyMsg, hear, topic, queue_size=1000)
        time.sleep(3)  # until the recorder listens
        rospy.wait_for_service('/player/pause_playback', 30)
        rospy.ServiceProxy('/player/pause_playback', SetBool)(False)
        self.assertTrue(wait_until(lambda: heard.get('/misfit', 0) >= 85 and time.monotonic() - last[0] > 2, 60), heard)
        recorder.send_signal(signal.SIGINT)
        recorder.wait(20)

    def test_a_recording_of_the_outputs_replays(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, 'outputs.bag')
            self.record(file)
            counts = {}
            with rosbag.Bag(file) as bag:
                previous = {}
                for topic, message, stamp in bag.read_messages():
                    counts[topic] = counts.get(topic, 0) + 1
                    self.assertEqual(message.header.frame_id, 'model', topic)
                    self.assertGreaterEqual(message.header.stamp, previous.get(topic, message.header.stamp), topic)
                    self.assertLess(abs((stamp - message.header.stamp).to_sec()), 2.0, topic)
                    previous[topic] = message.header.stamp
            for topic in TOPICS:
                self.assertGreaterEqual(counts.get(topic, 0), 85, counts)
            self.replay(file, counts)

    def replay(self, file, counts):
        replayed, changed = {}, threading.Condition()

        def hear(message, topic):
            with changed:
                replayed[topic] = replayed.get(topic, 0) + 1
                changed.notify_all()
        for topic in TOPICS:
            rospy.Subscriber('/again' + topic, rostopic.get_topic_class(topic)[0], hear, topic, queue_size=1000)
        player = roslib.packages.find_node('rosbag', 'play')[0]
        subprocess.run([player, '--quiet', '--wait-for-subscribers', '--rate=2', '--prefix=/again', file], timeout=60, check=True,
                       stdout=subprocess.DEVNULL)
        with changed:
            changed.wait_for(lambda: replayed == counts, 10)
        self.assertEqual(replayed, counts)


if __name__ == '__main__':
    rospy.init_node('record_test', disable_rostime=True)
    rostest.rosrun('tissue_stiffness', 'record', RecordTest, sys.argv)
