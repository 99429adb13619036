"""How stiff the echo's ventricle is at the end of its filling, over an assumed rise of pressure: from rest in diastasis,
when the first rush of blood is over, to the largest outline after the atrium's beat. A body of revolution of the first outline."""
import cv2
import geometry_msgs.msg
import numpy as np
import rosbag
import rospy
import sensor_msgs.msg
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation
from tf2_msgs.msg import TFMessage

from common import publish, read_cloud, table
from meshes import revolved, write_obj

IMAGE, INFO, FRAME = '/ultrasound/image_raw', '/ultrasound/camera_info', 'ultrasound'
WALL = 0.010       # m, assumed thickness
RISE = 667.0       # Pa (5 mmHg), assumed from diastasis to the end of filling
EDGE = 0.006       # m
NOISE = 2e-3       # m, of an outline: two pixels


def profile(curve, base, apex, scale):
    """Distance from the axis against the distance from the base, both sides' mean [m]."""
    along = (apex - base) / np.linalg.norm(apex - base)
    away = (curve - base) / scale
    s, r = away @ along, away @ np.array([-along[1], along[0]])
    length = np.linalg.norm(apex - base) / scale
    places = length * np.sin(np.linspace(0.0, 0.5 * np.pi, 12))
    sides = []
    for side in (-1, 1):
        chosen = side * r > 0
        order = np.argsort(s[chosen])
        sides.append(np.interp(places, s[chosen][order], np.abs(r[chosen][order])))
    radius = np.mean(sides, axis=0)
    radius[-1] = 0.0
    return np.stack([radius, -places], axis=1)


def thickened(inner):
    """The inner profile moved out by the wall; the base stays plane."""
    tangent = np.gradient(inner, axis=0)
    normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    normal[0], normal[-1] = (1.0, 0.0), (0.0, -1.0)
    outer = inner + WALL * normal
    outer[1:, 1] = np.minimum(outer[1:, 1], -1e-3)
    return outer


def evenly(points):
    """The same line in steps of about an edge."""
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    at = np.linspace(0.0, length[-1], int(round(length[-1] / EDGE)) + 1)
    return np.stack([np.interp(at, length, points[:, i]) for i in range(2)], axis=1)


def pose(base, apex, camera, stamp):
    """The image in the ventricle's frame: middle of the base at the origin, apex down."""
    scale, centre = camera
    up = (base - apex) / np.linalg.norm(base - apex)
    z = np.array([up[0], up[1], 0.0])
    y = np.array([0.0, 0.0, 1.0])
    turn = np.stack([np.cross(y, z), y, z])
    shift = -turn @ np.append((base - centre) / scale, 0.0)
    out = geometry_msgs.msg.TransformStamped()
    out.header.stamp, out.header.frame_id, out.child_frame_id = stamp, 'model', FRAME
    for name, value in zip('xyz', shift):
        setattr(out.transform.translation, name, value)
    for name, value in zip('xyzw', Rotation.from_matrix(turn).as_quat()):
        setattr(out.transform.rotation, name, value)
    return out


def write_bag(work, cine, chosen, centre):
    """The frames of the filling, each with the pose of its base: what moves as a whole is no deformation."""
    paths, times, scale, kept, _, axes = cine
    ends = np.array([axes[kept.index(k)] for k in chosen])
    ends[1:-1] = (ends[:-2] + ends[1:-1] + ends[2:]) / 3.0
    with rosbag.Bag(work.path('filling.bag'), 'w') as bag:
        for k, (base, apex) in zip(chosen, ends):
            stamp = rospy.Time.from_sec(1e9 + times[k] - times[chosen[0]])
            grey = cv2.imread(paths[k], cv2.IMREAD_GRAYSCALE)
            image = sensor_msgs.msg.Image(height=grey.shape[0], width=grey.shape[1], encoding='mono8', step=grey.shape[1],
                                          data=grey.tobytes())
            info = sensor_msgs.msg.CameraInfo(height=grey.shape[0], width=grey.shape[1], distortion_model='plumb_bob',
                                              K=[scale, 0, centre[0], 0, scale, centre[1], 0, 0, 1])
            for message in (image, info):
                message.header.stamp, message.header.frame_id = stamp, FRAME
            bag.write('/tf', TFMessage([pose(base, apex, (scale, centre), stamp)]), stamp)
            bag.write(INFO, info, stamp)
            bag.write(IMAGE, image, stamp)
    return work.path('filling.bag'), ends


