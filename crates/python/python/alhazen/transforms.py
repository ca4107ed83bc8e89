"""Transforms as matrices of 4 x 4 that take column vectors to the world; `a @ b` applies b first."""

from __future__ import annotations

from collections.abc import Sequence

import numpy
from numpy.typing import ArrayLike, NDArray

__all__ = ["look_at", "rotate", "scale", "translate"]

Matrix = NDArray[numpy.float64]


def translate(x: float, y: float, z: float) -> Matrix:
    """Moves by a vector."""
    matrix = numpy.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def scale(x: float, y: float | None = None, z: float | None = None) -> Matrix:
    """Scales along the axes, by the same factor if there is only one."""
    return numpy.diag([x, x if y is None else y, x if z is None else z, 1.0])


def rotate(degrees: float, axis: Sequence[float]) -> Matrix:
    """Rotates about an axis through the origin, counterclockwise for who looks against it."""
    x, y, z = _unit(axis)
    cross = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = numpy.radians(degrees)
    matrix = numpy.eye(4)
    # The formula of Rodrigues.
    matrix[:3, :3] += numpy.sin(angle) * cross + (1 - numpy.cos(angle)) * cross @ cross
    return matrix


def look_at(eye: ArrayLike, at: ArrayLike, up: ArrayLike = (0.0, 1.0, 0.0)) -> Matrix:
    """Places a camera at a point, so that it looks at another one. As in the pbrt format, the
    camera's system is left-handed: x to the right, y up, z ahead."""
    eye = numpy.asarray(eye, float)
    ahead = _unit(numpy.asarray(at, float) - eye)
    right = _unit(numpy.cross(_unit(up), ahead))
    matrix = numpy.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = right, numpy.cross(ahead, right), ahead, eye
    return matrix


def _unit(vector: ArrayLike) -> NDArray[numpy.float64]:
    vector = numpy.asarray(vector, numpy.float64)
    length = float(numpy.linalg.norm(vector))
    if not length > 0:
        raise ValueError("a direction has no length: two points coincide, or `up` is the view's direction")
    return vector / length
