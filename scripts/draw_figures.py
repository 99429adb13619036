"""The README's picture of the error falling, and that of the recipe: see scripts/draw_figures."""
import csv
import json
import os
import sys

import numpy as np
import yaml

from figures import plt, save

INK, ERROR, GOOD, FLOOR = '#333333', '#c8664f', '#2c7fb8', '#999999'
MODULUS = 'elasticity.young_modulus'


def label(step):
    return 'as given' if not step['effects'] else '+ ' + step['effects'][-1].replace('_', ' ')


def clean(axis):
    for side in ('top', 'right', 'left'):
        axis.spines[side].set_visible(False)
    axis.tick_params(length=0)


def draw(diagnosis, truth, path):
    steps = diagnosis['steps']
    names = [label(step) for step in steps]
    colours = [ERROR] * (len(steps) - 1) + [GOOD]
    figure, (error, modulus, where) = plt.subplots(1, 3, figsize=(10, 3.1), gridspec_kw={'width_ratios': [1, 1, 1.4]})
    held_out = [1e3 * step['held_out_rms'] for step in steps]
    error.bar(names, held_out, color=colours, width=0.55)
    for i, value in enumerate(held_out):
        error.text(i, value, '%.2f mm' % value, ha='center', va='bottom', color=INK)
    error.axhline(1e3 * steps[-1]['noise_floor'], color=FLOOR, linestyle='--', linewidth=1)
    error.text(0.5, 1e3 * steps[-1]['noise_floor'], 'noise', color=INK, ha='center', va='bottom', fontsize=8)
    error.set_title('error on frames no fit saw', color=INK, fontsize=10)
    error.set_yticks([])
    values = [step['parameters'][MODULUS] / 1e3 for step in steps]
    modulus.bar(names, values, color=colours, width=0.55)
    for i, value in enumerate(values):
        modulus.text(i, value, '%.1f kPa' % value, ha='center', va='bottom', color=INK)
    modulus.axhline(truth / 1e3, color=FLOOR, linestyle='--', linewidth=1)
    modulus.text(0.5, truth / 1e3, 'truth', color=INK, ha='center', va='bottom', fontsize=8)
    modulus.set_title("Young's modulus", color=INK, fontsize=10)
    modulus.set_yticks([])
    best = [c for c in diagnosis['candidates'] if c['held_out_rms_after'] is not None][::-1]
    where.barh([c['effect'].replace('_', ' ') for c in best], [max(0.0, 100 * c['explained']) for c in best], height=0.55,
               color=[GOOD if c['effect'] in diagnosis['set'] else FLOOR for c in best])
    where.set_title('of the squared error it would remove [%]', color=INK, fontsize=10)
    where.set_xlim(0, 100)
    for axis in (error, modulus, where):
        clean(axis)
    save(figure, path, 110)


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
    if os.path.exists(os.path.join(recipe, 'second', 'estimates.csv')):
        draw_recipe(recipe, os.path.join(root, 'doc', 'tutorials', 'silicone_block.png'))
    else:
        print('draw_figures: left out the recipe; follow doc/tutorials/silicone_block.md first', file=sys.stderr)
    source = os.path.join(root, 'output', 'demo', 'diagnosis.json')
    if not os.path.exists(source):
        sys.exit('draw_figures: no %s; run scripts/demo first' % os.path.relpath(source, root))
    with open(source) as file:
        diagnosis = json.load(file)
    draw(diagnosis, truth_of(os.path.join(root, 'config', 'demo', 'scene.yaml')), os.path.join(root, 'doc', 'error_falling.png'))


if __name__ == '__main__':
    main()
