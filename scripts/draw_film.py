"""The README's film: see scripts/draw_film. Every number in it is read from what the tools wrote."""
import base64
import csv
import io
import json
import os
import re
import sys

import numpy as np
import yaml
from matplotlib.colors import LinearSegmentedColormap
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from PIL import Image

from figures import plt

RATE = 10                      # pictures a second
PLAYED, TOLD, HELD = 32, 24, 26  # pictures of a replay, of the diagnosis, of the end
COLOURS = 112                  # of the film's palette
MAGNIFIED = 2                  # the motion
LARGEST = 2e6                  # [byte] of the film
INK, SOFT, GOOD, ERROR, GIVEN = '#17202b', '#5b6675', '#1f6fb5', '#b3366b', '#d9730d'
MODULUS = 'elasticity.young_modulus'
MISFIT = LinearSegmentedColormap.from_list('misfit', ['#3b6fb6', '#6fb7c9', '#f4e8a4', '#f0904a', '#b5172f'])  # the page's


def words(effect):
    return effect.split(' ')[0].replace('_', ' ')


def shorts(coded):
    numbers = np.frombuffer(base64.b64decode(coded['data']), '<i2').astype(float)
    return np.where(numbers == -32768, np.nan, coded['offset'] + coded['scale'] * numbers)


def shades(coded):
    numbers = np.frombuffer(base64.b64decode(coded['data']), np.uint8).astype(float)
    return np.where(numbers == 255, np.nan, coded['most'] * (numbers / 254) ** 2)


class Replay:
    """A model's run as the report of `diagnose` holds it: the surface over time, and its error [mm]."""

    def __init__(self, coded):
        surface = coded['surface']
        self.time = np.array(coded['time'])[surface['frames']]
        self.rest = shorts(surface['rest']).reshape(-1, 3)
        self.triangles = np.frombuffer(base64.b64decode(surface['triangles']), '<u2').reshape(-1, 3)
        self.displacement = shorts(surface['displacement']).reshape(len(self.time), -1, 3)
        self.error = 1e3 * self.fill(shades(surface['error']).reshape(len(self.time), -1))

    def fill(self, error):
        """A vertex that was never measured takes the error of the nearest that was."""
        measured = np.flatnonzero(np.isfinite(error).any(axis=0))
        distance = np.linalg.norm(self.rest[:, None] - self.rest[None, measured], axis=2)
        return np.nan_to_num(error[:, measured[distance.argmin(axis=1)]])

    def at(self, time):
        """Positions [mm], and the error of each triangle."""
        k = int(np.abs(self.time - time).argmin())
        return 1e3 * (self.rest + MAGNIFIED * self.displacement[k]), self.error[k][self.triangles].mean(axis=1)


def replays_of(report):
    with open(report) as file:
        data = re.search(r'<script type="application/json" id="data">(.*?)</script>', file.read(), re.S).group(1)
    return [Replay(coded) for coded in json.loads(data)['showing']['replays']]


def course_of(folder):
    """Times since the first frame [s], and mean and interval of E [kPa]."""
    with open(os.path.join(folder, 'estimates.csv')) as file:
        rows = [row for row in csv.DictReader(file) if row[MODULUS + '.mean [Pa]']]
    time = np.array([float(row['time [s]']) for row in rows])
    return time - time[0], [np.array([float(row['%s.%s [Pa]' % (MODULUS, name)]) for row in rows]) / 1e3
                            for name in ('mean', 'lower95', 'upper95')]


def forces_of(bag, topic):
    """Times since the first message [s], and the tool's force [N]."""
    import rosbag
    with rosbag.Bag(bag) as file:
        messages = [message for _, message, _ in file.read_messages(topics=[topic])]
    time = np.array([message.header.stamp.to_sec() for message in messages])
    return time - time[0], np.array([[m.wrench.force.x, m.wrench.force.y, m.wrench.force.z] for m in messages])


def with_white(picture):
    """What is nearly white in the palette becomes white."""
    colours = np.array(picture.getpalette()).reshape(-1, 3)
    colours[colours.min(axis=1) > 243] = 255
    white = Image.new('P', picture.size)
    white.putpalette(colours.ravel().tolist())
    return white


class Story:
    def __init__(self, work, demo):
        with open(os.path.join(work, 'diagnosis', 'diagnosis.json')) as file:
            self.diagnosis = json.load(file)
        if len(self.diagnosis['steps']) < 2:
            sys.exit('draw_film: the diagnosis added no effect')
        replays = replays_of(os.path.join(work, 'diagnosis', 'report.html'))
        self.given, self.last = replays[0], replays[-1]
        self.courses = [course_of(os.path.join(work, name)) for name in ('given', 'next')]
        self.force = forces_of(os.path.join(demo, 'recording.bag'), '/tool/wrench')
        with open(os.path.join(demo, 'scene.yaml')) as file:
            scene = yaml.safe_load(file)
        self.truth = next(float(e['elasticity']['young_modulus']) for e in scene['effects'] if 'elasticity' in e) / 1e3
        box = scene['regions']['tool']['box']
        inside = ((self.given.rest >= box['min']) & (self.given.rest <= box['max'])).all(axis=1)
        self.tool = np.flatnonzero(inside)
        self.most = np.quantile(self.given.error, 0.98)
        self.states = []
        for name in ('given', 'next'):
            with open(os.path.join(work, name, 'results.json')) as file:
                self.states.append(json.load(file)['state'].replace('_', ' '))

    @property
    def added(self):
        return ' and '.join(words(effect) for effect in self.diagnosis['steps'][-1]['effects'])


