"""Pictures compared, and written as PNG."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _lcm
from ._arrays import light_samples_of, real, size_of, word
from ._scenes import DEFAULT_SIZE, Scene


@dataclass(frozen=True, eq=False, repr=False)
class Comparison:
    """The difference between two pictures."""

    #: Every metric over all pixels, by name: ``rmse``, ``psnr``, ``ssim``, ``flip``, ``light_rmse``, … ``None`` if infinite.
    #: Metrics that need unknown data are missing. ``pixels`` is the number of pixels.
    metrics: dict[str, Any]
    #: The metrics over the pixels that objects cover; ``None`` if those are unknown.
    covered: dict[str, Any] | None
    #: The largest difference and its place; ``None`` if the pictures are equal.
    largest: dict[str, Any] | None
    #: The difference of each pixel, b minus a, in the chosen channel: float32 of shape (height, width).
    differences: NDArray[np.float32]
    #: The differences as colours: uint8 of shape (height, width, 3).
    map: NDArray[np.uint8]

    def _repr_png_(self) -> bytes:
        return png(self.map)

    def __repr__(self) -> str:
        known = (f"{name} {value:.4g}" for name, value in self.metrics.items() if name != "pixels" and value is not None)
        return f"<Comparison: {', '.join(known)}>"


def compare(
    a: Scene | ArrayLike,
    b: Scene | ArrayLike,
    size: tuple[int, int] = DEFAULT_SIZE,
    *,
    views: tuple[str, str] = ("A", "A"),
    light_samples: int | None = None,
    channel: str = "largest",
    sign: str = "absolute",
    amplification: float | None = None,
) -> Comparison:
    """Compares two pictures, or two scenes by their pictures.

    Parameters
    ----------
    a, b
        Both scenes; or both arrays of one shape (height, width, 3): uint8 for display codes, floats for linear light.
    size
        Width and height of the pictures of scenes.
    views
        The view of each scene: ``("A", "B")`` with one scene twice compares its variants.
    light_samples
        Samples of lights with extent in scenes, by default 256.
    channel
        The number of a pixel that the differences are of: ``largest``, ``luminance``, ``red``, ``green`` or ``blue``.
    sign
        ``absolute`` or ``signed`` differences in the map.
    amplification
        Factor of the differences in the map, 1 to 100; by default what fits the largest one.

    Raises
    ------
    ValueError
        If the shapes differ or are not those of pictures, or light is not finite.
    """
    factor = None if amplification is None else real("amplification", amplification)
    how = (word("channel", channel), word("sign", sign), factor)
    if isinstance(a, Scene) and isinstance(b, Scene):
        shape = size_of(size)
        if not isinstance(views, (tuple, list)) or len(views) != 2:
            raise ValueError(f"views is {views!r}, but it must be two views, such as ('A', 'B')")
        samples = light_samples_of(light_samples, None)
        first, second = ((of._core, word("view", view)) for of, view in zip((a, b), views))
        told, differences, map_ = _lcm.compare_views(first, second, shape, samples, how)
        width, height = shape
    elif isinstance(a, Scene) or isinstance(b, Scene):
        raise TypeError("a scene can be compared with a scene, an array with an array; use scene.render()")
    else:
        first, second = _picture("a", a), _picture("b", b)
        if first.shape != second.shape:
            raise ValueError(f"a has the shape {first.shape} and b {second.shape}; they must be the same")
        if first.dtype != second.dtype:
            raise TypeError(f"a has elements of type {np.asarray(a).dtype} and b {np.asarray(b).dtype}: codes are "
                            "compared with codes, light with light")
        of = _lcm.compare_codes if first.dtype == np.uint8 else _lcm.compare_light
        told, differences, map_ = of(first, second, how)
        height, width = first.shape[:2]
    numbers = json.loads(told)
    return Comparison(
        numbers["all"],
        numbers["covered"],
        numbers["largest"],
        differences.reshape(height, width),
        map_.reshape(height, width, 3),
    )


def png(picture: ArrayLike) -> bytes:
    """The bytes of a PNG file of display codes: uint8 of shape (height, width, 3)."""
    codes = _picture("picture", picture)
    if codes.dtype != np.uint8:
        raise TypeError(f"the picture has elements of type {codes.dtype}, but display codes are uint8")
    return _lcm.png(codes)


def _picture(name: str, value: ArrayLike) -> NDArray[Any]:
    if isinstance(value, np.ma.MaskedArray):
        raise TypeError(f"{name} is a masked array; fill it first")
    array = np.asarray(value)
    if array.ndim != 3 or array.shape[2] != 3 or 0 in array.shape:
        raise ValueError(f"{name} has the shape {array.shape}, but pictures have (height, width, 3)")
    if max(array.shape) > 16384:
        raise ValueError(f"{name} has the shape {array.shape}, but sides have at most 16384 pixels")
    if array.dtype == np.uint8:
        return np.require(array, requirements=["C", "A"])
    if array.dtype.kind != "f":
        raise TypeError(f"{name} has elements of type {array.dtype}, but pictures are uint8 or floats")
    light = np.require(array, np.float32, ["C", "A"])
    if not np.isfinite(light).all():
        raise ValueError(f"{name} has light that is not finite")
    return light
