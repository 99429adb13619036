"""The picture of the recipe: see scripts/draw_figures."""
import csv
import os
import sys

import numpy as np
import yaml

from figures import plt, save

INK, GOOD, FLOOR = '#333333', '#2c7fb8', '#999999'
MODULUS = 'elasticity.young_modulus'


def clean(axis):
    for side in ('top', 'right', 'left'):
        axis.spines[side].set_visible(False)
    axis.tick_params(length=0)


def truth_of(scene):
    with open(scene) as file:
        effects = yaml.safe_load(file)['effects']
    return next(float(effect['elasticity']['young_modulus']) for effect in effects if 'elasticity' in effect)


def images_at(bag, topic, seconds):
    """The image of a recording at each of these times after its first one."""
    import rosbag  # only this picture needs it
    with rosbag.Bag(bag) as file:
        messages = [message for _, message, _ in file.read_messages(topics=[topic])]
    stamps = np.array([message.header.stamp.to_sec() for message in messages])
    out = []
    for time in seconds:
        message = messages[int(np.argmin(abs(stamps - stamps[0] - time)))]
        out.append(np.frombuffer(message.data, np.uint8).reshape(message.height, message.width, -1))
    return out


def draw_recipe(folder, path):
    times = (0.0, 0.5, 1.55)
    with open(os.path.join(folder, 'second', 'estimates.csv')) as file:
        rows = list(csv.DictReader(file))
    stamp = np.array([float(row['time [s]']) for row in rows])
    mean, low, high = (np.array([float(row[MODULUS + '.%s [Pa]' % name]) for row in rows]) / 1e3
                       for name in ('mean', 'lower95', 'upper95'))
    figure, axes = plt.subplots(1, 4, figsize=(11, 2.8), gridspec_kw={'width_ratios': [1, 1, 1, 1.6]})
    for axis, time, image in zip(axes, times, images_at(os.path.join(folder, 'recording.bag'), '/camera/image_raw', times)):
        axis.imshow(image.squeeze(), cmap='gray')
        axis.set_title('%.2f s' % time, color=INK, fontsize=10)
        axis.axis('off')
    plot, seconds = axes[-1], stamp - stamp[0]
    plot.fill_between(seconds, low, high, color=GOOD, alpha=0.25, linewidth=0)
    plot.plot(seconds, mean, color=GOOD)
    plot.axhline(truth_of(os.path.join(folder, 'scene.yaml')) / 1e3, color=FLOOR, linestyle='--', linewidth=1)
    plot.set_ylim(0, 300)
    plot.set_title("Young's modulus [kPa], 95 % interval, truth dashed", color=INK, fontsize=10)
    plot.set_xlabel('time [s]', color=INK, fontsize=9)
    clean(plot)
    save(figure, path, 110)


def main():
    root = sys.argv[1]
    recipe = os.path.join(root, 'silicone')
    if not os.path.exists(os.path.join(recipe, 'second', 'estimates.csv')):
        sys.exit('draw_figures: no silicone/second/estimates.csv; follow doc/tutorials/silicone_block.md first')
    draw_recipe(recipe, os.path.join(root, 'doc', 'tutorials', 'silicone_block.png'))


if __name__ == '__main__':
    main()
