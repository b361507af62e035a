"""Reflection models: their equations, for arrays of directions."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _lcm
from ._arrays import check_unit, directions, flat, numbers, real, result_type, to_json, word
from .errors import ModelError

_TERMS = ("ambient", "diffuse", "specular", "transmitted")

@dataclass(frozen=True)
class Parameter:
    """What a model declares about one of its parameters."""

    #: Name, as an argument of :class:`Model` and in scene files.
    name: str
    #: Name in words.
    label: str
    #: Symbol in equations.
    symbol: str
    #: Unit; empty for pure numbers.
    unit: str
    #: What it does.
    help: str
    #: The legal values, in words: ``between 0 and 1``.
    rule: str
    #: The default.
    default: Any


def models() -> list[str]:
    """The ids of all reflection models: those of the program, and those added by :func:`add_model`."""
    return list(_lcm.models())


def add_model(name: str, wgsl: str) -> None:
    """Adds a reflection model written in WGSL, or replaces one added before.

    Parameters
    ----------
    name
        The id: lower-case letters, digits and underscores. It is known to :class:`Model` and to scenes read from now on.
    wgsl
        The text of one file: a declaration in a comment that begins with ``lcm``, and ``fn response``; see *A model in
        one file* in the manual. The CPU interprets it.

    Raises
    ------
    ModelError
        With line and column of every mistake.
    """
    _lcm.add_model(word("name", name), word("wgsl", wgsl))


class Model:
    """A reflection model with its parameters set; it does not change.

    Parameters
    ----------
    name
        The id, one of :func:`models`.
    parameters
        Parameters by name, as in scene files: numbers, three numbers for colours (0–255, sRGB) and triples, words for
        choices, ``True`` or ``False``. Others have their defaults; :meth:`declared` lists them.

    Raises
    ------
    ModelError
        For an unknown model or parameter, with the nearest name, and for values outside their range. ``problems`` has a
        dictionary for each; its ``path`` is the name of the parameter.

    Notes
    -----
    All directions are unit vectors in the frame of the surface: x along the tangent, z along the normal. They point away
    from the surface, ``l`` to the light and ``v`` to the viewer. Calculations are in 32-bit floats, on all cores,
    without Python's lock; Ctrl+C ends them.

    A custom model keeps its WGSL: it stays as it is, here and in copies and pickles, when :func:`add_model` replaces it.

    Examples
    --------
    >>> gold = Model("microfacet", alpha_x=0.3, alpha_y=0.3)
    >>> gold.evaluate([0, 0.6, 0.8], [0, -0.6, 0.8]).shape
    (3,)
    """

    __slots__ = ("_core", "_name", "_given")

    def __init__(self, name: str, /, **parameters: Any) -> None:
        self._set(name, parameters, None)

    @classmethod
    def _of(cls, name: str, given: dict[str, Any], wgsl: str | None) -> Model:
        model = object.__new__(cls)
        model._set(name, given, wgsl)
        return model

    def _set(self, name: str, parameters: dict[str, Any], wgsl: str | None) -> None:
        name = word("the model", name)
        each = (f"{json.dumps(key)}: {to_json(key, value, ModelError)}" for key, value in parameters.items())
        written = "{" + ", ".join(each) + "}"
        self._core = _lcm.Model(name, written, wgsl)
        self._name = name
        self._given = json.loads(written)

    @property
    def name(self) -> str:
        """The id of the model."""
        return self._name

    @property
    def parameters(self) -> dict[str, Any]:
        """All parameters with their values, given or by default."""
        return json.loads(self._core.parameters())

    @property
    def about(self) -> dict[str, str]:
        """Name, author, source and summary of the model."""
        told = json.loads(self._core.describe())
        return {key: told[key] for key in ("name", "author", "source", "summary")}

    @staticmethod
    def declared(name: str) -> dict[str, Parameter]:
        """The parameters that a model declares, by name."""
        told = json.loads(_lcm.describe(word("the model", name)))
        return {parameter["name"]: Parameter(**parameter) for parameter in told["parameters"]}

    def evaluate(self, l: ArrayLike, v: ArrayLike) -> NDArray[Any]:
        """The BSDF f(l, v), in sr⁻¹, in red, green and blue.

        Parameters
        ----------
        l, v
            Directions to the light and to the viewer, shape (…, 3), broadcast against each other.

        Returns
        -------
        array
            Shape (…, 3): float32 if both arrays are, otherwise float64. Zero where light or viewer are below the surface,
            unless the model transmits. Light that does not spread, as of smooth glass, is not part of it.

        Raises
        ------
        ValueError
            For other shapes, and for directions that are not finite or not of unit length, with the index of the first.
        """
        return self._of_pairs(l, v, self._core.evaluate, (3,))

    def terms(self, l: ArrayLike, v: ArrayLike) -> dict[str, NDArray[Any]]:
        """The terms of the response to light of 1 lx at normal incidence: π f |cos θ_l| of the diffuse, specular and
        transmitted part, and the ambient term.

        Parameters and errors are those of :meth:`evaluate`; so is the shape of each array.
        """
        all_terms = self._of_pairs(l, v, self._core.terms, (4, 3))
        return {name: all_terms[..., i, :] for i, name in enumerate(_TERMS)}

    def _of_pairs(self, l: ArrayLike, v: ArrayLike, of: Any, tail: tuple[int, ...]) -> NDArray[Any]:
        light, viewer = directions("l", l), directions("v", v)
        try:
            shape = np.broadcast_shapes(light.shape, viewer.shape)
        except ValueError:
            raise ValueError(
                f"l has the shape {light.shape} and v {viewer.shape}; they cannot be broadcast together"
            ) from None
        found = of(flat(light, shape), flat(viewer, shape))
        if found is None or not found.size:
            check_unit("l", light)
            check_unit("v", viewer)
            if found is None:
                raise ValueError("a direction is not of unit length in 32-bit floats")
        found = found.reshape(shape[:-1] + tail)
        return found.astype(result_type(light, viewer), copy=False)

    def albedo(self, mu: ArrayLike, phi: float = 0.0) -> NDArray[Any]:
        """The directional albedo: the part of uniform light above the surface that reaches a viewer, in red, green and
        blue. Light that a smooth surface mirrors counts too; light that passes through the surface does not.

        Parameters
        ----------
        mu
            Cosines of the angle between viewer and normal, greater than 0, at most 1; any shape.
        phi
            Azimuth of the viewer from the tangent, in radians.

        Returns
        -------
        array
            Shape (…, 3): float32 if ``mu`` is, otherwise float64.
        """
        given = numbers("mu", mu, "cosines")
        cosines = np.require(given, np.float64, ["C", "A"]).reshape(-1)
        wrong = np.flatnonzero(~((cosines > 0.0) & (cosines <= 1.0)))
        if wrong.size:
            i = int(wrong[0])
            raise ValueError(f"element {i} of mu is {cosines[i]}, but cosines must be greater than 0 and at most 1")
        found = self._core.albedo(cosines, real("phi", phi)).reshape(given.shape + (3,))
        return found.astype(result_type(given), copy=False)

    def curve(
        self, kind: str = "f", theta_i: float = 45.0, phi_i: float = 0.0
    ) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
        """A curve in the plane of incidence, with as many points as it needs to look smooth. The light is on the side of
        negative angles, the mirror direction at +theta_i.

        Parameters
        ----------
        kind
            The quantity, as of ``lcm plot --kind``: ``f``, ``f_cos``, ``albedo``, …
        theta_i, phi_i
            The angle of the light from the normal, and its azimuth from the tangent, in degrees.

        Returns
        -------
        angles, values
            Degrees, shape (n,), and red, green and blue, shape (n, 3).
        """
        angles, values = self._core.curve(word("kind", kind), real("theta_i", theta_i), real("phi_i", phi_i))
        return angles, values.reshape(-1, 3)

    def laws(self) -> dict[str, Any]:
        """The laws of physics that models of this name claim and keep, examined with random and extreme parameters, not only
        with those of this model. It takes seconds.

        Returns
        -------
        dict
            ``laws``: for each its name as ``law``, whether it is ``claimed`` and ``kept``, the ``measure`` with its largest
            ``size``, and where that is; ``not_finite``: the number of responses that are no numbers; ``sampling``: the
            quality of its lobes.
        """
        told = json.loads(self._core.laws())
        for law in told["laws"]:
            law["size"] = float(law["size"])
        told["sampling"]["error"] = float(told["sampling"]["error"])
        return told

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self)._of, (self._name, self._given, self._core.text())

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Model):
            return NotImplemented
        mine, its = ((of._name, of._core.text(), of.parameters) for of in (self, other))
        return mine == its

    def __hash__(self) -> int:
        return hash((self._name, self._core.parameters()))

    def __repr__(self) -> str:
        return "".join([f"Model({self._name!r}", *(f", {k}={v!r}" for k, v in self._given.items()), ")"])
