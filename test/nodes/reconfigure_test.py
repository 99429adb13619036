#!/usr/bin/env python3
"""What dynamic_reconfigure changes of a running estimator_node, and that the estimate goes on."""
import math
import signal
import sys
import threading
import unittest

import dynamic_reconfigure.client
import rosbag
import rospy
import rostest
from sensor_msgs.msg import PointCloud2
from visualization_msgs.msg import Marker

from disturbed_test import DisturbedTest
from estimator_status import OwnEstimator
from tissue_stiffness.msg import Diagnosis, StiffnessEstimate

TOPIC = '/tissue/vertices'
START = {'diagnosis_period': 0.0, 'diagnosis_window': 30.0, 'converged_within': 0.2, 'stale_after': 1e4, 'colour_limit': 3.0}


class ReconfigureTest(OwnEstimator, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with rosbag.Bag(rospy.get_param('~bag')) as bag:
            cls.frames = [DisturbedTest.plain(message) for _, message, _ in bag.read_messages(TOPIC)]
        cls.estimates, cls.surfaces, cls.diagnoses = [], [], []
        cls.subscribers = [cls.watch_status()] + [
            rospy.Subscriber(topic, kind, cls.keep, into, queue_size=1000) for topic, kind, into in (
                ('stiffness', StiffnessEstimate, cls.estimates), ('tracked_surface', Marker, cls.surfaces),
                ('diagnosis', Diagnosis, cls.diagnoses))]
        cls.publisher = rospy.Publisher(TOPIC, PointCloud2, queue_size=1000)
        cls.start_node('_diagnosis_period:=0', '_diagnosis_window:=30', '_stale_after:=1e4')
        while not cls.publisher.get_num_connections():
            threading.Event().wait(0.05)

    @classmethod
    def start_node(cls, *options):
        cls.run_node(*options)
        cls.client = dynamic_reconfigure.client.Client('/estimator_node', timeout=cls.patience)

    @classmethod
    def keep(cls, message, into):
        with cls.changed:
            into.append(message)
            cls.changed.notify_all()

    def change(self, **values):
        """Returns the values that hold afterwards. Frames that are published later are judged by them."""
        answer = self.client.update_configuration(values)
        return {name: answer[name] for name in START}

    def play(self, frames):
        """Returns the estimate of the last frame."""
        for frame in frames:
            self.publisher.publish(frame)
        stamp = frames[-1].header.stamp
        self.wait_for(lambda: self.estimates and self.estimates[-1].header.stamp == stamp, 'no estimate at %s' % stamp)
        return self.estimates[-1]

    def test_1_private_parameters_are_the_start_values(self):
        self.assertEqual({name: self.client.get_configuration(self.patience)[name] for name in START}, START)
        ranges = {one['name']: (one['min'], one['max']) for one in self.client.get_parameter_descriptions(self.patience)}
        self.assertEqual(ranges['converged_within'], (0.001, 0.2))
        self.assertEqual(ranges['diagnosis_window'], (1.0, 1e5))

    def test_2_a_wrong_value_changes_nothing_and_is_named(self):
        for name, value, shown, allowed in (('diagnosis_window', -1.0, '-1', 'from 1 to 100000 [s]'),
                                            ('converged_within', 0.5, '0.5', '0.001 to 0.2'),
                                            ('colour_limit', math.nan, 'nan', '0.1 to 1000')):
            self.assertEqual(self.change(**{name: value, 'diagnosis_period': 7.0}), START)
            self.wait_for(lambda: '/estimator_node: ' + name in self.values.get('last bad message', ''), 'the error is not told')
            for part in (shown, allowed):
                self.assertIn(part, self.values['last bad message'])
            self.assertEqual(rospy.get_param('/estimator_node/' + name), START[name])

    def test_3_a_stricter_limit_takes_the_state_and_not_the_estimate(self):
        self.play(self.frames[:60])
        self.wait_for(lambda: self.values.get('reprocessing') == 'no', 'the reprocessing does not end')
        converged = self.play(self.frames[60:62])
        self.assertEqual(converged.state, 'converged', converged.state_reason)
        self.change(converged_within=0.001)
        strict = self.play(self.frames[62:64])
        self.assertEqual(strict.state, 'converging', strict.state_reason)
        self.assertIn('is known to', strict.state_reason)
        self.assertAlmostEqual(strict.young_modulus / converged.young_modulus, 1.0, delta=0.01)
        self.assertLess(strict.young_modulus_std, 1.1 * converged.young_modulus_std)
        self.change(converged_within=0.2)
        again = self.play(self.frames[64:66])
        self.assertEqual(again.state, 'converged', again.state_reason)

    def test_4_the_colours_of_the_surface(self):
        def red(frame):
            self.play([frame])
            stamp = frame.header.stamp
            self.wait_for(lambda: self.surfaces and self.surfaces[-1].header.stamp == stamp, 'no surface at %s' % stamp)
            return sum(colour.r > 1.5 * colour.b for colour in self.surfaces[-1].colors)
        self.change(colour_limit=1000.0)
        self.assertEqual(red(self.frames[66]), 0)
        self.change(colour_limit=0.1)
        self.assertGreater(red(self.frames[67]), 0)

    def test_5_a_diagnosis_that_was_off_begins(self):
        self.assertEqual(self.diagnoses, [])
        self.change(diagnosis_period=1.0)
        self.wait_for(lambda: self.diagnoses, 'no diagnosis')
        self.change(diagnosis_period=0.0)

    def test_6_an_estimate_becomes_stale(self):
        self.assertNotEqual(self.estimates[-1].state, 'stale')
        self.change(stale_after=0.5)
        self.wait_for(lambda: self.estimates[-1].state == 'stale', 'not stale')
        self.assertIn('no measurement could be used for 0.5 s', self.estimates[-1].state_reason)

    def test_7_a_node_that_is_started_again_has_the_last_values(self):
        last = dict(START, colour_limit=0.1, stale_after=0.5)
        self.node.send_signal(signal.SIGINT)
        self.assertEqual(self.node.wait(self.patience), 0)
        self.client.close()
        self.start_node()
        self.assertEqual({name: self.client.get_configuration(self.patience)[name] for name in START}, last)


if __name__ == '__main__':
    rospy.init_node('reconfigure_test')
    rostest.rosrun('tissue_stiffness', 'reconfigure', ReconfigureTest, sys.argv)
