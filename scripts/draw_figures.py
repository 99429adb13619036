"""The README's picture of the error falling: see scripts/draw_figures."""
import json
import os
import sys

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


def main():
    root = sys.argv[1]
    source = os.path.join(root, 'output', 'demo', 'diagnosis.json')
    if not os.path.exists(source):
        sys.exit('draw_figures: no %s; run scripts/demo first' % os.path.relpath(source, root))
    with open(source) as file:
        diagnosis = json.load(file)
    with open(os.path.join(root, 'config', 'demo', 'scene.yaml')) as file:
        effects = yaml.safe_load(file)['effects']
    truth = next(float(effect['elasticity']['young_modulus']) for effect in effects if 'elasticity' in effect)
    draw(diagnosis, truth, os.path.join(root, 'doc', 'error_falling.png'))


if __name__ == '__main__':
    main()
