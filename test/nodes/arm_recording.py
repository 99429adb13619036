#!/usr/bin/env python3
"""Tells the demo's recording as an arm with CRTK's names would: the tool's pose, and the wrench that the tissue does to it, in the
turning tool's own frame, and no frame named.
usage: arm_recording.py DEMO.bag OUT.bag
"""
import sys

import numpy as np
import rosbag
from geometry_msgs.msg import PoseStamped, WrenchStamped

BASE_POSE = '0.3 -0.2 0.1 0.5 0.2 -0.3'  # x y z yaw pitch roll of the arm's base in the model frame


def turn(axis, angle):
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    out = np.eye(3)
    out[i, i] = out[j, j] = c
    out[i, j], out[j, i] = -s, s
    return out


def base_rotation():
    yaw, pitch, roll = (float(word) for word in BASE_POSE.split()[3:])
    return turn(2, yaw) @ turn(1, pitch) @ turn(0, roll)


def as_an_arm(force, header, angle):
    """Of a tool turned by `angle` about its base's x."""
    pose, wrench = PoseStamped(), WrenchStamped()
    pose.header.stamp = wrench.header.stamp = header.stamp
    pose.pose.orientation.x, pose.pose.orientation.w = np.sin(angle / 2), np.cos(angle / 2)
    felt = -(base_rotation() @ turn(0, angle)).T @ np.array([force.x, force.y, force.z])
    wrench.wrench.force.x, wrench.wrench.force.y, wrench.wrench.force.z = felt
    return pose, wrench


def write_recording(demo_file, file):
    with rosbag.Bag(demo_file) as demo, rosbag.Bag(file, 'w') as out:
        start = None
        for topic, message, stamp in demo.read_messages():
            start = start or stamp
            if topic == '/tissue/vertices':
                out.write('/tracker/points', message, stamp)
            elif topic == '/tool/wrench':
                pose, wrench = as_an_arm(message.wrench.force, message.header, 0.8 * (stamp - start).to_sec())
                out.write('/PSM1/measured_cp', pose, stamp)
                out.write('/PSM1/body/measured_cf', wrench, stamp)


if __name__ == '__main__':
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    write_recording(sys.argv[1], sys.argv[2])
