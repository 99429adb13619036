"""A real echo cine (outlines, area, long axis, relative stiffness) and real cine MRI against experts' points."""
import os
import subprocess

import cv2
import numpy as np
import rosbag

from common import Workshop, publish, table
from figures import plt, save
from filling import relative_stiffness

SEED = (200, 110)    # pixel, in the ventricle of the first frame
ZOOM, HALF = 5, 32   # the MRI's region of interest: this many times larger, so many pixels to each side
MIDDLE = (130, 105)  # pixel, of that region
SERIES, SLICE = 'Se4', '5'  # the one series whose plane the guide points hold
REPEAT = 0.5         # grey values: mean difference below which a frame repeats the last
DECIMAL = 1e3        # mm a metre


def outlines(work, kind, images, seed):
    """Outline (n x 3: u, v, sigma) of each image, None where none was found."""
    program = os.path.join(work.tools, 'outlines')
    command = [program, kind, '--seed', '%g' % seed[0], '%g' % seed[1], '--images'] + images
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, check=True)
    rows = np.array([[float(word) for word in line.split(',')] for line in done.stdout.splitlines()[1:]])
    return [rows[rows[:, 0] == k, 1:] if (rows[:, 0] == k).any() else None for k in range(len(images))]


def smooth(outline, harmonics=12):
    """The closed curve's low Fourier descriptors, 200 points: for drawing and for the long axis."""
    closed = np.vstack([outline[:, :2], outline[:1, :2]])
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    even = np.linspace(0.0, length[-1], 200, endpoint=False)
    curve = np.interp(even, length, closed[:, 0]) + 1j * np.interp(even, length, closed[:, 1])
    spectrum = np.fft.fft(curve)
    spectrum[harmonics + 1:-harmonics] = 0.0
    curve = np.fft.ifft(spectrum)
    return np.stack([curve.real, curve.imag], axis=1)


def area(points):
    x, y = points[:, 0], points[:, 1]
    return 0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def long_axis(points):
    """Middle of the base and apex: where the main axis of the enclosed area meets the outline."""
    mask = np.zeros((480, 640), np.uint8)
    cv2.fillPoly(mask, [np.round(points).astype(np.int32)], 1)
    moments = cv2.moments(mask, True)
    centre = np.array([moments['m10'], moments['m01']]) / moments['m00']
    angle = 0.5 * np.arctan2(2 * moments['mu11'], moments['mu20'] - moments['mu02'])
    along = np.array([np.cos(angle), np.sin(angle)])
    along = along if along[1] > 0 else -along  # towards the base, which is below
    away = points - centre
    across = np.abs(away @ [-along[1], along[0]])
    ends = [centre + along * sign * (sign * away @ along)[(across < 4.0) & (sign * away @ along > 0)].max() for sign in (1, -1)]
    return ends[0], ends[1]


def read_cine(work, bag):
    """Paths of the frames, their times [s], pixels a metre, and which are no repeats."""
    paths, times, scale, usable, last = [], [], None, [], None
    with rosbag.Bag(bag) as file:
        for topic, message, _ in file.read_messages():
            if topic.endswith('camera_info'):
                scale = message.K[0]
                continue
            image = np.frombuffer(message.data, np.uint8).reshape(message.height, message.step)[:, :message.width]
            paths.append(work.path('frame_%02d.png' % len(paths)))
            cv2.imwrite(paths[-1], image)
            times.append(message.header.stamp.to_sec())
            usable.append(last is None or np.abs(image.astype(float) - last).mean() > REPEAT)
            last = image.astype(float)
    return paths, np.array(times) - times[0], scale, usable


def contact_sheet(path, images, curves, labels, columns, zoom, box, colours, gain=1.0):
    """Frames side by side with curves drawn on them."""
    tiles = []
    for name, drawn, label in zip(images, curves, labels):
        image = cv2.imread(name)[box[1]:box[3], box[0]:box[2]]
        tile = cv2.resize(image, None, fx=zoom, fy=zoom, interpolation=cv2.INTER_CUBIC)
        tile = np.clip(gain * tile.astype(float), 0, 255).astype(np.uint8)
        for points, colour in zip(drawn, colours):
            shown = np.round(((points - box[:2] + 0.5) * zoom - 0.5) * 16).astype(np.int32)
            cv2.polylines(tile, [shown.reshape(-1, 1, 2)], True, colour, 1, cv2.LINE_AA, 4)
        cv2.putText(tile, label, (6, tile.shape[0] - 8), cv2.FONT_HERSHEY_SIMPLEX, 0.45, (160, 160, 160), 1, cv2.LINE_AA)
        tiles.append(tile)
    tiles += [np.zeros_like(tiles[0])] * (-len(tiles) % columns)
    sheet = np.vstack([np.hstack(tiles[i:i + columns]) for i in range(0, len(tiles), columns)])
    cv2.imwrite(path, sheet, [cv2.IMWRITE_JPEG_QUALITY, 80])


