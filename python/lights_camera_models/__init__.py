"""Reflection models of *Lights, Camera, Models!*: evaluated, drawn, explained and compared.

>>> import numpy as np, lights_camera_models as lcm
>>> ggx = lcm.Model("microfacet", alpha_x=0.3, alpha_y=0.3)
>>> angles = np.radians(np.linspace(0, 80, 9))
>>> v = np.stack([np.sin(angles), 0 * angles, np.cos(angles)], axis=-1)
>>> ggx.evaluate([0, 0, 1], v).shape
(9, 3)
"""

from ._figures import Figure, Measurements, paint, plot
from ._lcm import __version__
from ._models import Model, Parameter, add_model, models
from ._pictures import Comparison, compare, png
from ._scenes import Scene
from .errors import ModelError, SceneError

__all__ = [
    "Comparison", "Figure", "Measurements", "Model", "ModelError", "Parameter", "Scene", "SceneError", "__version__", "add_model",
    "compare", "models", "paint", "plot", "png",
]
