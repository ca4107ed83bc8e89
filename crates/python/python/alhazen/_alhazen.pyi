from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import Any, final

import numpy
from numpy.typing import DTypeLike, NDArray

__version__: str

class SceneError(Exception): ...

@final
class Scene:
    @property
    def path(self) -> PathLike[str]: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def resolution(self) -> tuple[int, int]: ...
    @property
    def integrator(self) -> str: ...

@final
class Progress:
    @property
    def passes(self) -> int: ...
    @property
    def total(self) -> int | None: ...
    @property
    def seconds(self) -> float: ...
    @property
    def noise(self) -> float | None: ...

@final
class Image:
    @staticmethod
    def from_array(array: NDArray[numpy.float32]) -> Image: ...
    @staticmethod
    def open(path: str | PathLike[str]) -> Image: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def channels(self) -> list[str]: ...
    @property
    def layers(self) -> list[str]: ...
    @property
    def pixels(self) -> NDArray[numpy.float32]: ...
    @property
    def metadata(self) -> dict[str, Any]: ...
    def __array__(
        self, dtype: DTypeLike | None = None, copy: bool | None = None
    ) -> NDArray[numpy.float32]: ...
    def __getitem__(self, key: Any, /) -> NDArray[numpy.float32]: ...
    def write(
        self,
        path: str | PathLike[str],
        *,
        view: str = "standard",
        exposure: float = 0.0,
        white_balance: float | None = None,
    ) -> None: ...
    def png(
        self,
        *,
        view: str = "standard",
        exposure: float = 0.0,
        white_balance: float | None = None,
    ) -> bytes: ...

@final
class Difference:
    @property
    def mse(self) -> float: ...
    @property
    def rel_mse(self) -> float: ...
    @property
    def psnr(self) -> float: ...
    @property
    def max_error(self) -> float: ...
    @property
    def non_finite(self) -> int: ...
    @property
    def reference_mean(self) -> tuple[float, float, float]: ...
    @property
    def mean(self) -> tuple[float, float, float]: ...

def load(path: str | PathLike[str]) -> Scene: ...
def integrators() -> list[str]: ...
def render(
    scene: Scene | str | PathLike[str],
    *,
    spp: int | None = None,
    resolution: tuple[int, int] | None = None,
    integrator: str | None = None,
    seed: int | None = None,
    crop: tuple[float, float, float, float] | None = None,
    layers: Sequence[str] | None = None,
    settings: Mapping[str, Any] | None = None,
    time: float | None = None,
    noise: float | None = None,
    threads: int | None = None,
    progress: Callable[[Progress], object] | None = None,
    preview: Callable[[Image], object] | None = None,
) -> Image: ...
def compare(reference: Image, image: Image) -> Difference: ...
