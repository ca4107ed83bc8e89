from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal, final

import numpy
from numpy.typing import ArrayLike, DTypeLike, NDArray

from .settings import Settings

__version__: str

class SceneError(Exception): ...

@final
class Scene:
    @property
    def path(self) -> Path: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def resolution(self) -> tuple[int, int]: ...
    @property
    def integrator(self) -> str: ...
    def pack(self) -> bytes: ...

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
    def from_array(array: ArrayLike) -> Image: ...
    @staticmethod
    def open(path: str | PathLike[str]) -> Image: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def shape(self) -> tuple[int, int, int]: ...
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
    def save(
        self,
        path: str | PathLike[str],
        *,
        view: str = "standard",
        exposure: float = 0.0,
        white_balance: float | None = None,
    ) -> None: ...
    def show(
        self,
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

@final
class Reference:
    @property
    def kind(self) -> str: ...
    @property
    def name(self) -> str: ...

@final
class Typed:
    @property
    def type_name(self) -> str: ...
    @property
    def values(self) -> Any: ...

@final
class SceneBuilder:
    def __init__(self, *, handedness: Literal["left", "right"] = "right") -> None: ...
    @property
    def handedness(self) -> Literal["left", "right"]: ...
    def film(self, kind: str | Settings | None = None, /, **parameters: Any) -> None: ...
    def sampler(self, kind: str | Settings, /, **parameters: Any) -> None: ...
    def filter(self, kind: str | Settings, /, **parameters: Any) -> None: ...
    def integrator(self, kind: str | Settings, /, **parameters: Any) -> None: ...
    def options(self, **options: Any) -> None: ...
    def camera(
        self,
        kind: str | Settings | None = None,
        /,
        *,
        transform: ArrayLike | None = None,
        medium: Reference | None = None,
        **parameters: Any,
    ) -> None: ...
    def texture(
        self, values: str, kind: str, /, *, transform: ArrayLike | None = None, **parameters: Any
    ) -> Reference: ...
    def material(self, kind: str, /, **parameters: Any) -> Reference: ...
    def medium(
        self, kind: str, /, *, transform: ArrayLike | None = None, **parameters: Any
    ) -> Reference: ...
    def light(
        self,
        kind: str,
        /,
        *,
        transform: ArrayLike | None = None,
        medium: Reference | None = None,
        **parameters: Any,
    ) -> None: ...
    def shape(
        self,
        kind: str,
        /,
        *,
        transform: ArrayLike | None = None,
        material: Reference | None = None,
        emission: Any = None,
        inside: Reference | None = None,
        outside: Reference | None = None,
        object: Reference | None = None,
        reverse_orientation: bool = False,
        **parameters: Any,
    ) -> None: ...
    def object(self) -> Reference: ...
    def instance(
        self,
        object: Reference,
        /,
        *,
        transform: ArrayLike | None = None,
        into: Reference | None = None,
    ) -> None: ...
    def build(self) -> Scene: ...

def rgb(red: float, green: float, blue: float) -> Typed: ...
def spectrum(values: Any) -> Typed: ...
def blackbody(kelvin: float) -> Typed: ...

@final
class Job:
    @property
    def path(self) -> Path: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def passes(self) -> int: ...
    def render(
        self,
        *,
        time: float | None = None,
        noise: float | None = None,
        threads: int | None = None,
        progress: Callable[[Progress], object] | bool | None = None,
        preview: Callable[[Image], object] | None = None,
    ) -> Image: ...
    def render_shard(
        self,
        index: int,
        count: int,
        *,
        alternate: bool = False,
        threads: int | None = None,
        progress: Callable[[Progress], object] | bool | None = None,
        preview: Callable[[Image], object] | None = None,
    ) -> Film: ...
    def blank_film(self, *, alternate: bool = False) -> Film: ...

@final
class Film:
    @staticmethod
    def open(path: str | PathLike[str]) -> Film: ...
    @staticmethod
    def from_bytes(data: bytes) -> Film: ...
    @property
    def passes(self) -> int: ...
    @property
    def shards(self) -> list[tuple[int, int]]: ...
    @property
    def missing(self) -> list[str]: ...
    @property
    def noise(self) -> float | None: ...
    def merge(self, other: Film | bytes) -> None: ...
    def image(self) -> Image: ...
    def write(self, path: str | PathLike[str]) -> None: ...
    def __bytes__(self) -> bytes: ...

def load(source: str | PathLike[str] | bytes) -> Scene: ...
def compile(
    scene: Scene | str | PathLike[str] | bytes,
    *,
    spp: int | None = None,
    resolution: tuple[int, int] | None = None,
    integrator: str | Settings | None = None,
    seed: int | None = None,
    crop: tuple[float, float, float, float] | None = None,
    layers: Sequence[str] | None = None,
    settings: Mapping[str, Any] | Settings | Sequence[Settings] | None = None,
) -> Job: ...
def integrators() -> list[str]: ...
def render(
    scene: Scene | str | PathLike[str] | bytes,
    *,
    spp: int | None = None,
    resolution: tuple[int, int] | None = None,
    integrator: str | Settings | None = None,
    seed: int | None = None,
    crop: tuple[float, float, float, float] | None = None,
    layers: Sequence[str] | None = None,
    settings: Mapping[str, Any] | Settings | Sequence[Settings] | None = None,
    time: float | None = None,
    noise: float | None = None,
    threads: int | None = None,
    progress: Callable[[Progress], object] | bool | None = None,
    preview: Callable[[Image], object] | None = None,
) -> Image: ...
def compare(reference: Image, image: Image) -> Difference: ...
