"""LDR-FLIP once more, from the formulas of Andersson et al. 2020 and in double precision: whole two-dimensional
kernels, applied through scipy, and every colour space on the way written out. Slow; for checking only."""
import numpy as np
from scipy.ndimage import correlate

# IEC 61966-2-1 primaries and D65, as the FLIP paper's supplement has them.
RGB_TO_XYZ = np.array([
    [10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
    [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
    [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382]])
WHITE = RGB_TO_XYZ @ np.ones(3)


def linear_rgb(picture):
    v = picture[..., :3].astype(float) / 255
    return np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)


def ycxcz(rgb):
    x, y, z = np.moveaxis(rgb @ RGB_TO_XYZ.T / WHITE, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def rgb_of_ycxcz(c):
    y = (c[..., 0] + 16) / 116
    xyz = np.stack([y + c[..., 1] / 500, y, y - c[..., 2] / 200], axis=-1) * WHITE
    return xyz @ np.linalg.inv(RGB_TO_XYZ).T


def lab(rgb):
    t = rgb @ RGB_TO_XYZ.T / WHITE
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t * (29 / 6) ** 2 / 3 + 4 / 29)
    return np.stack([116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], axis=-1)


def hunt(c):
    return np.stack([c[..., 0], c[..., 0] * c[..., 1] / 100, c[..., 0] * c[..., 2] / 100], axis=-1)


def hyab(p, q):
    return np.abs(p[..., 0] - q[..., 0]) + np.hypot(p[..., 1] - q[..., 1], p[..., 2] - q[..., 2])


def csf_kernel(ppd, lobes):
    radius = int(np.ceil(3 * np.sqrt(0.04 / (2 * np.pi ** 2)) * ppd))
    x, y = np.meshgrid(np.arange(-radius, radius + 1), np.arange(-radius, radius + 1))
    d2 = (x ** 2 + y ** 2) / ppd ** 2
    g = sum(a * np.sqrt(np.pi / b) * np.exp(-np.pi ** 2 * d2 / b) for a, b in lobes)
    return g / g.sum()


def seen(picture, ppd):
    kernels = [csf_kernel(ppd, lobes) for lobes in
               ([(1, 0.0047)], [(1, 0.0053)], [(34.1, 0.04), (13.5, 0.025)])]
    c = ycxcz(linear_rgb(picture))
    blurred = np.stack([correlate(c[..., i], kernels[i], mode="nearest") for i in range(3)], axis=-1)
    return hunt(lab(np.clip(rgb_of_ycxcz(blurred), 0, 1)))


def features(picture, ppd):
    """Strength of edges and of points."""
    y = (ycxcz(linear_rgb(picture))[..., 0] + 16) / 116
    sigma = 0.5 * 0.082 * ppd
    radius = int(np.ceil(3 * sigma))
    u, v = np.meshgrid(np.arange(-radius, radius + 1), np.arange(-radius, radius + 1))
    g = np.exp(-(u ** 2 + v ** 2) / (2 * sigma ** 2))
    found = []
    for kernel in (-u * g, (u ** 2 / sigma ** 2 - 1) * g):
        kernel = np.where(kernel > 0, kernel / kernel[kernel > 0].sum(), -kernel / kernel[kernel < 0].sum())
        found.append(np.hypot(correlate(y, kernel, mode="nearest"), correlate(y, kernel.T, mode="nearest")))
    return found


def flip_map(reference, picture, ppd):
    primaries = np.eye(3)
    largest = hyab(hunt(lab(primaries[1])), hunt(lab(primaries[2]))) ** 0.7
    error = hyab(seen(reference, ppd), seen(picture, ppd)) ** 0.7
    knee = 0.4 * largest
    colour = np.where(error < knee, 0.95 * error / knee, 0.95 + 0.05 * (error - knee) / (largest - knee))
    (edges_r, points_r), (edges_p, points_p) = features(reference, ppd), features(picture, ppd)
    feature = np.sqrt(np.maximum(np.abs(edges_r - edges_p), np.abs(points_r - points_p)) / np.sqrt(2))
    return colour ** (1 - feature)
