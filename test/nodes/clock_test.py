#!/usr/bin/env python3
"""The sensors' clock is set while the body moves: the estimator goes on with what it knew, from motion."""
import os
import subprocess
import sys
import tempfile
import unittest

import roslib.packages
import rosbag
import rospy
import rostest

from estimator_status import EstimatorStatus
from fault_runs import TRUTH, excludes_truth, write_recording
from tissue_stiffness.msg import StiffnessEstimate

DURATION = 30.0  # s, of the recording
SET = 15.0       # s, after which the clock is set
JUMP = -4000.0   # s


def set_clock(source, target):
    with rosbag.Bag(source) as bag, rosbag.Bag(target, 'w') as out:
        begin = bag.get_start_time()
        for topic, message, time in bag.read_messages():
            if topic != '/tf_static' and time.to_sec() - begin > SET:
                message.header.stamp += rospy.Duration(JUMP)
            out.write(topic, message, time)


class ClockTest(EstimatorStatus, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.estimates = []
        cls.subscribers = [cls.watch_status(), rospy.Subscriber('stiffness', StiffnessEstimate, cls.keep, queue_size=10000)]
        with tempfile.TemporaryDirectory() as folder:
            steady, jumping = (os.path.join(folder, name) for name in ('steady.bag', 'jumping.bag'))
            write_recording(DURATION, steady)
            set_clock(steady, jumping)
            player = roslib.packages.find_node('rosbag', 'play')[0]
            subprocess.run([player, '--wait-for-subscribers', '--quiet', jumping], check=True, stdout=subprocess.DEVNULL, timeout=120)
        cls.wait_for_waiting_frames(100)

    @classmethod
    def keep(cls, message):
        with cls.changed:
            if message.names and message.state != 'stale':
                cls.estimates.append(message)
            cls.changed.notify_all()

    def test_a_clock_that_is_set_keeps_the_modulus(self):
        first = self.estimates[0].header.stamp
        before = [estimate for estimate in self.estimates if estimate.header.stamp >= first]
        after = [estimate for estimate in self.estimates if estimate.header.stamp < first]
        self.assertEqual(self.values.get('restarts'), '1', self.values)
        self.assertEqual(before[-1].state, 'converged', before[-1].state_reason)
        self.assertGreater(len(after), 100)
        used = [estimate for estimate in after if estimate.state != 'no_data']
        width = (used[0].young_modulus_upper95 - used[0].young_modulus_lower95) / TRUTH
        known = (before[-1].young_modulus_upper95 - before[-1].young_modulus_lower95) / TRUTH
        print('95 %% interval before: %.2f %%, after the first frame: %.2f %%' % (100 * known, 100 * width))
        self.assertLess(width, 1.5 * known + 0.01)
        for estimate in self.estimates:
            if estimate.state == 'converged':
                self.assertFalse(excludes_truth(estimate), estimate)
        late = [estimate for estimate in used if (estimate.header.stamp - used[0].header.stamp).to_sec() > 5.0]
        self.assertGreater(len(late), 100)
        for estimate in late:
            self.assertEqual(estimate.state, 'converged', estimate.state_reason)


if __name__ == '__main__':
    rospy.init_node('clock_test', disable_rostime=True)
    rostest.rosrun('tissue_stiffness', 'clock', ClockTest, sys.argv)
