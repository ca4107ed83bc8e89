"""Transforms as matrices of 4 x 4 that take column vectors to the world; `a @ b` applies b first.

Worlds are right-handed, unless a SceneBuilder is left-handed as the pbrt format: the same matrices are
its Translate, Scale, Rotate and LookAt, but a rotation is clockwise there.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy
from numpy.typing import ArrayLike, NDArray

__all__ = ["look_at", "rotate", "scale", "translate"]

Matrix = NDArray[numpy.float64]


def translate(x: float, y: float, z: float) -> Matrix:
    """Moves by a vector.

    x, y, z: the vector.
    """
    matrix = numpy.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def scale(x: float, y: float | None = None, z: float | None = None) -> Matrix:
    """Scales along the axes.

    x, y, z: the factors; y and z are x if they are not given.
    """
    return numpy.diag([x, x if y is None else y, x if z is None else z, 1.0])


def rotate(degrees: float, axis: Sequence[float]) -> Matrix:
    """Rotates about an axis through the origin, counterclockwise for who looks against it.

    degrees: the angle. axis: its direction.
    """
    x, y, z = _unit(_three("axis", axis))
    cross = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = numpy.radians(degrees)
    matrix = numpy.eye(4)
    # The formula of Rodrigues.
    matrix[:3, :3] += numpy.sin(angle) * cross + (1 - numpy.cos(angle)) * cross @ cross
    return matrix


def look_at(eye: ArrayLike, at: ArrayLike, up: ArrayLike = (0.0, 1.0, 0.0)) -> Matrix:
    """Places a camera or a light at a point, so that it looks at another one: its z is ahead and its y
    up, so that its x is to the left. In the world of a left-handed SceneBuilder it is to the right.

    eye: where it is. at: the point that it looks at. up: the direction that is up in the picture.
    """
    eye, at, up = _three("eye", eye), _three("at", at), _three("up", up)
    ahead = _unit(at - eye)
    side = _unit(numpy.cross(_unit(up), ahead))
    matrix = numpy.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = side, numpy.cross(ahead, side), ahead, eye
    return matrix


def _three(name: str, value: ArrayLike) -> NDArray[numpy.float64]:
    try:
        vector = numpy.asarray(value, numpy.float64)
    except (TypeError, ValueError):
        vector = numpy.empty(0)
    if vector.shape != (3,):
        raise ValueError(f"`{name}` is three numbers, not {value!r}")
    return vector


def _unit(vector: ArrayLike) -> NDArray[numpy.float64]:
    vector = numpy.asarray(vector, numpy.float64)
    length = float(numpy.linalg.norm(vector))
    if not length > 0:
        raise ValueError("a direction has no length: two points coincide, or `up` is the view's direction")
    return vector / length
