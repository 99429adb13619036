#!/usr/bin/env python3
"""A model with `map`: the running estimator maps the modulus beside the frames and publishes it as a coloured surface and
patch by patch."""
import sys
import threading
import unittest

import rospy
import rostest

from tissue_stiffness.msg import StiffnessEstimate, StiffnessMap, TetMesh
from visualization_msgs.msg import Marker

PATIENCE = 150.0  # s: on a busy machine; a free one needs a tenth


class MapTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.changed = threading.Condition()
        cls.heard = {}
        topics = {'stiffness_map': Marker, 'stiffness_patches': StiffnessMap, 'mesh': TetMesh, 'stiffness': StiffnessEstimate}
        cls.subscribers = [rospy.Subscriber(topic, kind, cls.keep, topic) for topic, kind in topics.items()]

    @classmethod
    def keep(cls, message, topic):
        with cls.changed:
            cls.heard[topic] = message
            cls.changed.notify_all()

    def wait_for(self, *topics):
        with self.changed:
            there = self.changed.wait_for(lambda: all(topic in self.heard for topic in topics), PATIENCE)
            self.assertTrue(there, 'heard only %s' % sorted(self.heard))

    def test_the_map_is_published_beside_the_estimate(self):
        self.wait_for('stiffness_map', 'stiffness_patches', 'mesh', 'stiffness')
        marker, patches, mesh = (self.heard[topic] for topic in ('stiffness_map', 'stiffness_patches', 'mesh'))
        self.assertEqual(marker.type, Marker.TRIANGLE_LIST)
        self.assertEqual(len(marker.points), 12 * len(mesh.facet_tet))
        self.assertEqual(len(marker.colors), len(marker.points))
        count = len(patches.young_modulus)
        self.assertGreater(count, 0)
        self.assertEqual(len(patches.patch_of_tet), len(mesh.tets) // mesh.nodes_per_tet)
        self.assertEqual(set(patches.patch_of_tet), set(range(count)))
        for low, modulus, high in zip(patches.lower95, patches.young_modulus, patches.upper95):
            self.assertLess(low, modulus)
            self.assertLess(modulus, high)
        print('%d patches, %d identified, from %.1f to %.1f kPa' % (
            count, sum(patches.identified), min(patches.young_modulus) / 1e3, max(patches.young_modulus) / 1e3))


if __name__ == '__main__':
    rospy.init_node('map_test', disable_rostime=True)
    rostest.rosrun('tissue_stiffness', 'map', MapTest, sys.argv)
