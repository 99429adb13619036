"""The paper's tables 2 and 3: a tennis ball and a foam ball on high-speed video, from pixels to Young's modulus."""
import copy
import os

import cv2
import numpy as np
import rosbag
import yaml

from common import Workshop, modulus, publish, table
from meshes import write_obj

STARTS = (0.5, 5.0)  # times the truth
VELOCITIES = (0.0, 0.01, 20.0)  # m/s, assumed in their table 2
IMAGE, INFO = '/camera/image_raw', '/camera/camera_info'
BALLS = {
    'foam_ball': {'name': 'foam ball', 'radius': 0.030, 'density': 30.0, 'truth': 22e3, 'speed': 4.0,
                  'rate': 2000.0, 'gap': 0.004, 'edge': 0.0075, 'wang': '0.1-0.2', 'published': '12-21', 'measured': '10-30'},
    'tennis_ball': {'name': 'tennis ball', 'radius': 0.033, 'density': 400.0, 'truth': 1.9e6, 'speed': 20.0, 'rate': 8000.0,
                    'gap': 0.008, 'edge': 0.0083, 'wang': '5.1-5.9', 'published': '2200-2500', 'measured': '1000-5000'}}
FRAMES = 40


def sphere(radius, cuts):
    """An icosahedron whose triangles are cut into four, several times, and moved to the sphere."""
    golden = 0.5 * (1.0 + np.sqrt(5.0))
    points = [(a, b * golden, 0) for a in (-1, 1) for b in (1, -1)]
    points = points + [(0, x, y) for x, y, _ in points] + [(y, 0, x) for x, y, _ in points]
    points = [np.array(p, float) / np.linalg.norm(p) for p in points]
    near = [[j for j in range(12) if 0 < np.linalg.norm(points[i] - points[j]) < 1.2] for i in range(12)]
    triangles = [(i, j, k) for i in range(12) for j in near[i] for k in near[j] if i < j < k and k in near[i]]
    triangles = [t if np.dot(np.cross(points[t[0]], points[t[1]]), points[t[2]]) > 0 else t[::-1] for t in triangles]
    for _ in range(cuts):
        middles, finer = {}, []

        def middle(i, j):
            key = (min(i, j), max(i, j))
            if key not in middles:
                points.append((points[i] + points[j]) / np.linalg.norm(points[i] + points[j]))
                middles[key] = len(points) - 1
            return middles[key]
        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = finer
    return radius * np.array(points), np.array(triangles)


def model_of(ball, velocity='from_frames'):
    floor = -ball['radius'] - ball['gap']
    return {'mesh': {'revolve': {'contour': 'first', 'axis': [0.0, 0.0, 1.0], 'max_edge_length': ball['edge']}},
            'effects': [{'inertia': {'density': ball['density']}},
                        {'elasticity': {'law': 'neo_hookean', 'young_modulus': {'prior': 2.0 * ball['truth'], 'factor': 3.0},
                                        'poisson_ratio': 0.45}},
                        {'gravity': {'acceleration': [0.0, 0.0, -9.81]}},
                        {'contact_plane': {'point': [0.0, 0.0, floor], 'normal': [0.0, 0.0, 1.0]}}],
            'observations': [{'contour': {'image': IMAGE, 'camera_info': INFO, 'segmentation': {'kind': 'silhouette'},
                                          'projection': 'silhouette', 'noise': 3e-4}}],
            'initial': {'velocity': velocity}}


def film(work, key, ball):
    """A video of our own renderer: another mesh, finer, and another contact stiffness than the model's."""
    write_obj(work.path(key + '.obj'), *sphere(ball['radius'], 3))
    scene = model_of(ball, [0.0, 0.0, -ball['speed']])
    scene['mesh'] = {'file': key + '.obj'}
    scene['effects'][1]['elasticity']['young_modulus'] = ball['truth']
    scene['effects'][3]['contact_plane']['stiffness'] = 60.0 * ball['truth'] / ball['radius']
    floor = scene['effects'][3]['contact_plane']['point'][2]
    camera = {'size': [320, 240], 'focal_length': 2250.0, 'position': [0.0, -1.0, floor + 0.045],
              'target': [0.0, 0.0, floor + 0.045]}
    scene['simulation'] = {'duration': FRAMES / ball['rate'], 'rate': ball['rate'], 'step': 0.25 / ball['rate'],
                           'spectral_radius': 0.9, 'seed': 5, 'sensors': {IMAGE: camera}}
    bag = work.simulate(key, scene)
    work.progress(ball['name'] + ' filmed')
    return bag


