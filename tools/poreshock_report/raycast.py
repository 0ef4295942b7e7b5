"""The isosurface of voxels as a shaded picture: parallel rays, the first voxel at the level, its surface from the
trilinear field."""
import itertools

import numpy

AZIMUTH, ELEVATION = numpy.radians(-35.0), numpy.radians(18.0)  # where the eye is
AHEAD = numpy.array((-numpy.sin(AZIMUTH) * numpy.cos(ELEVATION), numpy.cos(AZIMUTH) * numpy.cos(ELEVATION), -numpy.sin(ELEVATION)))
RIGHT = numpy.array((numpy.cos(AZIMUTH), numpy.sin(AZIMUTH), 0.0))
UP = numpy.cross(RIGHT, AHEAD)
LIGHT = (-AHEAD - 0.6 * RIGHT + 0.8 * UP) / numpy.linalg.norm(-AHEAD - 0.6 * RIGHT + 0.8 * UP)
PIXELS = 420  # of the picture's longer side
STEP = 0.5  # of the rays, voxels


def project(point, shape):
    """Place in the picture, voxels, of a point of a box of this shape, voxels from its low corner."""
    offset = numpy.asarray(point, float) - 0.5 * numpy.asarray(shape)
    return float(offset @ RIGHT), float(offset @ UP)


def outline(shape):
    """The twelve edges of the box as pairs of (across, across), (up, up)."""
    corners = list(itertools.product(*((0.0, length) for length in shape)))
    pairs = [(a, b) for a, b in itertools.combinations(corners, 2) if sum(x != y for x, y in zip(a, b)) == 1]
    return [tuple(zip(project(a, shape), project(b, shape))) for a, b in pairs]


def trilinear(values, points):
    """Values at points (n x 3, voxels; voxel centres at halves), which lie inside by half a voxel or more."""
    base = numpy.clip(numpy.floor(points - 0.5).astype(int), 0, numpy.array(values.shape) - 2)
    part = points - 0.5 - base
    total = numpy.zeros(len(points))
    for corner in itertools.product((0, 1), repeat=3):
        weight = numpy.prod(numpy.where(numpy.array(corner) == 1, part, 1.0 - part), axis=1)
        total += weight * values[tuple((base + corner).T)]
    return total


def near_hot(values, level):
    """Voxels in which the trilinear field can reach the level: those at it and all that touch them."""
    hot = values >= level
    for axis in range(3):
        hot = hot | numpy.roll(hot, 1, axis) | numpy.roll(hot, -1, axis)
    return hot


def first_hits(values, level, start, length):
    """Distances at which rays from `start` (n x 3) along AHEAD first find the level, NaN for those that do not."""
    found = numpy.full(len(start), numpy.nan)
    alive, limit, near = numpy.arange(len(start)), numpy.array(values.shape) - 1, near_hot(values, level)
    for distance in numpy.arange(0.0, length, STEP):
        points = start[alive] + distance * AHEAD
        voxel = numpy.floor(points).astype(int)
        worth = numpy.flatnonzero(numpy.all((voxel >= 0) & (voxel <= limit), axis=1) & near[tuple(numpy.clip(voxel, 0, limit).T)])
        hit = worth[trilinear(values, points[worth]) >= level]
        found[alive[hit]] = distance
        alive = numpy.delete(alive, hit)
    return found


def refine(values, level, start, distance):
    """Distances of the surface before those at which the rays found the level, by bisection."""
    low, high = distance - STEP, distance.copy()
    for _ in range(10):
        middle = 0.5 * (low + high)
        above = trilinear(values, start + middle[:, None] * AHEAD) >= level
        low, high = numpy.where(above, low, middle), numpy.where(above, middle, high)
    return high


def shaded_surface(values, level):
    """Brightness 0 ... 1 of the surface at a level of voxels (x, y, z) on the pixels of a picture, NaN where there is none,
    and the picture's range (low and high across, low and high up) in voxels."""
    shape = numpy.array(values.shape)
    # Cold around the box closes the surface on its sides, halfway between the voxels.
    padded = numpy.pad(values, 2, constant_values=min(values.min(), 2.0 * level - values.max()))
    corners = numpy.array([project(corner, shape) for corner in itertools.product(*((0, length) for length in shape))])
    (left, low), (right, high) = corners.min(axis=0) - 1.0, corners.max(axis=0) + 1.0
    pixel = max(right - left, high - low) / PIXELS
    across, up = (numpy.arange(first + 0.5 * pixel, last, pixel) for first, last in ((left, right), (low, high)))
    plane = across[None, :, None] * RIGHT + up[:, None, None] * UP
    reach = 0.5 * numpy.linalg.norm(shape) + 2.0
    start = (plane - reach * AHEAD + 0.5 * shape + 2.0).reshape(-1, 3)
    hits = first_hits(padded, level, start, 2.0 * reach)
    shade = numpy.full(len(start), numpy.nan)
    seen = numpy.flatnonzero(numpy.isfinite(hits))
    points = start[seen] + refine(padded, level, start[seen], hits[seen])[:, None] * AHEAD
    slope = numpy.stack([trilinear(padded, points + step) - trilinear(padded, points - step) for step in numpy.eye(3)], axis=1)
    normal = -slope / numpy.maximum(numpy.linalg.norm(slope, axis=1, keepdims=True), 1e-300)
    shade[seen] = 0.3 + 0.7 * numpy.clip(normal @ LIGHT, 0.0, 1.0)
    return shade.reshape(len(up), len(across)), (left, right, low, high)