def model(inner_vertices, peak, duration, work, seed):
    course = work.path('pressure_%g.csv' % peak)
    with open(course, 'w') as file:
        file.write('time,pressure\n0,0\n%g,%g\n' % (duration, peak))
    return {'mesh': {'file': 'ventricle.obj'},
            'regions': {'cavity': {'vertices': inner_vertices}, 'base': {'box': {'min': [-1, -1, -1e-7], 'max': [1, 1, 1]}}},
            'effects': [{'inertia': {'density': 1060.0}},
                        {'elasticity': {'law': 'linear', 'young_modulus': {'prior': 10e3, 'factor': 5.0},
                                        'poisson_ratio': 0.45}},
                        {'fixed': {'region': 'base'}}, {'pressure': {'region': 'cavity', 'course': {'file': course}}}],
            'observations': [{'contour': {'image': IMAGE, 'camera_info': INFO, 'noise': NOISE, 'projection': 'slice',
                                          'region': 'cavity', 'segmentation': {'kind': 'cavity', 'seed': seed}}}]}


def vertices_of(work, points):
    """Numbers that the mesh gives to these points of its surface."""
    scene = {'mesh': {'file': 'ventricle.obj'}, 'regions': {'base': {'box': {'min': [-1, -1, -1e-7], 'max': [1, 1, 1]}}},
             'effects': [{'inertia': {'density': 1060.0}}, {'fixed': {'region': 'base'}},
                         {'elasticity': {'law': 'linear', 'young_modulus': 1e4, 'poisson_ratio': 0.45}}],
             'observations': [{'vertices': {'topic': '/tissue/vertices', 'noise': 1e-9}}],
             'simulation': {'duration': 0.05, 'rate': 30.0, 'step': 0.01}}
    _, ids, frames = read_cloud(work.simulate('ventricle', scene))
    return sorted(ids[cKDTree(frames[0]).query(points)[1]].tolist())


def diastasis(kept, curves):
    """The frame between the smallest and the largest outline around which the area changes least, and the largest one's."""
    sizes = np.array([cv2.contourArea(curves[k].astype(np.float32)) for k in kept])
    low, high = int(np.argmin(sizes)), int(np.argmax(sizes))
    change = [abs(sizes[i + 2] - sizes[i - 2]) for i in range(low + 2, high - 1)]
    return kept[low + 2 + int(np.argmin(change))], kept[high]


def relative_stiffness(work, cine):
    paths, times, scale, kept, curves, _ = cine
    first, last = diastasis(kept, curves)
    chosen = [k for k in kept if first <= k <= last]
    centre = np.array([0.5 * (cv2.imread(paths[0]).shape[1] - 1), 0.0])
    bag, ends = write_bag(work, cine, chosen, centre)
    inner = evenly(profile(curves[first], ends[0][0], ends[0][1], scale))
    outer = evenly(thickened(inner))
    rim = np.linspace(outer[0], inner[0], int(round(WALL / EDGE)) + 1)[1:-1]
    line = np.concatenate([outer[::-1], rim, inner])
    points, triangles = revolved(line, int(round(2 * np.pi * line[:, 0].max() / EDGE)))
    write_obj(work.path('ventricle.obj'), points, triangles)
    radii, heights = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    on_inner = cKDTree(inner).query(np.stack([radii, heights], axis=1))[0] < 1e-6
    vertices = vertices_of(work, points[on_inner])
    seed = [float(x) for x in curves[first].mean(axis=0)]
    duration = times[last] - times[first]
    rows = []
    for peak in (RISE, 2 * RISE):
        results, _ = work.estimate('filling_%g' % peak, model(vertices, peak, duration, work, seed), bag)
        found = results['parameters']['elasticity.young_modulus']
        rows.append(['%.2f kPa' % (peak / 1e3),
                     '%.1f kPa (%.1f to %.1f)' % tuple(v / 1e3 for v in [found['mean']] + list(found['interval95'])),
                     '%.1f' % (found['mean'] / peak), '%.1f mm' % (1e3 * results['rms_error']),
                     '%.0f %%' % (100 * results['relative_error'])])
        work.progress('echo: E over an assumed pressure of %.1f kPa' % (peak / 1e3))
    publish(work.root, 'filling', table(['assumed rise of the pressure', 'E', 'E / pressure',
                                         'rms error of the outline', 'of its motion'], rows))