def picture(bag, path):
    """Four frames of a video."""
    with rosbag.Bag(bag) as file:
        images = [np.frombuffer(m.data, np.uint8).reshape(m.height, m.step)[:, :m.width]
                  for _, m, _ in file.read_messages(IMAGE)]
    cv2.imwrite(path, np.hstack([images[i] for i in (0, 12, 24, 36)]), [cv2.IMWRITE_JPEG_QUALITY, 85])


def fit(work, ball, label, model, bag, rows):
    results, _ = work.estimate(label, model, bag)
    mean, _, interval = modulus(results)
    speed = results['parameters'].get('initial.velocity_z')
    rows[label] = {'E': mean, 'interval': interval, 'rms': 1e3 * results['rms_error'], 'state': results.get('state', ''),
                   'speed': -speed['mean'] if speed else None, 'off': 100 * (1e3 * mean / ball['truth'] - 1)}
    work.progress('%s: %.4g kPa, %+.1f %%' % (label, mean, rows[label]['off']))
    return rows[label]


def started(model, start):
    changed = copy.deepcopy(model)
    for effect in changed['effects']:
        if 'elasticity' in effect:
            effect['elasticity']['young_modulus'] = {'prior': float(start), 'factor': 3.0}
    return changed


def independent(work, place, rows):
    """The videos of the independent simulator, from starts far off."""
    lines = []
    for key, ball in BALLS.items():
        folder = os.path.join(place.shared, 'recordings', key)
        with open(os.path.join(folder, 'model.yaml')) as file:
            model = yaml.safe_load(file)
        for start in STARTS:
            row = fit(work, ball, '%s_from_%g' % (key, start), started(model, start * ball['truth']),
                      os.path.join(folder, 'recording.bag'), rows)
            lines.append([ball['name'], '%g x' % start, '%.4g' % (ball['truth'] / 1e3),
                          '%.4g (%.4g to %.4g)' % ((row['E'],) + tuple(row['interval'])),
                          '%+.1f' % row['off'], '%.2f' % row['speed'], '%.2f' % row['rms']])
    publish(work.root, 'balls', table(['ball', 'start', 'true E [kPa]', 'E [kPa], 95 % interval', 'error [%]',
                                       'speed found [m/s]', 'rms error [mm]'], lines))


def own_videos(work, rows):
    lines, bags = [], {}
    for key, ball in BALLS.items():
        bags[key] = film(work, key, ball)
        row = fit(work, ball, key + '_own', model_of(ball), bags[key], rows)
        lines.append([ball['name'], ball['wang'], ball['published'], ball['measured'], '%.4g' % (ball['truth'] / 1e3),
                      '**%.4g** (%+.1f %%)' % (row['E'], row['off'])])
    publish(work.root, 'table3', table(['ball, E in kPa', 'Wang et al., published', 'Yang & Lin, published',
                                        'measured, published', 'truth of our video', 'ours'], lines))
    picture(bags['tennis_ball'], os.path.join(work.root, 'doc', 'paper', 'tennis_ball.jpg'))
    return bags['tennis_ball']


def speeds(work, bag, rows):
    """Their table 2: what an assumed velocity does to E, and ours, which estimates it."""
    ball = BALLS['tennis_ball']
    found = [fit(work, ball, 'assumed_%g' % speed, model_of(ball, [0.0, 0.0, -speed]), bag, rows) for speed in VELOCITIES]
    found.append(rows['tennis_ball_own'])
    publish(work.root, 'table2', table(['assumed speed [m/s]'] + ['%g' % v for v in VELOCITIES] + ['**estimated**'], [
        ['E [kPa], published', '5.1-5.9', '620-690', '2200-2500', '-'],
        ['E [kPa], ours; truth %g' % (ball['truth'] / 1e3)] + ['%.4g' % row['E'] for row in found],
        ['error [%]'] + ['%+.1f' % row['off'] for row in found],
        ['rms error of the outline [mm]'] + ['%.2f' % row['rms'] for row in found]]))


def main(place):
    work, rows = Workshop(place, 7 + 2 * len(STARTS), 'balls'), {}
    speeds(work, own_videos(work, rows), rows)
    if not os.path.isdir(os.path.join(place.shared, 'recordings')):
        print('The independent videos are skipped: there is no ' + os.path.join(place.shared, 'recordings'))
        return
    independent(work, place, rows)
