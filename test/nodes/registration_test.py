#!/usr/bin/env python3
"""A node whose master was started again ends, so that roslaunch may start it anew. The test has a master of its own."""
import os
import socket
import subprocess
import sys
import threading
import unittest

import roslib.packages
import rosgraph
import rospy
import rostest

PATIENCE = 90.0  # s
FIRST = '/mesh_node/get_loggers'  # what the node registers first; it may register the rest with the next master


def free_port():
    with socket.socket() as one:
        one.bind(('127.0.0.1', 0))
        return one.getsockname()[1]


class RegistrationTest(unittest.TestCase):
    def setUp(self):
        self.port = free_port()
        self.address = 'http://127.0.0.1:%d' % self.port
        self.started = []

    def tearDown(self):
        for process in self.started:
            process.terminate()
            process.wait()

    def start(self, *command):
        self.started.append(subprocess.Popen(command, env=dict(os.environ, ROS_MASTER_URI=self.address)))
        return self.started[-1]

    def start_master(self):
        return self.start('rosmaster', '--core', '-p', str(self.port))

    def wait_for(self, condition, text):
        end = threading.Event()
        for _ in range(int(PATIENCE / 0.2)):
            if condition():
                return
            end.wait(0.2)
        self.fail(text)

    def registered(self):
        try:
            return bool(rosgraph.Master('/registration_test', self.address).lookupService(FIRST))
        except (rosgraph.MasterException, OSError):
            return False

    def test_a_node_that_the_master_has_forgotten_ends(self):
        master = self.start_master()
        self.wait_for(rosgraph.Master('/registration_test', self.address).is_online, 'no master')
        program = roslib.packages.find_node('tissue_stiffness', 'mesh_node')[0]
        node = self.start(program, '_model:=' + rospy.get_param('~model'))
        self.wait_for(self.registered, 'the node does not register')
        master.terminate()
        master.wait()
        self.assertIsNone(node.poll(), 'a master that is away ends no node')
        self.start_master()
        self.wait_for(lambda: node.poll() is not None, 'the forgotten node runs on')
        self.assertEqual(node.returncode, 1)


if __name__ == '__main__':
    rospy.init_node('registration_test')
    rostest.rosrun('tissue_stiffness', 'registration', RegistrationTest, sys.argv)