def curves_picture(path, times, areas, lengths):
    figure, axes = plt.subplots(1, 2, figsize=(8.5, 2.8))
    for axis, values, name in zip(axes, (areas, lengths), ('area [cm²]', 'long axis [mm]')):
        axis.plot(1e3 * np.array(times), values, 'o-', ms=3, color='#1f5fa8')
        axis.set_xlabel('time [ms]')
        axis.set_ylabel(name)
        axis.set_ylim(bottom=0)
    save(figure, path, bare=axes)


def echo_cine(work, shared):
    bag = os.path.join(shared, 'data', 'echo_a4c', 'recording.bag')
    paths, times, scale, usable = read_cine(work, bag)
    found = outlines(work, 'cavity', paths, SEED)
    kept = [k for k in range(len(paths)) if usable[k] and found[k] is not None]
    curves = {k: smooth(found[k]) for k in kept}
    areas = [1e4 * area(curves[k]) / scale**2 for k in kept]
    axes = [long_axis(curves[k]) for k in kept]
    lengths = [DECIMAL * np.linalg.norm(base - apex) / scale for base, apex in axes]
    work.progress('echo: outlines in %d of %d usable frames' % (len(kept), sum(usable)))
    pictures = os.path.join(work.root, 'doc', 'paper')
    curves_picture(os.path.join(pictures, 'echo_curves.png'), times[kept], areas, lengths)
    shown = kept[::max(1, len(kept) // 12)][:12]
    contact_sheet(os.path.join(pictures, 'echo_outlines.jpg'), [paths[k] for k in shown], [[curves[k]] for k in shown],
                  ['%.0f ms' % (1e3 * times[k]) for k in shown], 4, 2, (110, 20, 280, 180), [(120, 255, 120)], 1.5)
    largest, smallest = max(areas), min(areas)
    text = table(['figure', 'value'], [
        ['frames with an outline, of those that are no repeats', '%d of %d' % (len(kept), sum(usable))],
        ['area, largest and smallest', '%.1f and %.1f cm²: fractional area change %.0f %%' %
         (largest, smallest, 100 * (1 - smallest / largest))],
        ['long axis, largest and smallest', '%.0f and %.0f mm' % (max(lengths), min(lengths))],
        ['median change of the area between frames', '%.1f %%' % (100 * np.median(np.abs(np.diff(areas)) / areas[1:]))],
        ['part of the outlines with a wall to be seen', '%.0f %%' %
         (100 * np.mean(np.concatenate([np.isfinite(found[k][:, 2]) for k in kept])))]])
    publish(work.root, 'echo', text)
    return paths, times, scale, kept, curves, axes


def guide_points(shared, frame, frame_of):
    """The experts' points of the left ventricle's endocardium in the slice [pixel], in order around it."""
    import csv
    with open(os.path.join(shared, 'data', 'heart_bivme', 'guidepoints', 'GPFile_%03d.txt' % frame)) as file:
        rows = [row for row in csv.DictReader(file, delimiter='\t')
                if row['contour type'] == 'SAX_LV_ENDOCARDIAL' and row['frameID'] == SLICE]
    points = frame_of(np.array([[float(row[axis]) for axis in 'xyz'] for row in rows]))
    away = points - points.mean(axis=0)
    return points[np.argsort(np.arctan2(away[:, 1], away[:, 0]))]


def read_mri(work, shared):
    """Paths of the inverted, enlarged region in every phase, and the map from the scanner's frame to its pixels."""
    import glob
    import pydicom
    names = glob.glob(os.path.join(shared, 'data', 'heart_bivme', 'cine_mri', SERIES, '*.dcm'))
    slices = [pydicom.dcmread(name) for name in names]
    slices.sort(key=lambda image: float(image.TriggerTime))
    head = slices[0]
    corner = np.array(head.ImagePositionPatient, float)
    directions = np.array(head.ImageOrientationPatient, float).reshape(2, 3)
    size = float(head.PixelSpacing[0])
    white = np.percentile(head.pixel_array, 99.5)
    left, top = MIDDLE[0] - HALF, MIDDLE[1] - HALF
    paths = []
    for k, image in enumerate(slices):
        grey = np.clip(255.0 * image.pixel_array / white, 0, 255).astype(np.uint8)[top:top + 2 * HALF, left:left + 2 * HALF]
        paths.append(work.path('mri_%02d.png' % k))
        cv2.imwrite(paths[-1], 255 - cv2.resize(grey, None, fx=ZOOM, fy=ZOOM, interpolation=cv2.INTER_CUBIC))

    def to_pixels(points):
        return ((points - corner) @ directions.T / size - [left, top] + 0.5) * ZOOM - 0.5
    return paths, to_pixels, size / ZOOM


def compare(ours, theirs):
    """Mean distance between two closed curves, both ways [pixel], and Dice's overlap of what they enclose."""
    def dense(points):
        closed = np.vstack([points, points[:1]])
        steps = np.linspace(0, 1, 20, endpoint=False)[:, None]
        return np.concatenate([a + (b - a) * steps for a, b in zip(closed, closed[1:])])
    a, b = dense(ours), dense(theirs)
    gaps = np.linalg.norm(a[:, None] - b[None], axis=2)
    masks = []
    for points in (ours, theirs):
        mask = np.zeros((2 * HALF * ZOOM,) * 2, np.uint8)
        cv2.fillPoly(mask, [np.round(points).astype(np.int32)], 1)
        masks.append(mask.astype(bool))
    apart = 0.5 * (gaps.min(axis=0).mean() + gaps.min(axis=1).mean())
    return apart, 2 * (masks[0] & masks[1]).sum() / sum(m.sum() for m in masks)


def cine_mri(work, shared):
    try:
        paths, to_pixels, size = read_mri(work, shared)
    except ImportError:
        print('The cine MRI is skipped: there is no pydicom (Debian: python3-pydicom)')
        return
    found = outlines(work, 'cavity', paths, (HALF * ZOOM, HALF * ZOOM))
    kept = [k for k in range(len(paths)) if found[k] is not None]
    ours = {k: smooth(found[k]) for k in kept}
    theirs = {k: guide_points(shared, k, to_pixels) for k in kept}
    figures = np.array([compare(ours[k], theirs[k]) for k in kept])
    work.progress('MRI: outlines in %d of %d phases' % (len(kept), len(paths)))
    shown = kept[::max(1, len(kept) // 8)][:8]
    contact_sheet(os.path.join(work.root, 'doc', 'paper', 'mri_outlines.jpg'), [paths[k] for k in shown],
                  [[theirs[k], ours[k]] for k in shown], ['phase %d' % k for k in shown], 4, 0.75, (0, 0, 320, 320),
                  [(0, 0, 230), (0, 150, 0)])
    apart, dice = size * figures[:, 0], figures[:, 1]
    sizes = [size**2 * np.array([area(ours[k]), area(theirs[k])]) / 100 for k in kept]
    publish(work.root, 'mri', table(['figure', 'median', 'worst', 'best'], [
        ['mean distance of the outlines [mm]', '%.2f' % np.median(apart), '%.2f' % apart.max(), '%.2f' % apart.min()],
        ['Dice', '%.3f' % np.median(dice), '%.3f' % dice.min(), '%.3f' % dice.max()]]) +
            '\nOutlines were found in %d of %d phases. The end-diastolic area is %.1f cm² in ours and %.1f cm² in theirs. '
            'At end systole\nit is %.1f and %.1f cm².\n' %
            (len(kept), len(paths), sizes[0][0], sizes[0][1], min(s[0] for s in sizes), min(s[1] for s in sizes)))


def main(place):
    work = Workshop(place, 4, 'echo')
    if not os.path.isdir(os.path.join(place.shared, 'data')):
        print('Echo and MRI are skipped: there is no ' + os.path.join(place.shared, 'data'))
        return
    relative_stiffness(work, echo_cine(work, place.shared))
    cine_mri(work, place.shared)
