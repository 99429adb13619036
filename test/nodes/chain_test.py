#!/usr/bin/env python3
"""A real recording through mesh_node and estimator_node: the topics of the contract, and the truth."""
import math
import struct
import sys
import threading
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import SetBool
from visualization_msgs.msg import Marker

from tissue_stiffness.msg import Misfit, StiffnessEstimate, TetMesh

TRUTH = 550e3  # Pa, of test/data/case_01
FRAMES = 72
NOISE = 3e-4


class Recorder:
    def __init__(self, topic, kind, wanted=1):
        self.messages, self.changed, self.wanted = [], threading.Condition(), wanted
        self.subscriber = rospy.Subscriber(topic, kind, self.on_message, queue_size=1000)

    def on_message(self, message):
        with self.changed:
            self.messages.append(message)
            self.changed.notify_all()

    def wait_for_publisher(self):
        while not rospy.is_shutdown() and self.subscriber.get_num_connections() == 0:
            threading.Event().wait(0.05)

    def of_frames(self):
        """The last message of each frame: a study that ends after a frame gives another one of it."""
        return list({message.header.stamp: message for message in self.messages}.values())

    def wait(self, timeout=90):
        with self.changed:
            self.changed.wait_for(lambda: len(self.messages) >= self.wanted and
                                  (self.wanted == 1 or len(self.of_frames()) >= self.wanted), timeout)
            return list(self.messages)

    def wait_for_last(self, good, timeout=60):
        """A message of the last frame that is good, or the last one."""
        self.wait()

        def found():
            last = self.of_frames()[-1].header.stamp
            return [message for message in self.messages if message.header.stamp == last and good(message)]
        with self.changed:
            self.changed.wait_for(found, timeout)
            return (found() or self.messages)[-1]


class ChainTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.stiffness = Recorder('stiffness', StiffnessEstimate, FRAMES)
        cls.misfit = Recorder('misfit', Misfit, FRAMES)
        cls.surface = Recorder('tracked_surface', Marker)
        cls.points = Recorder('tracked_points', PointCloud2)
        cls.mesh = Recorder('mesh', TetMesh)
        cls.diagnostics = Recorder('/diagnostics', DiagnosticArray)
        for recorder in (cls.stiffness, cls.misfit, cls.surface, cls.points):
            recorder.wait_for_publisher()  # the player has been started paused, so that no frame is missed
        rospy.wait_for_service('player/pause_playback')
        rospy.ServiceProxy('player/pause_playback', SetBool)(False)
        cls.stiffness.wait()

    def test_every_frame_gives_an_estimate_and_the_last_one_is_right(self):
        last = self.stiffness.wait_for_last(lambda estimate: estimate.state == 'converged')
        estimates = self.stiffness.of_frames()
        self.assertEqual(len(estimates), FRAMES)
        self.assertEqual(list(last.names), ['elasticity.young_modulus'])
        self.assertEqual(list(last.units), ['Pa'])
        self.assertAlmostEqual(last.young_modulus / TRUTH, 1.0, delta=0.015)
        self.assertEqual(last.mean[0], last.young_modulus)
        self.assertLess(last.lower95[0], last.mean[0])
        self.assertGreater(last.upper95[0], last.mean[0])
        self.assertEqual(len(last.covariance), 1)
        self.assertEqual(last.state, 'converged')
        self.assertEqual(last.header.frame_id, 'model')
        stamps = [estimate.header.stamp for estimate in estimates]
        self.assertEqual(stamps, sorted(stamps))
        self.assertAlmostEqual((stamps[-1] - stamps[0]).to_sec(), 71 / 60.0, delta=1e-3)

    def test_the_misfit_is_the_noise(self):
        last = self.misfit.wait_for_last(lambda misfit: misfit.dof > 0)
        self.assertEqual(last.count, 3 * 160)
        self.assertAlmostEqual(last.rms / NOISE, 1.0, delta=0.15)
        self.assertAlmostEqual(last.rms_sigma, 1.0, delta=0.15)
        self.assertGreater(last.dof, 0)

    def test_the_surface_moves(self):
        mesh = self.mesh.wait()[0]
        marker = self.surface.wait()[-1]
        self.assertEqual(marker.type, Marker.TRIANGLE_LIST)
        self.assertEqual(len(marker.points), len(mesh.facets) // 6 * 4 * 3)
        self.assertEqual(len(marker.colors), len(marker.points))
        cloud = self.points.wait()[-1]
        names = [field.name for field in cloud.fields]
        self.assertEqual(names, ['x', 'y', 'z', 'dx', 'dy', 'dz', 'misfit', 'misfit_sigma', 'vertex'])
        rows = [struct.unpack_from('<8fi', cloud.data, i * cloud.point_step) for i in range(cloud.width)]
        largest = max(math.sqrt(sum(value * value for value in row[3:6])) for row in rows)
        self.assertGreater(largest, 1e-4)
        self.assertLess(largest, 0.05)

    def test_diagnostics_count_the_frames(self):
        for _ in range(20):
            statuses = [status for array in self.diagnostics.messages for status in array.status if 'estimator' in status.name]
            values = {entry.key: entry.value for entry in statuses[-1].values} if statuses else {}
            if values.get('frames used') == str(FRAMES):
                break
            threading.Event().wait(0.5)
        self.assertEqual(values.get('frames used'), str(FRAMES))
        self.assertEqual(values.get('frames dropped'), '0')
        self.assertNotIn('bad messages', values)


if __name__ == '__main__':
    rospy.init_node('chain_test', disable_rostime=True)
    rostest.rosrun('tissue_stiffness', 'chain', ChainTest, sys.argv)
