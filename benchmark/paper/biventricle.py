"""An idealised heart: the muscle of both ventricles below the valves, as one closed surface.

A truncated ellipsoid is the left ventricle; the right one is a lens of blood that lies on it, under a thin wall. The valves'
plane is z = 0, the apex points down. In every direction from the middle of that plane each surface is met once."""
import numpy as np
from scipy.spatial import Delaunay

INNER, OUTER = np.array([0.025, 0.075]), np.array([0.035, 0.085])  # half axes of the left ventricle: across, along [m]
HALF_WIDTH, HALF_HEIGHT = 1.3, 1.05  # of the right ventricle as seen from the middle [rad]
DEPTH, WALL = 0.026, 0.004  # of the right ventricle's blood, and of the wall around it [m]
LIFT = 0.15  # part of the depth by which the lens's rim stands off the septum
RIM = 1.15  # the wall reaches so much farther than the blood
FILLET = 0.004  # of the groove between the ventricles [m]


def ellipsoid(axes, polar):
    return 1.0 / np.sqrt((np.sin(polar) / axes[0])**2 + (np.cos(polar) / axes[1])**2)


def within(azimuth, polar):
    """0 in the middle of the right ventricle's base, 1 at its rim."""
    return np.hypot(azimuth / HALF_WIDTH, (np.pi / 2 - polar) / HALF_HEIGHT)


def epicardium(azimuth, polar):
    height = (DEPTH + WALL) * (1.0 - (within(azimuth, polar) / RIM)**4)
    return ellipsoid(OUTER, polar) + 0.5 * (height + np.hypot(height, FILLET))


def right(azimuth, polar, side):
    """The septum's side (-1) and the free wall's (+1) of the right ventricle."""
    bow = np.sqrt(np.maximum(0.0, 1.0 - within(azimuth, polar)**2))
    return ellipsoid(OUTER, polar) + DEPTH * (LIFT + (1.0 - LIFT if side > 0 else -LIFT) * bow)


def place(radius, azimuth, polar):
    return np.stack([radius * np.sin(polar) * np.cos(azimuth), radius * np.sin(polar) * np.sin(azimuth),
                     -radius * np.cos(polar)], axis=-1)


def cap(axes, radius, edge):
    """A sheet over all directions: rings along the ellipsoid's meridian, `edge` apart."""
    fine = np.linspace(0.0, np.pi / 2, 2001)
    meridian = ellipsoid(axes, fine)[:, None] * np.stack([np.sin(fine), -np.cos(fine)], axis=1)
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(meridian, axis=0), axis=1))])
    rings = max(3, int(round(length[-1] / edge)))
    flat, polar, azimuth = [np.zeros((1, 2))], [np.zeros(1)], [np.zeros(1)]
    for i in range(1, rings + 1):
        at = np.interp(length[-1] * i / rings, length, fine)
        count = max(6, int(round(2 * np.pi * radius(np.linspace(-np.pi, np.pi, 90), at).mean() * np.sin(at) / edge)))
        around = 2 * np.pi * (np.arange(count) + 0.5 * (i % 2)) / count
        around = (around + np.pi) % (2 * np.pi) - np.pi
        flat.append(i / rings * np.stack([np.cos(around), np.sin(around)], axis=1))
        polar.append(np.full(count, at))
        azimuth.append(around)
    azimuth, polar = np.concatenate(azimuth), np.concatenate(polar)
    return place(radius(azimuth, polar), azimuth, polar), Delaunay(np.concatenate(flat)).simplices


def lens(edge):
    """Both sides of the right ventricle; they share the rim."""
    size = HALF_WIDTH * OUTER[0] * 1.5
    rings = max(4, int(round(0.5 * np.pi * size / edge)))
    flat = [np.zeros((1, 2))]
    for i in range(1, rings + 1):
        share = np.sin(0.5 * np.pi * i / rings)
        turn = np.linspace(0.0, np.pi, max(4, int(round(np.pi * share * size / edge))) + 1)
        flat.append(share * np.stack([np.cos(turn), np.sin(turn)], axis=1))
    flat = np.concatenate(flat)
    flat[np.abs(flat) < 1e-12] = 0.0
    azimuth, polar = HALF_WIDTH * flat[:, 0], np.pi / 2 - HALF_HEIGHT * flat[:, 1]
    sides = [place(right(azimuth, polar, side), azimuth, polar) for side in (-1, 1)]
    return sides, Delaunay(flat).simplices


