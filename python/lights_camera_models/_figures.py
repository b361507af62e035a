"""Curves of models as figures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy.typing import NDArray

from . import _lcm
from ._arrays import real, word
from ._models import Model


class Figure(bytes):
    """The bytes of an SVG file, which notebooks show."""

    def _repr_svg_(self) -> str:
        return self.decode()

    def __repr__(self) -> str:
        return f"<Figure: SVG, {len(self)} bytes>"


def plot(
    models: Model | Sequence[Model],
    kind: str = "f",
    theta_i: float = 45.0,
    phi_i: float = 0.0,
    *,
    data: Sequence[str] = (),
    channel: str | None = None,
    log: bool = False,
) -> Figure:
    """Curves of models in one figure, as of ``lcm plot``.

    Parameters
    ----------
    models
        One model or several.
    kind
        The quantity, as of ``lcm plot --kind``: ``f``, ``f_cos``, ``albedo``, ``slice``, …
    theta_i, phi_i
        The angle of the light from the normal, and its azimuth from the tangent, in degrees.
    data
        Measured data to lay over: ``krylon_blue``, ``garnet_red``, ``acryl_blue``, or a material of the MERL database.
    channel
        ``luminance``, ``r``, ``g`` or ``b``.
    log
        True for a logarithmic axis.

    Returns
    -------
    Figure
        The bytes of an SVG file: ``Path("plot.svg").write_bytes(plot(model))``.
    """
    wanted = [models] if isinstance(models, (Model, str)) else list(models)
    if not wanted and not data:
        raise ValueError("there is nothing to plot; give a model or the name of measured data")
    for model in wanted:
        if not isinstance(model, Model):
            raise TypeError(f"{model!r} is not a Model; write Model({model!r})")
    names = [word("data", name) for name in ([data] if isinstance(data, str) else data)]
    channel = None if channel is None else word("channel", channel)
    cores = [model._core for model in wanted]
    angles = real("theta_i", theta_i), real("phi_i", phi_i)
    return Figure(_lcm.plot(cores, word("kind", kind), *angles, channel, bool(log), names, "svg"))


@dataclass(frozen=True, eq=False)
class Measurements:
    """Measured values of a BRDF."""

    #: Unit vectors to the light, shape (n, 3), in the frame of the surface.
    l: NDArray[np.float64]
    #: Unit vectors to the viewer, shape (n, 3).
    v: NDArray[np.float64]
    #: The BRDF in sr⁻¹ at 630, 550 and 465 nm, shape (n, 3).
    f: NDArray[np.float64]


def paint(name: str) -> Measurements:
    """The measurements of a paint by Cornell's light measurement laboratory: ``krylon_blue``, ``garnet_red`` or
    ``acryl_blue``. Beyond 71° they are unreliable."""
    rows = _lcm.paint(word("name", name)).reshape(-1, 7)
    theta, phi = np.radians(rows[:, [0, 2]]), np.radians(rows[:, [1, 3]])
    d = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    return Measurements(d[:, 0], d[:, 1], rows[:, 4:])