class Film:
    def __init__(self, story):
        self.story = story
        self.pictures = []

    def canvas(self, title):
        figure = plt.figure(figsize=(9, 5), dpi=100)
        figure.text(0.025, 0.94, title, color=INK, fontsize=15, weight='bold')
        return figure

    def tissue(self, figure, replay, time, name):
        axis = figure.add_axes([-0.03, 0.09, 0.55, 0.84], projection='3d', computed_zorder=False)
        points, error = replay.at(time)
        corners = points[replay.triangles]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
        light = 0.78 + 0.22 * normal @ (np.array([0.3, -0.7, 0.65]) / np.linalg.norm([0.3, -0.7, 0.65]))
        colours = MISFIT(np.clip(error / self.story.most, 0, 1))
        colours[:, :3] *= light[:, None]
        axis.add_collection3d(Poly3DCollection(corners, facecolors=colours, edgecolors=colours, linewidths=0.4))
        self.arrow(axis, points, time)
        low, high = 1e3 * replay.rest.min(axis=0), 1e3 * replay.rest.max(axis=0)
        axis.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2] + 14))
        axis.set_box_aspect(high + [0, 0, 14] - low, zoom=1.04)
        axis.view_init(22, -58)
        axis.set_axis_off()
        figure.text(0.025, 0.885, name, color=SOFT, fontsize=11)
        self.scale(figure)

    def arrow(self, axis, points, time):
        stamps, force = self.story.force
        now = force[int(np.abs(stamps - time).argmin())]
        length = 16 * now / np.abs(force).max()
        tip = points[self.story.tool].mean(axis=0) + [0, 0, 1]
        if np.linalg.norm(length) > 1:
            axis.quiver(*(tip - length), *length, color=INK, linewidth=2.5, arrow_length_ratio=0.3, zorder=10)
        axis.text(*(tip + [0, 0, 15]), '%.1f N' % np.linalg.norm(now), color=INK, fontsize=10, ha='center', zorder=10)

    def scale(self, figure):
        axis = figure.add_axes([0.06, 0.07, 0.3, 0.022])
        axis.imshow(np.linspace(0, 1, 64)[None], aspect='auto', cmap=MISFIT, extent=(0, self.story.most, 0, 1))
        axis.set_yticks([])
        axis.tick_params(length=2, labelsize=8, colors=SOFT)
        axis.set_title('error on the surface [mm]; motion shown ×%d' % MAGNIFIED, fontsize=8.5, color=SOFT, pad=3)
        for side in axis.spines.values():
            side.set_visible(False)

    def modulus(self, figure, until):
        """`until`: of each course, the time up to which it is shown; none is hidden."""
        axis = figure.add_axes([0.56, 0.52, 0.41, 0.34])
        for (time, (mean, low, high)), end, colour, state in zip(self.story.courses, until, (GIVEN, GOOD), self.story.states):
            shown = time <= end
            if not shown.any():
                continue
            axis.fill_between(time[shown], low[shown], high[shown], color=colour, alpha=0.25, linewidth=0)
            axis.plot(time[shown], mean[shown], color=colour, linewidth=2)
            text = '%.1f kPa' % mean[shown][-1] + ('\n' + state if end >= time[-1] else '')
            axis.text(time[shown][-1] + 0.05, mean[shown][-1], text, color=colour, fontsize=11, weight='bold', va='center',
                      bbox={'facecolor': 'white', 'edgecolor': 'none', 'pad': 0.5})
        axis.plot([0, 3], 2 * [self.story.truth], color=SOFT, linestyle='--', linewidth=1, zorder=1)
        axis.text(1.5, self.story.truth - 2.6, 'truth: %.0f kPa' % self.story.truth, color=SOFT, fontsize=9, va='top')
        axis.set(xlim=(0, 4.4), ylim=(0, 36), xticks=(0, 1, 2, 3), yticks=(0, 10, 20, 30))
        axis.set_xlabel('time [s]', color=SOFT, fontsize=9, labelpad=0, loc='left')
        axis.set_title("Young's modulus [kPa] with its 95 % interval", color=INK, fontsize=10.5, loc='left')
        self.clean(axis)

    def error(self, figure, share):
        """`share` of the way from the given model's error to that with the effect; None: the given model's alone."""
        axis = figure.add_axes([0.56, 0.09, 0.41, 0.3])
        steps = self.story.diagnosis['steps']
        first, last = 1e3 * steps[0]['held_out_rms'], 1e3 * steps[-1]['held_out_rms']
        noise = 1e3 * steps[-1]['noise_floor']
        values = [first] if share is None else [first, first + share * (last - first)]
        axis.barh(range(len(values)), values, height=0.55, color=[GIVEN, GOOD][:len(values)])
        for k, value in enumerate(values):
            axis.text(value + 0.01 * first, k, '%.2f mm' % value, va='center', color=INK, fontsize=11)
        axis.axvline(noise, color=SOFT, linestyle='--', linewidth=1)
        axis.text(noise, -0.52, ' noise', color=SOFT, fontsize=9, va='center')
        axis.set(xlim=(0, 1.2 * first), ylim=(1.5, -0.7), xticks=())
        axis.set_yticks([0, 1])
        axis.set_yticklabels(['as given', '' if share is None else '+ ' + self.story.added.replace(' ', '\n')])
        axis.set_title('error on frames that no fit saw', color=INK, fontsize=10.5, loc='left')
        self.clean(axis)
        axis.spines['bottom'].set_visible(False)

    def ranking(self, figure, share):
        axis = figure.add_axes([0.70, 0.09, 0.25, 0.3])
        tried = [c for c in self.story.diagnosis['candidates'] if c['held_out_rms_after'] is not None][:4]
        values = [max(0.0, 100 * c['explained']) for c in tried]
        chosen = self.story.diagnosis['steps'][-1]['effects']
        axis.barh(range(len(tried)), [share * v for v in values], height=0.6,
                  color=[GOOD if c['effect'] in chosen else '#aab2bd' for c in tried])
        for k, value in enumerate(values):
            if share >= 1:
                axis.text(value + 2, k, '%.0f %%' % value, va='center', color=INK, fontsize=10)
        axis.set(xlim=(0, 118), ylim=(len(tried) - 0.4, -0.6), xticks=())
        axis.set_yticks(range(len(tried)))
        axis.set_yticklabels([words(c['effect']) for c in tried])
        figure.text(0.56, 0.405, 'squared error that each effect would remove', color=INK, fontsize=10.5)
        self.clean(axis)
        axis.spines['bottom'].set_visible(False)

    @staticmethod
    def clean(axis):
        for side in ('top', 'right', 'left'):
            axis.spines[side].set_visible(False)
        axis.tick_params(length=0, labelsize=9.5, colors=SOFT)

    def add(self, figure):
        buffer = io.BytesIO()
        figure.savefig(buffer, format='png', facecolor='white')
        plt.close(figure)
        self.pictures.append(Image.open(buffer).convert('RGB'))

    def estimate(self):
        for time in np.linspace(0, 3, PLAYED):
            figure = self.canvas('1  estimate: the model as given')
            self.tissue(figure, self.story.given, time, 'the model runs along with the recording')
            self.modulus(figure, (time, -1))
            self.add(figure)

    def diagnose(self):
        for k in range(TOLD):
            figure = self.canvas('2  diagnose: what does the model miss?')
            self.tissue(figure, self.story.given, 3 * k / TOLD, 'model and recording disagree')
            self.modulus(figure, (3.1, -1))
            self.ranking(figure, min(1.0, k / 8))
            self.add(figure)

    def estimate_again(self):
        for k, time in enumerate(np.linspace(0, 3, PLAYED)):
            figure = self.canvas('3  add %s, estimate again: the error falls' % self.story.added)
            self.tissue(figure, self.story.last, time, 'with ' + self.story.added)
            self.modulus(figure, (3.1, time))
            self.error(figure, min(1.0, k / 16))
            self.add(figure)

    def hold(self):
        self.pictures += [self.pictures[-1]] * HELD

    def save(self, path):
        """One palette for all pictures, so that what stands still costs nothing."""
        chosen = self.pictures[::6] + self.pictures[-1:]
        sheet = Image.new('RGB', (chosen[0].width, chosen[0].height * len(chosen)))
        for k, picture in enumerate(chosen):
            sheet.paste(picture, (0, k * picture.height))
        palette = with_white(sheet.quantize(COLOURS, kmeans=2))
        frames = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in self.pictures]
        frames[0].save(path, save_all=True, append_images=frames[1:], duration=1000 // RATE, loop=0, optimize=False)
        size = os.path.getsize(path)
        print('%s: %d pictures, %.2f MB' % (path, len(frames), size / 1e6))
        if size > LARGEST:
            sys.exit('draw_film: the film is larger than %.0f MB' % (LARGEST / 1e6))


def main():
    work, demo, path = sys.argv[1:]
    film = Film(Story(work, demo))
    film.estimate()
    film.diagnose()
    film.estimate_again()
    film.hold()
    film.save(path)


if __name__ == '__main__':
    main()
