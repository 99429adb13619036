#!/usr/bin/env python3
"""mesh_node: the latched mesh, its services, and a mesh from a contour."""
import math
import os
import sys
import shutil
import threading
import unittest

import rospy
import rostest
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import CameraInfo
from tf2_msgs.msg import TFMessage

from tissue_stiffness.msg import Contour, TetMesh
from tissue_stiffness.srv import BuildMesh, SaveMesh

MESHES = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'data', 'meshing')


def service(name, kind):
    rospy.wait_for_service(name, 30)
    return rospy.ServiceProxy(name, kind)


FOLDER = ''  # the node's


class MeshTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        global FOLDER
        FOLDER = rospy.get_param('mesh_node/mesh_folder')
        os.makedirs(FOLDER)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(FOLDER)

    def test_the_mesh_is_latched(self):
        mesh = rospy.wait_for_message('mesh', TetMesh, 30)
        self.assertEqual(mesh.header.frame_id, 'model')
        self.assertEqual(mesh.nodes_per_tet, 10)
        self.assertGreater(len(mesh.nodes), mesh.corner_count)
        self.assertEqual(len(mesh.facets), 6 * len(mesh.facet_tet))
        self.assertEqual(max(mesh.tets), len(mesh.nodes) - 1)

    def test_build_and_save(self):
        build, save = service('build_mesh', BuildMesh), service('save_mesh', SaveMesh)
        saved = save(file='saved.vtk')
        self.assertTrue(saved.success, saved.message)
        self.assertEqual(os.listdir(FOLDER), ['saved.vtk'])
        larger = build(file='saved.vtk', scale=2.0)
        self.assertTrue(larger.success, larger.message)
        mesh = rospy.wait_for_message('mesh', TetMesh, 30)
        self.assertEqual(larger.nodes, len(mesh.nodes))
        again = build()
        self.assertTrue(again.success, again.message)
        original = rospy.wait_for_message('mesh', TetMesh, 30)
        self.assertEqual(larger.tetrahedra, again.tetrahedra)
        self.assertAlmostEqual(max(p.x for p in mesh.nodes), 2 * max(p.x for p in original.nodes), places=9)

    def test_meshes_of_other_programs_are_read(self):
        build = service('build_mesh', BuildMesh)
        for file in ('box.vtu', 'box.inp'):
            shutil.copy(os.path.join(MESHES, file), FOLDER)
            answer = build(file=file, scale=0.01)
            os.remove(os.path.join(FOLDER, file))
            self.assertTrue(answer.success, answer.message)
            self.assertEqual(answer.tetrahedra, 12)
        self.assertTrue(build().success)

    def test_wrong_requests_are_answered(self):
        build, save = service('build_mesh', BuildMesh), service('save_mesh', SaveMesh)
        for answer, part in ((build(file='none.vtk'), 'none.vtk'), (build(file='/etc/passwd'), 'in the folder ' + FOLDER),
                             (build(file='../passwd.vtk'), 'in the folder'), (build(scale=-1), 'scale'),
                             (build(scale=math.nan), 'nan'), (build(scale=math.inf), 'inf'),
                             (build(scale=1e30), 'is the scale right?'), (build(scale=1e-30), 'is the scale right?'),
                             (save(file='/tmp/mesh.vtk'), 'in the folder'), (save(file='../mesh.vtk'), 'in the folder'),
                             (save(file='mesh.txt'), '.vtk')):
            self.assertFalse(answer.success)
            self.assertIn(part, answer.message)
        self.assertFalse(os.path.exists('/tmp/mesh.vtk'))
        save_nowhere = service('revolved/save_mesh', SaveMesh)
        self.assertIn('~mesh_folder', save_nowhere(file='mesh.vtk').message)
        self.assertTrue(build().success)

    def test_a_body_of_revolution_from_the_first_contour(self):
        """A sphere of 3 cm, 1 m before a camera that looks along the model's y axis."""
        radius, focal = 0.03, 2500.0
        pixels = focal * math.tan(math.asin(radius / 1.0))
        pose = TransformStamped()
        pose.header.frame_id, pose.child_frame_id = 'model', 'camera'
        pose.transform.translation.y = -1.0
        pose.transform.rotation.x, pose.transform.rotation.w = -math.sqrt(0.5), math.sqrt(0.5)
        poses = rospy.Publisher('/tf_static', TFMessage, queue_size=1, latch=True)
        poses.publish(TFMessage([pose]))
        info = CameraInfo(width=640, height=480)
        info.K = [focal, 0, 319.5, 0, focal, 239.5, 0, 0, 1]
        infos = rospy.Publisher('/camera/camera_info', CameraInfo, queue_size=1, latch=True)
        infos.publish(info)
        contour = Contour(width=640, height=480, closed=True)
        contour.header.stamp, contour.header.frame_id = rospy.Time(100), 'camera'
        for i in range(360):
            u, v = math.cos(math.radians(i)), math.sin(math.radians(i))
            contour.u.append(319.5 + pixels * u)
            contour.v.append(239.5 + pixels * v)
            contour.normal_u.append(u)
            contour.normal_v.append(v)
            contour.sigma.append(0.1)
        contours = rospy.Publisher('revolved/contour', Contour, queue_size=1)
        self.assertFalse(contours.get_num_connections(), 'nobody wants the mesh yet')
        meshes, arrived = [], threading.Event()
        rospy.Subscriber('revolved/mesh', TetMesh, lambda mesh: (meshes.append(mesh), arrived.set()))
        while not contours.get_num_connections():
            threading.Event().wait(0.05)
        broken = Contour(width=640, height=480)
        broken.header = contour.header
        contours.publish(broken)
        contours.publish(contour)
        self.assertTrue(arrived.wait(60))
        radii = [math.sqrt(p.x ** 2 + p.y ** 2 + p.z ** 2) for p in meshes[0].nodes]
        self.assertAlmostEqual(max(radii), radius, delta=0.02 * radius)


if __name__ == '__main__':
    rospy.init_node('mesh_test')
    rostest.rosrun('tissue_stiffness', 'mesh', MeshTest, sys.argv)
