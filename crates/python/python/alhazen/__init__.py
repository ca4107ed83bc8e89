"""alhazen, a physically based renderer.

    import alhazen, numpy
    scene = alhazen.load("scene.pbrt")
    image = alhazen.render(scene, spp=64, resolution=(640, 480))
    numpy.asarray(image)        # height x width x 3, float32, linear light
    image.write("picture.png", view="agx")
"""

from ._alhazen import (
    Difference,
    Image,
    Progress,
    Scene,
    SceneError,
    __version__,
    compare,
    integrators,
    load,
    render,
)

__all__ = [
    "Difference",
    "Image",
    "Progress",
    "Scene",
    "SceneError",
    "compare",
    "integrators",
    "load",
    "render",
]
