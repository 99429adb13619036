"""The pictures of the recipe: see scripts/draw_figures."""
import csv
import os
import subprocess
import sys

import numpy as np
import yaml

from figures import plt, save

INK, GOOD, FLOOR = '#333333', '#0072b2', '#777777'
MODULUS = 'elasticity.young_modulus'
TOPIC = '/camera/image_raw'
OVERVIEW = {'size': [900, 600], 'focal_length': 1000, 'position': [0.6, -0.6, 0.34], 'target': [0.03, -0.23, 0.055], 'up': [0, 0, 1]}
FOOT = [(0.015, 0.015), (0.015, -0.015), (-0.015, -0.015)]  # m: the visible edge of the holder
ROD = 0.13  # m: x of the rod that the thread is led over


def clean(axis):
    for side in ('top', 'right', 'left'):
        axis.spines[side].set_visible(False)
    axis.tick_params(length=0)


def read_yaml(path):
    with open(path) as file:
        return yaml.safe_load(file)


def truth_of(scene):
    return next(float(effect['elasticity']['young_modulus']) for effect in scene['effects'] if 'elasticity' in effect)


def images_at(bag, seconds):
    """The image of a recording at each of these times after its first one."""
    import rosbag  # only these pictures need it
    with rosbag.Bag(bag) as file:
        messages = [message for _, message, _ in file.read_messages(topics=[TOPIC])]
    stamps = np.array([message.header.stamp.to_sec() for message in messages])
    out = []
    for time in seconds:
        message = messages[int(np.argmin(abs(stamps - stamps[0] - time)))]
        out.append(np.frombuffer(message.data, np.uint8).reshape(message.height, message.width, -1).squeeze())
    return out


def axes_of(sensor):
    """The camera's axes to the right, down and forwards, as rows."""
    forward = np.subtract(sensor['target'], sensor['position'])
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, sensor['up'])
    right = right / np.linalg.norm(right)
    return np.array([right, np.cross(forward, right), forward])


def pixels(sensor, points):
    """Where a camera sees points [m], one a row."""
    seen = (np.asarray(points, float) - sensor['position']) @ axes_of(sensor).T
    return sensor['focal_length'] * seen[:, :2] / seen[:, 2:] + np.array(sensor['size']) / 2


def thread_end(sensor, image):
    """The upper right corner of the bright block in the camera's image, in the plane of the block's middle [m]."""
    rows, columns = np.nonzero(image > 130)
    top = rows < rows.min() + 30
    right = np.argmax(np.where(top, columns, 0))
    depth = -sensor['position'][1]
    offset = (np.array([columns[right], rows[right]]) - np.array(sensor['size']) / 2) * depth / sensor['focal_length']
    return [sensor['position'][0] + offset[0], 0.0, sensor['position'][2] - offset[1]]


def render_overview(root, folder, scene):
    """The image of a camera aslant above the set-up."""
    scene = dict(scene, simulation=dict(scene['simulation'], duration=0.02, sensors={TOPIC: OVERVIEW}))
    path, bag = os.path.join(folder, 'overview.yaml'), os.path.join(folder, 'overview.bag')
    with open(path, 'w') as file:
        yaml.safe_dump(scene, file)
    subprocess.run([os.path.join(root, 'scripts', 'run'), 'simulate', path, '--output', bag, '--quiet'], check=True)
    return images_at(bag, [0.0])[0]


def draw_line(axis, points, **style):
    seen = pixels(OVERVIEW, points)
    axis.plot(seen[:, 0], seen[:, 1], solid_capstyle='round', **style)
    return seen


