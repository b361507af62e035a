"""Renders a scene again and again: the time and the relative error of pictures with 1, 4, … samples per pixel.

The error is the root mean square over the pixels of a mask, over their mean luminance, against the mean of many
pictures with other seeds. Each line of the output: samples, milliseconds (median), error.
"""

import statistics
import sys
import time

import mitsuba as mi

import drjit as dr
import numpy as np

path, mask, last = sys.argv[1], sys.argv[2], int(sys.argv[3])
mi.set_variant("llvm_ad_rgb")
# Warnings would stand among the numbers, in colour.
mi.set_log_level(mi.LogLevel.Error)
scene = mi.load_file(path)


def draw(spp, seed):
    image = mi.render(scene, spp=spp, seed=seed)
    dr.eval(image)
    dr.sync_thread()
    return image


def luminance(image):
    return np.array(image)[..., :3] @ np.array([0.2126, 0.7152, 0.0722])


inner = np.fromfile(mask, dtype="u1").reshape(luminance(draw(1, 0)).shape) > 0
PICTURES, SAMPLES = 2, 512
exact = sum(luminance(draw(SAMPLES, 1000 + i)).astype("f8") for i in range(PICTURES)) / PICTURES
mean = exact[inner].mean()
samples = 1
while samples <= last:
    # The first of each size compiles the kernel.
    draw(samples, 1)
    times, errors = [], []
    for i in range(9 if samples <= 16 else 3):
        begin = time.perf_counter()
        image = draw(samples, 10 + i)
        times.append((time.perf_counter() - begin) * 1e3)
        errors.append(float(np.sqrt(((luminance(image) - exact)[inner] ** 2).mean()) / mean))
    print(samples, statistics.median(times), statistics.median(errors), flush=True)
    samples *= 4
print("mean", float(mean))