def inside(points, loop):
    """Whether points of the plane lie in a closed polygon: crossings of a ray."""
    odd = np.zeros(len(points), bool)
    for a, b in zip(loop, np.roll(loop, -1, axis=0)):
        crosses = (a[1] > points[:, 1]) != (b[1] > points[:, 1])
        x = a[0] + (points[:, 1] - a[1]) * (b[0] - a[0]) / np.where(b[1] == a[1], 1.0, b[1] - a[1])
        odd ^= crosses & (points[:, 0] < x)
    return odd


def base(loops, edge):
    """The plane z = 0 between the first loop and the others."""
    rim = np.concatenate(loops)
    low, high = rim.min(axis=0), rim.max(axis=0)
    x, y = np.meshgrid(np.arange(low[0], high[0], edge), np.arange(low[1], high[1], edge * np.sqrt(0.75)))
    x[::2] += 0.5 * edge
    grid = np.stack([x.ravel(), y.ravel()], axis=1)

    def muscle(points):
        return inside(points, loops[0]) & ~np.any([inside(points, loop) for loop in loops[1:]], axis=0)
    gap = np.linalg.norm(grid[:, None] - rim[None], axis=2).min(axis=1)
    points = np.concatenate([rim, grid[muscle(grid) & (gap > 0.6 * edge)]])
    triangles = Delaunay(points).simplices
    triangles = triangles[muscle(points[triangles].mean(axis=1))]
    return np.concatenate([points, np.zeros((len(points), 1))], axis=1), triangles


def turned(points, triangles, outward):
    """The triangles, each turned so that its normal points along outward(centre)."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    wrong = np.einsum('ij,ij->i', np.cross(b - a, c - a), outward((a + b + c) / 3)) < 0
    triangles = triangles.copy()
    triangles[wrong] = triangles[wrong][:, ::-1]
    return triangles


def weld(parts):
    """One surface of (points, triangles) parts; points that coincide become one."""
    points = np.concatenate([part[0] for part in parts])
    starts = np.cumsum([0] + [len(part[0]) for part in parts])
    triangles = [part[1] + start for part, start in zip(parts, starts)]
    _, first, number = np.unique(np.round(points * 1e8).astype(np.int64), axis=0, return_index=True, return_inverse=True)
    return points[first], [number.ravel()[t] for t in triangles]


def open_edges(triangles):
    """How many edges lack the triangle on their other side."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    here, there = {tuple(e) for e in edges}, {tuple(e[::-1]) for e in edges}
    return len(here ^ there) + len(edges) - len(here)


def biventricle(edge):
    """Vertices [m] and triangles: all, the left ventricle's and the right one's (both turned away from the muscle). Delaunay's
    triangles of the base need not keep its rims: then slightly shorter edges are tried."""
    for shorter in range(20):
        points, triangles = build(edge * 0.99**shorter)
        if open_edges(np.concatenate(triangles)) == 0:
            return points, np.concatenate(triangles), {'left': triangles[1], 'right': np.concatenate(triangles[2:4])}
    raise ValueError('no closed surface with edges of about %g m' % edge)


def build(edge):
    epi, epi_triangles = cap(OUTER, epicardium, edge)
    left, left_triangles = cap(INNER, lambda azimuth, polar: ellipsoid(INNER, polar) + 0.0 * azimuth, edge)
    (septum, free), lens_triangles = lens(edge)

    def rim(points):
        chosen = points[np.abs(points[:, 2]) < 1e-12][:, :2]
        return chosen[np.argsort(np.arctan2(chosen[:, 1], chosen[:, 0]))]
    right_rim = np.concatenate([rim(septum), rim(free)[-2:0:-1]])
    plane, plane_triangles = base([rim(epi), rim(left), right_rim], edge)
    parts = [(epi, turned(epi, epi_triangles, lambda x: x)), (left, turned(left, left_triangles, lambda x: -x)),
             (septum, turned(septum, lens_triangles, lambda x: x)), (free, turned(free, lens_triangles, lambda x: -x)),
             (plane, turned(plane, plane_triangles, lambda x: x * 0 + [0.0, 0.0, 1.0]))]
    return weld(parts)


def cavity_volume(points, triangles):
    """Of a cavity whose surface is open in the plane z = 0 and turned inwards [m^3]."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return -np.einsum('ij,ij->i', a, np.cross(b, c)).sum() / 6
