"""Arguments as the core takes them: contiguous arrays, checked numbers, JSON."""

from __future__ import annotations

import json
import operator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

MAX_SIDE = 16384
MAX_LIGHT_SAMPLES = 1 << 20


def numbers(name: str, value: ArrayLike, what: str) -> NDArray[Any]:
    """An array of real numbers."""
    if isinstance(value, np.ma.MaskedArray):
        raise TypeError(f"{name} is a masked array; fill or compress it first")
    array = np.asarray(value)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name} has elements of type {array.dtype}, but {what} are real numbers")
    return array


def directions(name: str, value: ArrayLike) -> NDArray[Any]:
    """Directions as an array of numbers whose last axis has three components."""
    array = numbers(name, value, "directions")
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ValueError(f"{name} has the shape {array.shape}, but its last axis must have 3 components: (…, 3)")
    return array


def check_unit(name: str, array: NDArray[Any]) -> None:
    """Refuses directions that are not of unit length, with the index of the first."""
    with np.errstate(all="ignore"):
        length = np.sqrt(np.sum(np.square(array, dtype=np.float64), axis=-1))
    wrong = np.argwhere(~(np.abs(length * length - 1.0) <= 2e-3))
    if len(wrong):
        at = tuple(int(i) for i in wrong[0])
        place = f"{name}[{', '.join(map(str, at))}]" if at else name
        found = ", ".join(f"{x:g}" for x in np.asarray(array[at], dtype=np.float64))
        why = f"has the length {length[at]:.6g}" if np.isfinite(array[at]).all() else "is not finite"
        raise ValueError(f"{place} is ({found}), which {why}; directions must be unit vectors")


def result_type(*arrays: NDArray[Any]) -> np.dtype[Any]:
    """float32 if all arrays are; otherwise float64."""
    return np.dtype(np.float32 if all(array.dtype == np.float32 for array in arrays) else np.float64)


def flat(array: NDArray[Any], shape: tuple[int, ...]) -> NDArray[np.float32]:
    """The array broadcast to a shape, as rows of three 32-bit floats."""
    with np.errstate(over="ignore", invalid="ignore"):
        whole = np.broadcast_to(array, shape).astype(np.float32, copy=False)
    return np.require(whole, requirements=["C", "A"]).reshape(-1, 3)


def real(name: str, value: Any) -> float:
    """A finite number."""
    try:
        if isinstance(value, (bool, np.bool_, str, bytes)) or np.ndim(value):
            raise TypeError
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        raise TypeError(f"{name} is {shown(value)}, but it must be a number") from None
    if not np.isfinite(number):
        raise ValueError(f"{name} is {number}, but it must be finite")
    return number


def whole(name: str, value: Any, least: int, most: int) -> int:
    """A whole number within limits."""
    try:
        if isinstance(value, (bool, np.bool_)):
            raise TypeError
        number = operator.index(value)
    except TypeError:
        number = None
    if number is None or not least <= number <= most:
        raise ValueError(f"{name} is {shown(value)}, but it must be a whole number from {least} to {most}")
    return number


def size_of(size: Any) -> list[int]:
    """A width and a height in pixels."""
    if not isinstance(size, (tuple, list, np.ndarray)) or len(size) != 2:
        raise ValueError(f"size is {shown(size)}, but it must be (width, height) in pixels, such as (640, 360)")
    return [whole(name, side, 1, MAX_SIDE) for name, side in zip(("the width", "the height"), size)]


def word(name: str, value: Any) -> str:
    """A word."""
    if not isinstance(value, str):
        raise TypeError(f"{name} is {shown(value)}, but it must be a word")
    return str(value)


def light_samples_of(given: Any, noise: float | None) -> int:
    """The largest number of samples: few, unless noise decides."""
    if given is None:
        return 256 if noise is None else 65536
    return whole("light_samples", given, 1, MAX_LIGHT_SAMPLES)


def shown(value: Any) -> str:
    """A value for messages."""
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "…"


def to_json(what: str, value: Any, error: type[Exception]) -> str:
    """A value as JSON; numbers and arrays of numpy become those of Python."""
    try:
        text = json.dumps(value, allow_nan=False, ensure_ascii=False, default=_plain)
        # Text that is not Unicode fails here.
        text.encode()
        return text
    except (TypeError, ValueError, RecursionError, UnicodeError) as why:
        raise error(f"{what} is {shown(value)}, which is no value of a scene: {why}") from None


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"{type(value).__name__} is not a number, a word or a list")
