#!/usr/bin/env python3
"""Our metrics against independent implementations on the same pictures.

Usage: metrics_peers_test.py METRICS_PROBE    exit status 77 and a sentence: something to compare with is missing

  MSSIM     scikit-image's structural_similarity
  PSNR      scikit-image's peak_signal_noise_ratio, and ffmpeg's psnr filter
  FLIP      flip_peer.py: written from the paper's formulas, not from our code
  flicker   its definition in numpy
  BD-rate   numpy's polyfit, and scipy's pchip and Akima interpolators

METRICS_PEERS=DIR, by default where scripts/setup.sh unpacks scikit-image and scipy, comes first in the search path.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest.mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, os.environ.get("METRICS_PEERS", "/usr/local/lib/atlaswire/aside/usr/lib/python3/dist-packages"))
try:
    import numpy as np
    import scipy.interpolate
    from PIL import Image, ImageFilter
    from skimage.filters import gaussian
    from skimage.metrics import peak_signal_noise_ratio, structural_similarity
except ImportError as missing:
    print(f"skipped: {missing}: run scripts/setup.sh, which fetches scikit-image and scipy (packages.txt, 'aside')")
    sys.exit(77)
sys.path.insert(0, str(pathlib.Path(__file__).parent))
import flip_peer  # noqa: E402

# MSSIM: ours squares floats, scikit-image doubles; where all is flat, SSIM divides two numbers near C2 = 9e-4, and
# float's 1e-7 becomes 1e-4 in such a window, far less in the mean.
MSSIM_TOLERANCE = 2e-5
# PSNR: both sum integers exactly; ffmpeg prints six decimals, and our probe nine digits.
PSNR_TOLERANCE = 1e-6
# FLIP: ours is float, and the powers 0.7 and 0.5 magnify errors where colours or features all but agree: a feature
# strength of 1e-8 instead of 0 moves a pixel by 1e-4 of its value. Such pixels are few, so the mean is far closer.
FLIP_MEAN_TOLERANCE = 2e-6
FLIP_PIXEL_TOLERANCE = 3e-4
FLICKER_TOLERANCE = 1e-6
BD_TOLERANCE = 1e-6  # per cent, dB: both in double


def probe(*words):
    done = subprocess.run([PROBE, *map(str, words)], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def picture_pairs():
    """Rendered and generated pictures, each with a spoilt copy: what codecs, warps and late frames do."""
    random = np.random.default_rng(7)
    rendered = Image.open(ROOT / "docs/atrium.jpg").convert("RGB")
    rendered = rendered.crop((rendered.width // 4, rendered.height // 4, rendered.width // 4 + 160,
                              rendered.height // 4 + 90))
    whole = np.asarray(rendered)
    yield "blurred", whole, np.asarray(rendered.filter(ImageFilter.GaussianBlur(1.5)))
    yield "shifted", whole, np.roll(whole, 2, axis=1)
    yield "holed", whole, np.where((np.indices(whole.shape[:2]).sum(axis=0) % 40 < 6)[..., None], 0, whole)
    noisy = whole.astype(int) + random.integers(-12, 13, whole.shape)
    yield "noisy", whole, np.clip(noisy, 0, 255)
    yield "blocky", whole, whole // 32 * 32 + 16
    y, x = np.mgrid[0:72, 0:110]
    bars = np.stack([255 * ((x // (1 + y // 12)) % 2), 2 * y, 2 * x], axis=-1)
    yield "bars", bars, bars[:, ::-1]
    yield "random", random.integers(0, 256, (40, 60, 3)), random.integers(0, 256, (40, 60, 3))
    yield "near white", np.full((50, 50, 3), 252), 252 + random.integers(-1, 2, (50, 50, 3))


def luma(picture):
    return picture.astype(float) @ [0.2126, 0.7152, 0.0722] / 255


def eleven_taps(image, **settings):
    return gaussian(image, **{**settings, "truncate": 2.5})


def skimage_mssim(reference, picture):
    # scikit-image cuts its Gaussian at 3.5 sigma, 15 taps at sigma 2; [SAS] 5.6 has 11.
    with unittest.mock.patch("skimage.metrics._structural_similarity.gaussian", eleven_taps):
        _, index = structural_similarity(luma(reference), luma(picture), data_range=1, gaussian_weights=True,
                                         sigma=2, use_sample_covariance=False, K1=0.01, K2=0.03, full=True)
    return index[5:-5, 5:-5].mean()  # windows wholly inside


def ffmpeg_psnr(reference, picture):
    graph = "[0]format=gbrp[a];[1]format=gbrp[b];[a][b]psnr"
    done = subprocess.run(["ffmpeg", "-hide_banner", "-nostdin", "-i", reference, "-i", picture, "-lavfi", graph,
                           "-f", "null", "-"], capture_output=True, text=True, check=True)
    return float(re.search(r"average:(\S+)", done.stderr).group(1))


FAULTS = []


def expect_near(what, ours, theirs, tolerance):
    difference = float(np.max(np.abs(np.asarray(ours) - np.asarray(theirs))))
    print(f"{what:34} {np.mean(ours):12.7f} {np.mean(theirs):12.7f}   apart {difference:.1e}, allowed {tolerance:.0e}")
    if not difference <= tolerance:
        FAULTS.append(what)


def check_pictures(folder):
    for name, reference, picture in picture_pairs():
        reference, picture = reference.astype(np.uint8), picture.astype(np.uint8)
        paths = [folder / f"{name}-{role}.png" for role in ("reference", "picture")]
        Image.fromarray(reference).save(paths[0])
        Image.fromarray(picture).save(paths[1])
        ours = probe("pictures", *paths)
        mssim = skimage_mssim(reference, picture)
        expect_near(f"{name}: MSSIM, scikit-image", ours["mssim"], mssim, MSSIM_TOLERANCE)
        expect_near(f"{name}: DSSIM, scikit-image", ours["dssim"], (1 - mssim) / 2, MSSIM_TOLERANCE / 2)
        expect_near(f"{name}: PSNR, scikit-image", ours["psnr"], peak_signal_noise_ratio(reference, picture),
                    PSNR_TOLERANCE)
        expect_near(f"{name}: PSNR, ffmpeg", ours["psnr"], ffmpeg_psnr(*paths), PSNR_TOLERANCE)
        for ppd in (0.7 * 3840 / 0.7 * np.pi / 180, 8.4):
            ours = probe("pictures", *paths, repr(ppd))
            theirs = flip_peer.flip_map(reference, picture, ppd)
            expect_near(f"{name}: FLIP at {ppd:.1f}, mean", ours["flip"], theirs.mean(), FLIP_MEAN_TOLERANCE)
            expect_near(f"{name}: FLIP at {ppd:.1f}, pixels", ours["flip_map"], theirs.ravel(), FLIP_PIXEL_TOLERANCE)


def check_flicker(folder):
    random = np.random.default_rng(8)
    pictures = random.integers(0, 256, (4, 30, 40, 3), dtype=np.uint8)
    paths = [folder / f"flicker{i}.png" for i in range(4)]
    for path, picture in zip(paths, pictures):
        Image.fromarray(picture).save(path)
    r0, v0, r1, v1 = map(luma, pictures)
    expect_near("flicker, numpy", probe("flicker", *paths)["flicker"], np.abs((v1 - v0) - (r1 - r0)).mean(),
                FLICKER_TOLERANCE)


def difference(anchor, test, argument, value, integral):
    """Mean over the common arguments of test's curve less anchor's."""
    a, t = (curve[np.argsort(curve[:, 0])] for curve in (anchor, test))
    low = max(a[:, argument].min(), t[:, argument].min())
    high = min(a[:, argument].max(), t[:, argument].max())
    areas = [integral(c[:, argument], c[:, value], low, high) for c in (a, t)]
    return (areas[1] - areas[0]) / (high - low)


def polynomial(x, y, low, high):
    whole = np.polyint(np.polyfit(x, y, 3))
    return np.polyval(whole, high) - np.polyval(whole, low)


def interpolator(kind):
    return lambda x, y, low, high: kind(x, y).integrate(low, high)


FITS = {"cubic": polynomial, "pchip": interpolator(scipy.interpolate.PchipInterpolator),
        "akima": interpolator(scipy.interpolate.Akima1DInterpolator)}


def check_rate_differences():
    curves = {
        "dB": ([(5.1, 31.02), (9.8, 33.9), (20.3, 36.45), (41, 38.77), (79.5, 40.2)],
               [(4.7, 31.5), (10.4, 34.9), (19.2, 37.2), (40.6, 39.1)]),
        "MSSIM": ([(1, 0.81), (2, 0.902), (4, 0.9415), (8, 0.9601)],
                  [(1.3, 0.80), (2.2, 0.893), (4.4, 0.937), (8.1, 0.9597), (15, 0.9652), (30, 0.968)])}
    for name, (anchor, test) in curves.items():
        ours = probe("bd", *(",".join(f"{r}:{q}" for r, q in c) for c in (anchor, test)))
        anchor, test = (np.array([(np.log10(r), q) for r, q in c]) for c in (anchor, test))
        for fit, integral in FITS.items():
            rate = 100 * (10 ** difference(anchor, test, 1, 0, integral) - 1)
            expect_near(f"{name}: BD-rate, {fit}", ours[fit]["rate"], rate, BD_TOLERANCE)
            quality = difference(anchor, test, 0, 1, integral)
            expect_near(f"{name}: BD-quality, {fit}", ours[fit]["quality"], quality, BD_TOLERANCE)


if __name__ == "__main__":
    PROBE = sys.argv[1]
    with tempfile.TemporaryDirectory() as scratch:
        check_pictures(pathlib.Path(scratch))
        check_flicker(pathlib.Path(scratch))
    check_rate_differences()
    if FAULTS:
        print("\n".join(f"FAILED {fault}" for fault in FAULTS))
        sys.exit(1)
