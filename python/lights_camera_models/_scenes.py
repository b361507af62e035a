"""Scenes: read, changed, drawn and explained."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _lcm
from ._arrays import light_samples_of, real, size_of, to_json, whole, word
from .errors import SceneError

DEFAULT_SIZE = (640, 360)
_MAX_BYTES = 64 << 20


class Scene:
    """A checked scene: a room with lights, objects and one observer. It does not change; :meth:`set` returns another.

    In notebooks it shows its picture. Make one with :meth:`new`, :meth:`from_json` or :meth:`from_dict`.
    """

    __slots__ = ("_core", "_folder")

    def __init__(self) -> None:
        raise TypeError("use Scene.new(), Scene.from_json(…) or Scene.from_dict(…)")

    @classmethod
    def _of(cls, core: _lcm.Scene, folder: str) -> Scene:
        scene = object.__new__(cls)
        scene._core, scene._folder = core, folder
        return scene

    @classmethod
    def _restored(cls, text: str, folder: str, custom: list[tuple[str, str]]) -> Scene:
        return cls._of(_lcm.Scene(text, "", folder, True, custom), folder)

    @classmethod
    def new(cls) -> Scene:
        """The default scene: one light and one sphere."""
        return cls._of(_lcm.Scene.default(), os.getcwd())

    @classmethod
    def from_json(
        cls, source: str | os.PathLike[str], *, use_defaults: bool = False, folder: str | os.PathLike[str] | None = None
    ) -> Scene:
        """Reads a scene.

        Parameters
        ----------
        source
            A path, or the text of a scene, which begins with ``{``.
        folder
            The folder of the files that the scene names: that of the path, or for a text the current one.
        use_defaults
            True to use the default for missing parts that a scene should have, instead of refusing it.

        Raises
        ------
        SceneError
            With every problem: its path, its line, and the rule that is broken.
        OSError
            If the file cannot be read.
        """
        if isinstance(source, str) and source.lstrip("\ufeff \t\r\n").startswith("{"):
            home = os.path.abspath(folder or os.getcwd())
            return cls._of(_lcm.Scene(source, "the scene", home, bool(use_defaults)), home)
        if not isinstance(source, (str, os.PathLike)):
            raise TypeError(f"the source is of type {type(source).__name__}, but it must be a path or a text")
        if not str(source):
            raise SceneError("the source is empty, but it must be a path, or a text that begins with {")
        path = Path(source)
        with open(path, "rb") as file:
            raw = file.read(_MAX_BYTES + 1)
        if len(raw) > _MAX_BYTES:
            raise SceneError(f"{path} is larger than 64 MiB, the most allowed for a scene; it was not read")
        try:
            text = raw.decode()
        except UnicodeDecodeError as why:
            raise SceneError(f"{path} is not UTF-8 text: {why}") from None
        home = os.path.abspath(folder or path.parent)
        return cls._of(_lcm.Scene(text, str(path), home, bool(use_defaults)), home)

    @classmethod
    def from_dict(
        cls, scene: dict[str, Any], *, use_defaults: bool = False, folder: str | os.PathLike[str] | None = None
    ) -> Scene:
        """Makes a scene from a dictionary with the keys of a scene file; see :meth:`from_json`."""
        home = os.path.abspath(folder or os.getcwd())
        return cls._of(_lcm.Scene(to_json("the scene", scene, SceneError), "", home, bool(use_defaults)), home)

    def to_json(self, indent: int | None = None) -> str:
        """The text of a scene file."""
        text = self._core.to_json()
        return text if indent is None else json.dumps(json.loads(text), indent=indent, ensure_ascii=False)

    def to_dict(self) -> dict[str, Any]:
        """The scene as a dictionary."""
        return json.loads(self._core.to_json())

    def __getitem__(self, path: str) -> Any:
        """The value at a path, such as ``scene["objects[0].material.roughness"]``, given or by default."""
        return json.loads(self._core.value(word("the path", path)))

    def set(self, values: dict[str, Any] | None = None, /, **named: Any) -> Scene:
        """The scene with other values.

        Parameters
        ----------
        values
            New values by path: ``{"objects[0].material.roughness": 0.4}``.
        named
            Values of the scene itself: ``reflection_model="phong"``.

        Raises
        ------
        SceneError
            For a path that does not exist, with the nearest, and for a value that breaks a rule.
        """
        written = []
        for path, value in {**(values or {}), **named}.items():
            written.append((word("a path", path), to_json(path, value, SceneError)))
        return type(self)._of(self._core.with_values(written), self._folder)

    @property
    def views(self) -> int:
        """The number of views: 1, and 1 for each variant."""
        return self._core.views()

    def render(
        self,
        size: tuple[int, int] = DEFAULT_SIZE,
        samples: int = 4,
        *,
        view: str = "A",
        terms: str = "all",
        channel: str | None = None,
        light_samples: int | None = None,
        noise: float | None = None,
        linear: bool = False,
        coverage: bool = False,
    ) -> NDArray[Any]:
        """The picture of one view by the CPU renderer: the bytes of ``lcm render --renderer cpu --view A``.

        Parameters
        ----------
        size
            Width and height in pixels.
        samples
            Samples per pixel: 4 for smooth edges, or 1.
        view
            A, B, C or D, or the name of a variant.
        terms
            ``all``, ``ambient``, ``diffuse``, ``specular`` or ``transmitted``.
        channel
            A debug channel instead of the picture, such as ``normals``; a wrong name lists all.
        light_samples
            The largest number of samples of lights with extent, and of ways through rough bodies: 256, or 65536 if noise is
            given.
        noise
            The relative noise, such as 0.01, at which a picture with such light is finished earlier.
        linear
            True for light before exposure and tone curve: linear, Rec. 709.
        coverage
            True to add the part of a pixel that objects and visible lights cover as a fourth component; for linear
            pictures.

        Returns
        -------
        array
            uint8 of shape (height, width, 3), sRGB; or, if linear, float32 of shape (height, width, 3 or 4).
        """
        width, height = size_of(size)
        if whole("samples", samples, 1, 4) not in (1, 4):
            raise ValueError(f"samples is {samples!r}, but it must be 1 or 4")
        if noise is not None and not 0.0 < real("noise", noise) <= 1.0:
            raise ValueError(f"noise is {noise!r}, but it must be greater than 0 and at most 1; 0.01 is 1 %")
        most = light_samples_of(light_samples, noise)
        view, terms = word("view", view), word("terms", terms)
        if coverage and not linear:
            raise ValueError("coverage is for linear pictures; add linear=True")
        if linear:
            if channel is not None:
                raise ValueError(f"channel {channel!r} has display codes, no light; omit linear")
            light = self._core.light([width, height], samples, view, terms, most, noise)
            light = light.reshape(height, width, 4)
            return light if coverage else np.ascontiguousarray(light[..., :3])
        channel = None if channel is None else word("channel", channel)
        codes = self._core.codes([width, height], samples, view, terms, channel, most, noise)
        return codes.reshape(height, width, 3)

    def explain(
        self, x: int, y: int, size: tuple[int, int] = DEFAULT_SIZE, *, view: str = "A", terms: str = "all"
    ) -> dict[str, Any]:
        """The colour of a pixel with every number behind it, as a dictionary: that of ``lcm explain --json``.

        ``x`` and ``y`` count from 0 at the top left, in a picture of this size.
        """
        return json.loads(self._explained(x, y, size, view, terms, False)[0])

    def explain_text(
        self,
        x: int,
        y: int,
        size: tuple[int, int] = DEFAULT_SIZE,
        *,
        view: str = "A",
        terms: str = "all",
        markdown: bool = False,
    ) -> str:
        """Like :meth:`explain`, as text for people, or as Markdown."""
        return self._explained(x, y, size, view, terms, markdown)[1]

    def _explained(
        self, x: int, y: int, size: tuple[int, int], view: str, terms: str, markdown: bool
    ) -> tuple[str, str]:
        width, height = size_of(size)
        pixel = [whole("x", x, 0, width - 1), whole("y", y, 0, height - 1)]
        return self._core.explain(pixel, [width, height], word("view", view), word("terms", terms), bool(markdown))

    def match(
        self, view: str = "B", on: str = "lobe", free: list[str] | None = None, metric: str = "cosine"
    ) -> tuple[dict[str, Any], Scene]:
        """The parameters of a view that come nearest to view A.

        Parameters
        ----------
        view
            The view whose parameters are searched.
        on
            What is compared: ``lobe``, ``picture`` or ``highlight``.
        free
            The parameters that are free; by default every number, and beside a measurement every colour too.
        metric
            The metric of lobes: ``cosine`` (Ngan and others 2005), ``log`` (Löw and others 2012) or ``cube-root`` (Fores and
            others 2012).

        Returns
        -------
        found, scene
            What was found (``values``, ``unchanged``, those of them ``without_effect``, those ``ambiguous``, of which other
            values, changed together, come as near, the error ``before`` and ``after``, its ``unit``, the number of
            ``evaluations``, and what ``ended`` the search: ``search`` itself, or the limit of ``evaluations`` or of
            ``time``), and the scene with these values.
        """
        names = None if free is None else [word("a free parameter", name) for name in free]
        found, scene = self._core.matched(word("view", view), word("on", on), names, word("metric", metric))
        return json.loads(found), type(self)._of(scene, self._folder)

    def _repr_png_(self) -> bytes:
        return _lcm.png(self.render())

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self)._restored, (self._core.to_json(), self._folder, self._core.custom())

    def _key(self) -> tuple[str, str, tuple[tuple[str, str], ...]]:
        folder = self._folder if self._core.names_files() else ""
        return self._core.to_json(), folder, tuple(self._core.custom())

    def __eq__(self, other: object) -> bool:
        """True if both have the same values and models, and their files are in the same folder."""
        return self._key() == other._key() if isinstance(other, Scene) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key())

    def __repr__(self) -> str:
        told = self.to_dict()
        counts = {"object": len(told.get("objects", [])), "light": len(told.get("lights", [])), "view": self.views}
        words = ", ".join(f"{n} {what}{'' if n == 1 else 's'}" for what, n in counts.items())
        return f"<Scene {told.get('name') or 'without a name'!r}: {told.get('reflection_model')}, {words}>"
