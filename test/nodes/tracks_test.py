#!/usr/bin/env python3
"""Images of an endoscope drive the running nodes: the segmentation node follows features of the surface, and E comes out."""
import os
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np
import roslib.packages
import rospkg
import rospy
import rostest
import yaml

from tissue_stiffness.msg import FeatureTracks, StiffnessEstimate

PACKAGE = rospkg.RosPack().get_path('tissue_stiffness')
MODEL = os.path.join(PACKAGE, 'test', 'nodes', 'tracks_model.yaml')
TRUTH = 12e3  # Pa
FRAMES = 30


def write_scene(file):
    with open(MODEL) as stream:
        scene = yaml.safe_load(stream)
    scene['mesh'] = {'file': os.path.join(PACKAGE, 'config', 'demo', 'mesh.vtk')}
    scene['effects'][1]['elasticity']['young_modulus'] = TRUTH
    scene['simulation'] = {
        'duration': FRAMES / 30.0, 'rate': 30, 'step': 0.002,
        'sensors': {'/endoscope/image_raw': {'size': [320, 240], 'focal_length': 400, 'position': [0.08, -0.15, 0.12],
                                             'target': [0, 0, 0.02], 'distortion': [-0.2, 0.05, 0, 0]}},
        'loads': {'/tool/wrench': {'rate': 100, 'terms': [
            {'direction': [0, 0, -1], 'raised_cosine': {'amplitude': 1.5, 'frequency': 1}},
            {'direction': [1, 0, 0], 'sine': {'amplitude': 0.8, 'frequency': 1.5}}]}}}
    with open(file, 'w') as stream:
        yaml.safe_dump(scene, stream)


class TracksTest(unittest.TestCase):
    def test_e_comes_out_of_features_of_the_surface(self):
        estimates, tracks, changed = [], [], threading.Condition()

        def keep(where, message):
            with changed:
                where.append(message)
                changed.notify_all()
        rospy.Subscriber('stiffness', StiffnessEstimate, lambda message: keep(estimates, message), queue_size=1000)
        rospy.Subscriber('tracks', FeatureTracks, lambda message: keep(tracks, message), queue_size=1000)
        with tempfile.TemporaryDirectory() as folder:
            scene, bag = os.path.join(folder, 'scene.yaml'), os.path.join(folder, 'film.bag')
            write_scene(scene)
            simulate = roslib.packages.find_node('tissue_stiffness', 'simulate')[0]
            subprocess.run([simulate, scene, '--allow-outside', '--output', bag], check=True, stdout=subprocess.DEVNULL)
            player = roslib.packages.find_node('rosbag', 'play')[0]
            subprocess.run([player, '--clock', '--wait-for-subscribers', '--quiet', '--rate=0.3', bag], timeout=80, check=True,
                           stdout=subprocess.DEVNULL)

        def of_frames():
            return {message.header.stamp for message in estimates}
        with changed:
            changed.wait_for(lambda: len(of_frames()) >= FRAMES - 2 and abs(estimates[-1].young_modulus / TRUTH - 1.0) < 0.05, 30)
        last = estimates[-1]
        print('%d images, %d features, E = %.2f kPa (%.2f to %.2f), %s' % (
            len(tracks), len(tracks[-1].id), last.young_modulus / 1e3, last.lower95[0] / 1e3, last.upper95[0] / 1e3, last.state_reason))
        self.assertGreaterEqual(len(of_frames()), FRAMES - 2)
        self.assertAlmostEqual(last.young_modulus / TRUTH, 1.0, delta=0.05)
        first = tracks[0]
        self.assertEqual((first.width, first.height), (320, 240))
        self.assertLess(np.abs(np.array(first.u) - first.reference_u).max(), 0.1, 'the first image is the reference')
        moved = np.hypot(np.array(tracks[15].u) - tracks[15].reference_u, np.array(tracks[15].v) - tracks[15].reference_v)
        self.assertGreater(moved.max(), 2.0)
        self.assertGreater(min(tracks[15].sigma), 0.0)


if __name__ == '__main__':
    rospy.init_node('tracks_test', disable_rostime=True)
    rostest.rosrun('tissue_stiffness', 'tracks', TracksTest, sys.argv)