def draw_camera(axis, sensor):
    """The camera as a pyramid, and the edges of what it sees of the block."""
    tip, rows = np.array(sensor['position']), axes_of(sensor)
    half = np.array(sensor['size']) / 2 / sensor['focal_length']
    for depth, width, alpha in ((0.07, 2.0, 1.0), (np.linalg.norm(np.subtract(sensor['target'], tip)), 0.8, 0.6)):
        corners = [tip + depth * (rows[2] + x * half[0] * rows[0] + y * half[1] * rows[1])
                   for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        draw_line(axis, corners + corners[:1], color='white', linewidth=width, alpha=alpha)
        for corner in corners:
            draw_line(axis, [tip, corner], color='white', linewidth=width, alpha=alpha)
    return pixels(OVERVIEW, [tip])[0]


def name(axis, text, at, shift):
    axis.annotate(text, at, (at[0] + shift[0], at[1] + shift[1]), color='white', fontsize=10,
                  arrowprops={'arrowstyle': '-', 'color': 'white', 'linewidth': 0.8})


def draw_setup(root, folder, path):
    times = (0.0, 0.5, 1.55)
    scene = read_yaml(os.path.join(folder, 'scene.yaml'))
    sensor = scene['simulation']['sensors'][TOPIC]
    images = images_at(os.path.join(folder, 'recording.bag'), times)
    figure, axes = plt.subplot_mosaic([['overview', 'first'], ['overview', 'second'], ['overview', 'third']], figsize=(9, 4.6),
                                      gridspec_kw={'width_ratios': [3.1, 1]})
    overview = axes['overview']
    overview.imshow(render_overview(root, folder, scene), cmap='gray', vmin=0, vmax=255)
    end = thread_end(sensor, images[0])
    seen = draw_line(overview, [end, [ROD, 0, end[2]], [ROD, 0, 0.03]], color='#e69f00', linewidth=1.8)
    draw_line(overview, [[ROD, -0.04, end[2]], [ROD, 0.04, end[2]]], color='#bbbbbb', linewidth=5)
    draw_line(overview, [[ROD, 0, 0.03], [ROD, 0, 0.012]], color='#e69f00', linewidth=13)
    draw_line(overview, [[x, y, 0] for x, y in FOOT], color='#bbbbbb', linewidth=5)
    name(overview, 'holder', pixels(OVERVIEW, [[-0.015, -0.015, 0]])[0], (-150, 70))
    name(overview, '20 g', pixels(OVERVIEW, [[ROD, 0, 0.02]])[0], (55, 40))
    name(overview, 'thread', (seen[0] + seen[1]) / 2, (-10, -60))
    name(overview, 'rod', pixels(OVERVIEW, [[ROD, -0.04, end[2]]])[0], (55, -40))
    name(overview, 'camera', draw_camera(overview, sensor), (-10, 90))
    name(overview, 'silicone', pixels(OVERVIEW, [[0, 0, 0.03]])[0], (-190, -60))
    overview.set_xlim(0, OVERVIEW['size'][0])
    overview.set_ylim(OVERVIEW['size'][1], 0)
    for key, time, image in zip(('first', 'second', 'third'), times, images):
        axes[key].imshow(image, cmap='gray', vmin=0, vmax=255)
        axes[key].set_title('camera, %.2f s' % time, color=INK, fontsize=9)
    for axis in axes.values():
        axis.axis('off')
    save(figure, path, 110)


def draw_result(folder, path):
    with open(os.path.join(folder, 'result', 'estimates.csv')) as table:
        rows = list(csv.DictReader(table))
    seconds = np.array([float(row['time [s]']) for row in rows])
    seconds -= seconds[0]
    mean, low, high = (np.array([float(row[MODULUS + '.%s [Pa]' % part]) for row in rows]) / 1e3
                       for part in ('mean', 'lower95', 'upper95'))
    figure, axis = plt.subplots(figsize=(9, 2.8))
    axis.fill_between(seconds, low, high, color=GOOD, alpha=0.25, linewidth=0, label='95 % interval')
    axis.plot(seconds, mean, color=GOOD, label='estimate')
    axis.axhline(truth_of(read_yaml(os.path.join(folder, 'scene.yaml'))) / 1e3, color=FLOOR, linestyle='--', linewidth=1, label='truth')
    axis.set_ylim(0, 300)
    axis.set_ylabel('E [kPa]', color=INK, fontsize=9)
    axis.set_xlabel('time [s]', color=INK, fontsize=9)
    axis.legend(frameon=False, fontsize=9)
    clean(axis)
    save(figure, path, 110)


def main():
    root = sys.argv[1]
    recipe = os.path.join(root, 'silicone')
    if not os.path.exists(os.path.join(recipe, 'result', 'estimates.csv')):
        sys.exit('draw_figures: no silicone/result/estimates.csv; follow doc/recipe.md first')
    draw_setup(root, recipe, os.path.join(root, 'doc', 'recipe_setup.png'))
    draw_result(recipe, os.path.join(root, 'doc', 'recipe_result.png'))


if __name__ == '__main__':
    main()
