#!/usr/bin/env python3
"""What a running estimator_node has to bear: malformed messages, late, missing and repeated frames, a recording that loops,
a reset."""
import copy
import sys
import threading
import unittest

import rosbag
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import Trigger

from estimator_status import EstimatorStatus
from tissue_stiffness.msg import StiffnessEstimate, TetMesh

TRUTH = 550e3  # Pa
TOPIC = '/tissue/vertices'


class DisturbedTest(EstimatorStatus, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with rosbag.Bag(rospy.get_param('~bag')) as bag:
            cls.frames = [message for _, message, _ in bag.read_messages(TOPIC, raw=False)]
        cls.frames = [cls.plain(frame) for frame in cls.frames]
        cls.estimates = []
        cls.subscribers = [cls.watch_status(),
                           rospy.Subscriber('stiffness', StiffnessEstimate, cls.on_estimate, queue_size=1000)]
        cls.publisher = rospy.Publisher(TOPIC, PointCloud2, queue_size=1000)
        while not cls.publisher.get_num_connections():
            threading.Event().wait(0.05)

    @staticmethod
    def plain(message):
        """rosbag makes a class of its own for the messages that it reads."""
        return PointCloud2(message.header, message.height, message.width, message.fields, message.is_bigendian,
                           message.point_step, message.row_step, message.data, message.is_dense)

    @classmethod
    def on_estimate(cls, message):
        with cls.changed:
            cls.estimates.append(message)
            cls.changed.notify_all()

    def play(self, frames):
        """Publishes in pieces that fit into the node's queue; gives the last estimate."""
        before, stamp = len(self.estimates), frames[-1].header.stamp
        for frame in frames:
            self.publisher.publish(frame)
            threading.Event().wait(0.02)

        def ended():  # an earlier run may have ended with the same stamp
            new = self.estimates[before:]
            return (new and new[-1].header.stamp == stamp and
                    (len(frames) == 1 or any(estimate.header.stamp < stamp for estimate in new)))
        with self.changed:
            self.assertTrue(self.changed.wait_for(ended, 60), 'no estimate for the frame at %s' % stamp)
            heard = self.heard

            def settled():  # the second message is certainly of the end
                return (self.heard >= heard + 2 and self.values.get('reprocessing') == 'no' and
                        self.values.get('frames waiting') == '0')
            self.assertTrue(self.changed.wait_for(settled, 60), 'the reprocessing does not end')
            return self.estimates[-1]

    def count(self, key):
        return int(self.values.get(key, '0'))

    def wait_for(self, condition, text):
        with self.changed:
            self.assertTrue(self.changed.wait_for(condition, 15), '%s; diagnostics are %s' % (text, self.values))

    def malformed(self):
        def spoilt(**changes):
            message = copy.deepcopy(self.frames[12])
            for key, value in changes.items():
                setattr(message, key, value)
            return message
        nan = copy.deepcopy(self.frames[12])
        nan.data = b'\x00\x00\xc0\x7f' + nan.data[4:]
        beyond = copy.deepcopy(self.frames[12])
        beyond.data = beyond.data[:12] + b'\xff\xff\xff\x7f' + beyond.data[16:]
        foreign = copy.deepcopy(self.frames[12])
        foreign.header.frame_id = 'mars'
        timeless = copy.deepcopy(self.frames[12])
        timeless.header.stamp = rospy.Time()
        return [spoilt(fields=[]), spoilt(data=b''), spoilt(is_bigendian=True), spoilt(point_step=1), nan, beyond, foreign,
                timeless]

    def test_1_malformed_late_missing_and_repeated_frames(self):
        bad = self.malformed()
        first = self.play(self.frames[:10])
        stream = self.frames[10:12] + bad + self.frames[14:30] + [self.frames[20], self.frames[29]] + self.frames[33:]
        last = self.play(stream)
        self.assertGreater(first.young_modulus_std, last.young_modulus_std)
        self.assertAlmostEqual(last.young_modulus / TRUTH, 1.0, delta=0.02)
        self.wait_for(lambda: self.count('bad messages') == len(bad), 'expected %d bad messages' % len(bad))
        self.wait_for(lambda: self.count('frames used') == 72 - 2 - 3, 'expected 67 frames used')
        self.wait_for(lambda: self.count('frames skipped') == 2, 'expected 2 frames skipped')
        self.assertNotIn('previous_estimate', self.values)

    def test_2_a_loop_starts_from_the_prior_and_keeps_the_old_estimate(self):
        before = self.estimates[-1]
        again = self.play(self.frames[:3])
        self.assertGreater(again.young_modulus_std, 3 * before.young_modulus_std)
        self.wait_for(lambda: 'previous_estimate' in self.values, 'expected the estimate of the run before')
        self.assertIn('elasticity.young_modulus', self.values['previous_estimate'])
        last = self.play(self.frames[3:])
        self.assertAlmostEqual(last.young_modulus / TRUTH, 1.0, delta=0.015)
        third = self.play(self.frames)
        # Which frames the last study of the inputs saw is a matter of timing.
        self.assertAlmostEqual(third.young_modulus / last.young_modulus, 1.0, delta=1e-4)
        self.wait_for(lambda: self.count('restarts') == 2, 'expected 2 restarts')

    def test_3_reset(self):
        before = self.play(self.frames)
        answer = rospy.ServiceProxy('reset', Trigger)()
        self.assertTrue(answer.success)
        # Another epoch, with no jump back: only the reset makes it a new run.
        shifted = copy.deepcopy(self.frames)
        for frame in shifted:
            frame.header.stamp += rospy.Duration(5)
        after = self.play(shifted)
        self.assertAlmostEqual(after.young_modulus / before.young_modulus, 1.0, delta=1e-4)

    def test_4_a_wrong_mesh_is_refused_and_the_one_before_kept(self):
        good = rospy.wait_for_message('mesh', TetMesh, 30)
        meshes = rospy.Publisher('mesh', TetMesh, queue_size=10)
        while not meshes.get_num_connections():
            threading.Event().wait(0.05)

        def moved(change):
            mesh = copy.deepcopy(good)
            for node in mesh.nodes:
                change(node)
            return mesh

        def flatten(node):
            node.z = 0.0

        def shift(node):
            node.x += 10.0

        def in_millimetres(node):
            node.x, node.y, node.z = 1e3 * node.x, 1e3 * node.y, 1e3 * node.z

        inverted = copy.deepcopy(good)
        tets = list(inverted.tets)
        tets[0], tets[1] = tets[1], tets[0]
        inverted.tets = tets
        wrong = ((TetMesh(nodes_per_tet=4, tets=[0, 1, 2, 3]), 'nodes'), (inverted, 'inverted'),
                 (moved(flatten), 'without volume'), (moved(shift), 'region'), (moved(in_millimetres), 'not positive definite'))
        first = self.play(self.frames)
        for mesh, reason in wrong:
            bad = self.count('bad messages')
            meshes.publish(mesh)
            self.wait_for(lambda: self.count('bad messages') == bad + 1, 'expected one more bad message')
            self.assertIn(reason, self.values['last bad message'])
        later = copy.deepcopy(self.frames[-1])
        later.header.stamp += rospy.Duration(0.02)
        last = self.play([later])
        self.assertAlmostEqual(last.young_modulus / first.young_modulus, 1.0, delta=0.01)
        self.assertLess(last.young_modulus_std, 1.2 * first.young_modulus_std)

    def test_5_frames_that_are_all_refused_leave_the_estimate_stale(self):
        self.play(self.frames)
        bad = copy.deepcopy(self.frames[-1])
        bad.fields = []

        def stale():
            bad.header.stamp += rospy.Duration(0.1)
            self.publisher.publish(bad)
            return self.estimates[-1].state == 'stale'

        end = rospy.get_time() + 60
        while not stale() and rospy.get_time() < end:
            threading.Event().wait(0.1)
        self.assertIn('no measurement could be used', self.estimates[-1].state_reason)
        self.wait_for(lambda: self.level == DiagnosticStatus.STALE, 'expected the level STALE')
        self.assertIn('stale', self.message)


if __name__ == '__main__':
    rospy.init_node('disturbed_test')
    rostest.rosrun('tissue_stiffness', 'disturbed', DisturbedTest, sys.argv)
