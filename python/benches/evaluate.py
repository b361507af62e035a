"""Time to evaluate a million pairs of directions, arrays in and out: this package, Mitsuba 3 (llvm_ad_rgb) and a formula
in numpy, in turn; medians of one run.

    python python/benches/evaluate.py [RUNS]

Mitsuba is optional (pip install mitsuba); without it its column is empty.
"""

from __future__ import annotations

import statistics
import sys
import time
from typing import Callable

import numpy as np

import lights_camera_models as lcm

COUNT = 1_000_000
ALPHA = 0.3


def pairs() -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(7)
    d = random.normal(size=(2, COUNT, 3))
    d[..., 2] = np.abs(d[..., 2]) + 1e-3
    d /= np.linalg.norm(d, axis=-1, keepdims=True)
    return tuple(np.ascontiguousarray(of, dtype=np.float32) for of in d)


def ggx(l: np.ndarray, v: np.ndarray) -> np.ndarray:
    """GGX with separable masking and the exact reflectance of an index of 1.5."""
    h = l + v
    h /= np.linalg.norm(h, axis=-1, keepdims=True)
    a2, cos_h, cos_d = ALPHA * ALPHA, h[:, 2], np.sum(l * h, axis=-1)
    d = a2 / (np.pi * (cos_h**2 * (a2 - 1) + 1) ** 2)
    lobe = lambda c: 2 / (c + np.sqrt(a2 + (1 - a2) * c * c))
    g = np.sqrt(1.5**2 - 1 + cos_d**2)
    a, b = (g - cos_d) / (g + cos_d), (cos_d * (g + cos_d) - 1) / (cos_d * (g - cos_d) + 1)
    f = d * lobe(l[:, 2]) * lobe(v[:, 2]) / 4 * (a * a * (1 + b * b) / 2)
    return np.repeat(f[:, None], 3, axis=1).astype(np.float32)


def disney(l: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Disney's diffuse and specular terms for a dielectric, without coat and sheen."""
    rough, base = np.sqrt(ALPHA), np.array([0.57758, 0.18782, 0.04519], np.float32)
    h = l + v
    h /= np.linalg.norm(h, axis=-1, keepdims=True)
    cos_l, cos_v, cos_h, cos_d = l[:, 2], v[:, 2], h[:, 2], np.sum(l * h, axis=-1)
    weight = lambda c: np.clip(1 - c, 0, 1) ** 5
    at_90 = 0.5 + 2 * rough * cos_d**2 - 1
    diffuse = (1 + at_90 * weight(cos_l)) * (1 + at_90 * weight(cos_v)) / np.pi
    a2 = ALPHA * ALPHA
    d = a2 / (np.pi * (cos_h**2 * (a2 - 1) + 1) ** 2)
    lobe = lambda c: 1 / (c + np.sqrt(a2 + (1 - a2) * c * c))
    f = 0.04 + 0.96 * weight(cos_d)
    return diffuse[:, None] * base + (d * lobe(cos_l) * lobe(cos_v) * f)[:, None]


def mitsuba() -> dict[str, Callable[[np.ndarray, np.ndarray], np.ndarray]]:
    try:
        import mitsuba as mi
    except ImportError:
        return {}
    mi.set_variant("llvm_ad_rgb")
    colour = {"type": "rgb", "value": [0.57758, 0.18782, 0.04519]}
    known = {
        "GGX": {"type": "roughdielectric", "distribution": "ggx", "alpha": ALPHA, "int_ior": 1.5, "ext_ior": 1.0},
        "Disney": {"type": "principled", "base_color": colour, "roughness": float(np.sqrt(ALPHA)), "specular": 0.5},
    }

    def of(bsdf):
        bsdf = mi.load_dict(bsdf)

        def evaluate(l: np.ndarray, v: np.ndarray) -> np.ndarray:
            at = mi.SurfaceInteraction3f()
            at.wi = mi.Vector3f(v.T)
            wo = mi.Vector3f(l.T)
            found = bsdf.eval(mi.BSDFContext(), at, wo)
            return np.array(found / mi.Frame3f.cos_theta(wo)).T

        return evaluate

    return {name: of(bsdf) for name, bsdf in known.items()}


def main() -> None:
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 15
    l, v = pairs()
    bare = dict(base_colour=[255, 255, 255], diffuse="none", multiple_scattering="none", ior=[1.5] * 3,
                distribution="ggx", fresnel="dielectric", masking="smith_separable")
    ours = {
        "GGX": lcm.Model("microfacet", alpha_x=ALPHA, alpha_y=ALPHA, **bare),
        "Disney": lcm.Model("disney", roughness=float(np.sqrt(ALPHA)), base_colour=[200, 120, 60]),
    }
    theirs, formulas = mitsuba(), {"GGX": ggx, "Disney": disney}
    print(f"{COUNT} pairs, medians of {runs} runs in milliseconds")
    print(f"{'':<8}{'here':>8}{'Mitsuba':>9}{'numpy':>8}{'here/Mitsuba':>14}{'numpy/here':>12}")
    for name, model in ours.items():
        all_ways = {"here": model.evaluate, "numpy": formulas[name]}
        if name in theirs:
            all_ways["Mitsuba"] = theirs[name]
        exact = model.evaluate(l, v)
        for way, evaluate in all_ways.items():
            far = ~np.isclose(evaluate(l, v), exact, rtol=0.05, atol=1e-3)
            # Disney's model has an approximation of the reflectance where Mitsuba's has the exact one.
            if far.mean() > (0.15 if name == "Disney" else 1e-3):
                print(f"{name}: {way} differs at {100 * far.mean():.1f} % of the pairs")
        times: dict[str, list[float]] = {way: [] for way in all_ways}
        for _ in range(runs):
            for way, evaluate in all_ways.items():
                begin = time.perf_counter()
                evaluate(l, v)
                times[way].append(1e3 * (time.perf_counter() - begin))
        median = {way: statistics.median(of) for way, of in times.items()}
        here, numpy, other = median["here"], median["numpy"], median.get("Mitsuba")
        known = f"{other:>9.1f}" if other else f"{'–':>9}"
        ratio = f"{here / other:>14.2f}" if other else f"{'–':>14}"
        print(f"{name:<8}{here:>8.1f}{known}{numpy:>8.1f}{ratio}{numpy / here:>12.1f}")


if __name__ == "__main__":
    main()
