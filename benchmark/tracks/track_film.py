"""A film of a truth of the independent simulator, drawn by that simulator's renderer, and its rosbag."""
import os

import cv2
import numpy as np
import yaml
from geometry_msgs.msg import TransformStamped
from scipy.spatial.transform import Rotation
from sensor_msgs.msg import CameraInfo, Image
from tf2_msgs.msg import TFMessage

from foreign import simulate_header
from rig_recordings import stamp

SIZE = (640, 480)
DISTANCE = 0.25  # m, of an endoscope
NOISE = 3.0      # grey values
FINER = 3        # times the renderer's own triangles


def draw(render, truth, config, view, seed, folder):
    """Draws the film of a truth into a folder."""
    run = os.path.join(folder, 'run')
    os.makedirs(os.path.join(run, 'truth'), exist_ok=True)
    np.savez(os.path.join(run, 'truth', 'sim.npz'), **truth.film)
    with open(os.path.join(run, 'truth', 'truth.yaml'), 'w') as file:
        yaml.safe_dump({'parameters': config}, file)
    divide = render.subdivide
    render.subdivide = lambda n: divide(FINER * n)  # the surface's texture is as fine as its triangles
    render.camera(run, os.path.join(folder, 'images'), view=view, size=SIZE, distance=DISTANCE, noise=NOISE, seed=seed)
    os.remove(os.path.join(run, 'truth', 'sim.npz'))


def write_pose(bag, images, header):
    turn = np.array(images['R_world_to_cam'], float)
    place = -turn.T @ np.array(images['t_world_to_cam'], float)
    message = TransformStamped(header=header, child_frame_id='endoscope')
    message.header.frame_id = 'model'
    message.transform.translation.x, message.transform.translation.y, message.transform.translation.z = place
    q = message.transform.rotation
    q.x, q.y, q.z, q.w = Rotation.from_matrix(turn.T).as_quat()
    bag.write('/tf_static', TFMessage([message]), header.stamp)


def write(bag, folder):
    """Writes the images of a folder with their calibration and the camera's pose."""
    with open(os.path.join(folder, 'images', 'images.yaml')) as file:
        images = yaml.safe_load(file)
    matrix = np.array(images['K'], float)
    info = CameraInfo(width=images['width'], height=images['height'], distortion_model='plumb_bob', D=[0.0] * 5,
                      K=list(matrix.ravel()), R=list(np.eye(3).ravel()), P=list(np.c_[matrix, np.zeros(3)].ravel()))
    for k, (name, time) in enumerate(zip(images['frames'], images['time'])):
        header = simulate_header(k, stamp(float(time)))
        header.frame_id = 'endoscope'
        if k == 0:
            write_pose(bag, images, simulate_header(k, header.stamp))
        picture = cv2.imread(os.path.join(folder, 'images', name), cv2.IMREAD_GRAYSCALE)
        info.header = header
        bag.write('/endoscope/camera_info', info, header.stamp)
        bag.write('/endoscope/image_raw', Image(header=header, height=picture.shape[0], width=picture.shape[1], encoding='mono8',
                                                step=picture.shape[1], data=picture.tobytes()), header.stamp)
