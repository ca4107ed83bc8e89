"""alhazen, a physically based renderer.

    import alhazen, numpy
    scene = alhazen.load("scene.pbrt")
    image = alhazen.render(scene, spp=64, resolution=(640, 480))
    image.show()
    numpy.asarray(image)        # height x width x 3, float32, linear light
    image.write("picture.png", view="agx")
"""

from . import settings
from ._alhazen import (
    Difference,
    Film,
    Image,
    Job,
    Progress,
    Reference,
    RenderWarning,
    Scene,
    SceneBuilder,
    SceneError,
    SceneWarning,
    Typed,
    __version__,
    blackbody,
    compare,
    compile,
    integrators,
    load,
    render,
    rgb,
    spectrum,
)
from .notebook import live
from .transforms import look_at, rotate, scale, translate

__all__ = [
    "Difference",
    "Film",
    "Image",
    "Job",
    "Progress",
    "Reference",
    "RenderWarning",
    "Scene",
    "SceneBuilder",
    "SceneError",
    "SceneWarning",
    "Typed",
    "blackbody",
    "compare",
    "compile",
    "integrators",
    "live",
    "load",
    "look_at",
    "render",
    "rgb",
    "rotate",
    "scale",
    "settings",
    "spectrum",
    "translate",
]
