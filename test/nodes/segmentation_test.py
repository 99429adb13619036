#!/usr/bin/env python3
"""segmentation_node on drawn images: a bright disc before a textured background."""
import sys
import threading
import unittest

import numpy as np
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import CameraInfo, Image

from tissue_stiffness.msg import Contour

WIDTH, HEIGHT, RADIUS = 320, 240, 50.0


def disc(centre, seed):
    """Grey disc with a soft edge of one pixel."""
    v, u = np.mgrid[0:HEIGHT, 0:WIDTH]
    background = 50 + 10 * np.sin(u / 17.0) * np.cos(v / 23.0)
    inside = np.clip(RADIUS - np.hypot(u - centre[0], v - centre[1]) + 0.5, 0, 1) if centre else 0.0
    grey = background * (1 - inside) + 170 * inside + np.random.default_rng(seed).normal(0, 2, (HEIGHT, WIDTH))
    return np.clip(grey, 0, 255).astype(np.uint8)


def image(pixels, stamp, encoding='mono8'):
    out = Image(height=HEIGHT, width=WIDTH, encoding=encoding, step=WIDTH, data=pixels.tobytes())
    out.header.stamp, out.header.frame_id = rospy.Time.from_sec(stamp), 'camera'
    return out


class SegmentationTest(unittest.TestCase):
    def setUp(self):
        self.contours, self.overlays, self.changed = {}, {}, threading.Condition()
        self.subscribers = [rospy.Subscriber('contour', Contour, lambda m: self.keep(self.contours, m), queue_size=100),
                            rospy.Subscriber('overlay', Image, lambda m: self.keep(self.overlays, m), queue_size=100)]
        self.images = rospy.Publisher('/camera/image_raw', Image, queue_size=100)
        self.infos = rospy.Publisher('/camera/camera_info', CameraInfo, queue_size=100)
        while not (self.images.get_num_connections() and self.infos.get_num_connections()):
            self.pause(0.05)

    def tearDown(self):
        for subscriber in self.subscribers:
            subscriber.unregister()
        self.images.unregister()
        self.infos.unregister()

    def keep(self, where, message):
        with self.changed:
            where[round(message.header.stamp.to_sec(), 6)] = message
            self.changed.notify_all()

    @staticmethod
    def pause(seconds):
        threading.Event().wait(seconds)

    def wait(self, where, stamp, timeout=20):
        with self.changed:
            self.changed.wait_for(lambda: stamp in where, timeout)
        return where.get(stamp)

    def publish(self, stamp, centre, **options):
        self.images.publish(image(disc(centre, int(1000 * stamp)), stamp, **options))

    def test_finds_the_disc_in_every_frame(self):
        info = CameraInfo(width=WIDTH, height=HEIGHT)
        self.infos.publish(info)
        for i in range(8):
            stamp, centre = 100.0 + 0.5 * i, (140.0 + 3.0 * i, 120.0 + 0.5 * i)
            self.publish(stamp, centre)
            contour = self.wait(self.contours, stamp)
            self.assertIsNotNone(contour, 'no contour for the image at %g s' % stamp)
            self.assertEqual(contour.header.frame_id, 'camera')
            self.assertEqual((contour.width, contour.height, contour.closed), (WIDTH, HEIGHT, True))
            u, v = np.array(contour.u), np.array(contour.v)
            distance = np.hypot(u - centre[0], v - centre[1])
            self.assertLess(abs(distance.mean() - RADIUS), 0.3)
            self.assertLess(distance.std(), 0.5)
            outward = (u - centre[0]) * contour.normal_u + (v - centre[1]) * contour.normal_v
            self.assertGreater(outward.min(), 0)
        overlay = self.wait(self.overlays, stamp)
        self.assertIsNotNone(overlay)
        self.assertEqual(overlay.encoding, 'bgr8')
        pixels = np.frombuffer(overlay.data, np.uint8).reshape(HEIGHT, WIDTH, 3).astype(int)
        green = (pixels[:, :, 1] - pixels[:, :, 0]) > 60
        self.assertGreater(green.sum(), 0.5 * 2 * np.pi * RADIUS)

    def test_draws_the_models_outline_of_the_same_stamp(self):
        predicted = rospy.Publisher('predicted_contour', Contour, queue_size=10)
        self.addCleanup(self.pause, 0.5)
        self.addCleanup(predicted.unregister)
        while not predicted.get_num_connections():
            self.pause(0.05)
        self.wait_until_drawn(predicted)
        for stamp in (150.0, 150.5, 151.0):
            self.publish(stamp, (160.0, 120.0))
            self.assertIsNotNone(self.wait(self.contours, stamp))
        self.pause(0.3)
        self.assertEqual(list(self.overlays), [], 'an overlay did not wait for the model')
        predicted.publish(self.outline(150.5))
        self.assertIsNotNone(self.wait(self.overlays, 150.5))
        self.assertNotIn(151.0, self.overlays)
        self.assertEqual(self.magenta(self.overlays[150.0]), 0, 'the outline of another image')
        self.assertGreater(self.magenta(self.overlays[150.5]), 100)

    @staticmethod
    def outline(stamp):
        line = np.arange(20.0, 220.0)
        out = Contour(width=WIDTH, height=HEIGHT, u=line, v=np.full_like(line, 20.0))
        out.header.stamp = rospy.Time.from_sec(stamp)
        return out

    def wait_until_drawn(self, predicted):
        """Waits until the node draws what is predicted, because a publisher knows of a connection before the node does. What
        is published until then may be lost, so it is published again."""
        stamp = 140.0
        while True:
            self.publish(stamp, (160.0, 120.0))
            self.assertIsNotNone(self.wait(self.contours, stamp))
            overlay = None
            while overlay is None:
                predicted.publish(self.outline(stamp))
                overlay = self.wait(self.overlays, stamp, timeout=0.5)
            if self.magenta(overlay):
                break
            stamp += 0.01
        with self.changed:
            self.overlays.clear()

    @staticmethod
    def magenta(overlay):
        blue, green, red = np.frombuffer(overlay.data, np.uint8).reshape(-1, 3).astype(int).T
        return ((blue - green > 60) & (red - green > 60)).sum()

    def test_takes_the_masks_of_a_network(self):
        masks = rospy.Publisher('/network/mask', Image, queue_size=10)
        contours = {}
        subscriber = rospy.Subscriber('mask_contour', Contour, lambda m: self.keep(contours, m), queue_size=10)
        self.addCleanup(masks.unregister)
        self.addCleanup(subscriber.unregister)
        while not masks.get_num_connections():
            self.pause(0.05)
        v, u = np.mgrid[0:HEIGHT, 0:WIDTH]
        body = np.hypot(u - 150.0, v - 120.0) < RADIUS
        other = np.hypot(u - 20.0, v - 20.0) < 15
        masks.publish(image((body | other).astype(np.uint8), 300.0))
        masks.publish(image(other.astype(np.uint8), 300.1))  # nothing in the region of interest
        wide = image((body | other).astype('<u2'), 300.2, 'mono16')
        wide.step = 2 * WIDTH
        masks.publish(wide)
        for stamp in (300.0, 300.2):
            contour = self.wait(contours, stamp)
            self.assertIsNotNone(contour, 'no contour for the mask at %g s' % stamp)
            distance = np.hypot(np.array(contour.u) - 150.0, np.array(contour.v) - 120.0)
            self.assertLess(abs(distance.mean() - RADIUS), 0.2)
            self.assertLess(distance.std(), 0.4)
        self.assertEqual(sorted(contours), [300.0, 300.2])

    def test_survives_what_it_cannot_use(self):
        self.publish(200.0, None)  # nothing to be found
        self.images.publish(image(disc(None, 1), 200.1, 'holiday'))
        cut = image(disc((160, 120), 2), 200.2)
        cut.data = cut.data[:100]
        self.images.publish(cut)
        self.images.publish(image(disc((160, 120), 3), 0))  # no stamp
        wrong = CameraInfo(width=17, height=HEIGHT)
        self.infos.publish(wrong)
        self.pause(0.5)
        self.publish(200.3, (160.0, 120.0))  # of another size than the camera says
        self.pause(0.5)
        self.infos.publish(CameraInfo(width=WIDTH, height=HEIGHT))
        self.pause(0.5)
        self.publish(200.4, (160.0, 120.0))
        self.assertIsNotNone(self.wait(self.contours, 200.4))
        self.assertEqual([stamp for stamp in self.contours if stamp != 200.4], [])
        status = self.wait_for_status('bad messages', '4')
        self.assertEqual(status.get('images without a contour'), '1')

    def wait_for_status(self, key, wanted):
        found, done = {}, threading.Event()

        def on_diagnostics(message):
            if not message.status[0].name.startswith('/segmentation_node'):
                return
            for entry in message.status[0].values:
                found[entry.key] = entry.value
            if found.get(key) == wanted:
                done.set()
        subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, on_diagnostics)
        self.assertTrue(done.wait(10), 'waited for %s = %s, found %s' % (key, wanted, found))
        subscriber.unregister()
        return found


if __name__ == '__main__':
    rospy.init_node('segmentation_test')
    rostest.rosrun('tissue_stiffness', 'segmentation', SegmentationTest, sys.argv)
