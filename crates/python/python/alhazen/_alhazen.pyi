from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal, final

import numpy
from numpy.typing import ArrayLike, DTypeLike, NDArray

from .settings import Settings

__version__: str

class SceneError(Exception):
    """A scene has errors; the text names all with their places."""
class SceneWarning(UserWarning):
    """Something of a scene is rendered differently than described, or has no effect."""
class RenderWarning(UserWarning):
    """A picture is not what was asked for: it has more noise, or lacks samples."""

@final
class Scene:
    """A scene, as its author described it. It is compiled anew for each render."""
    @property
    def path(self) -> Path:
        """The file that it was loaded from."""
    @property
    def warnings(self) -> list[str]:
        """Warnings of its reading, such as of parameters that have no effect."""
    @property
    def resolution(self) -> tuple[int, int]:
        """Width and height of the picture in pixels."""
    @property
    def integrator(self) -> str:
        """The name of its integrator."""
    def pack(self) -> bytes:
        """The bytes of one archive with all its files, as `alhazen scene pack` writes it. load() reads
        it, wherever it is. Equal scenes have equal archives.
        """

@final
class Progress:
    """How far a render is."""
    @property
    def passes(self) -> int:
        """Passes done."""
    @property
    def total(self) -> int | None:
        """All passes; None if that is not known yet."""
    @property
    def seconds(self) -> float:
        """Seconds of rendering."""
    @property
    def noise(self) -> float | None:
        """The relative standard error of the picture, where it was estimated."""

@final
class Image:
    """A picture: linear light, and layers beside it.

    numpy.asarray(picture) is height × width × 3 float32, red, green and blue, in the memory of the
    picture. picture["depth"] is a layer: height × width, or height × width × n if it has n
    channels. Its name is that of compile(layers=[…]), or that in a file, such as "Z".
    """
    @staticmethod
    def from_array(array: ArrayLike) -> Image:
        """A picture of an array.

        array: height × width × 3 real numbers, linear light.
        """
    @staticmethod
    def open(path: str | PathLike[str]) -> Image:
        """Reads a picture from a file.

        path: a file of any format that alhazen knows, such as .exr, .png or .hdr.
        """
    @property
    def width(self) -> int:
        """The number of columns."""
    @property
    def height(self) -> int:
        """The number of rows."""
    @property
    def shape(self) -> tuple[int, int, int]:
        """The shape of numpy.asarray(picture): height, width and 3."""
    @property
    def channels(self) -> list[str]:
        """The names of all channels."""
    @property
    def layers(self) -> list[str]:
        """The names of the layers, in the order of their channels."""
    @property
    def pixels(self) -> NDArray[numpy.float32]:
        """The pixels of all channels: height × width × number of channels."""
    @property
    def metadata(self) -> dict[str, Any]:
        """Facts about the picture, such as the integrator and the samples per pixel."""
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
    ) -> None:
        """Writes the picture to a file in the format of its extension.

        path: the file. EXR files keep all channels and stay linear; other formats keep the colours,
        and warn where there are layers. Formats for displays, such as PNG, show them through a
        view.

        view: "standard" (sRGB), "agx", "aces", "khronos-neutral" or "filmic". exposure: in stops.
        white_balance: the colour temperature of the light that becomes white, in kelvin.
        """
    def save(
        self,
        path: str | PathLike[str],
        *,
        view: str = "standard",
        exposure: float = 0.0,
        white_balance: float | None = None,
    ) -> None:
        """The same as write().

        path, view, exposure, white_balance: as those of write().
        """
    def show(
        self,
        *,
        view: str = "standard",
        exposure: float = 0.0,
        white_balance: float | None = None,
    ) -> None:
        """Shows the picture: below the cell of a notebook, else in the viewer of the system.

        view, exposure, white_balance: as those of write().
        """
    def png(
        self,
        *,
        view: str = "standard",
        exposure: float = 0.0,
        white_balance: float | None = None,
    ) -> bytes:
        """The bytes of a PNG file that shows the picture through a view.

        view, exposure, white_balance: as those of write().
        """

@final
class Difference:
    """How far a picture is from a reference, over all pixels and colours."""
    @property
    def mse(self) -> float:
        """Mean squared error."""
    @property
    def rel_mse(self) -> float:
        """Mean of squared errors over the reference squared plus 0.01."""
    @property
    def psnr(self) -> float:
        """Peak signal-to-noise ratio in decibels, for a peak of 1."""
    @property
    def max_error(self) -> float:
        """The largest absolute error."""
    @property
    def non_finite(self) -> int:
        """The number of values that are not finite, which are left out."""
    @property
    def reference_mean(self) -> tuple[float, float, float]:
        """Means of the reference's colours."""
    @property
    def mean(self) -> tuple[float, float, float]:
        """Means of the picture's colours."""

@final
class Reference:
    """A thing of a SceneBuilder that others refer to: a texture, material, medium or object."""
    @property
    def kind(self) -> str:
        """The kind of object, such as "material"."""
    @property
    def name(self) -> str:
        """Its name in the scene."""

@final
class Typed:
    """A value of a stated type of the format, such as rgb(0.2, 0.4, 0.1)."""
    @property
    def type_name(self) -> str:
        """The name of the type."""
    @property
    def values(self) -> Any:
        """The values."""

@final
class SceneBuilder:
    """Builds a scene: each call is a statement of the pbrt-v4 format, with the names of its types and
    parameters. Arrays of numpy are copied, so that they may be changed afterwards.

        builder = alhazen.SceneBuilder()
        builder.camera("perspective", fov=40, transform=alhazen.look_at((0, 1, 5), (0, 0, 0)))
        red = builder.material("diffuse", reflectance=(0.7, 0.1, 0.1))
        builder.shape("trianglemesh", P=points, indices=triangles, material=red)
        builder.light("infinite", L=1.0)
        scene = builder.build()

    A number for a colour is a grey, three are linear red, green and blue; rgb(), spectrum() and
    blackbody() state what is meant. A transform is a matrix of 4 × 4 that takes
    columns to the world, or two of them for the start and the end of the shutter time.

    handedness: that of the world, "right" as in glTF, OBJ, Blender and arrays of most programs, or
    "left" as in the pbrt format, for scenes that are typed from there.
    """
    def __init__(self, *, handedness: Literal["left", "right"] = "right") -> None: ...
    @property
    def handedness(self) -> Literal["left", "right"]:
        """The handedness of its world, "right" or "left"."""
    def film(self, kind: str | Settings | None = None, /, **parameters: Any) -> None:
        """Sets the film.

        kind: its type, by default "rgb", or alhazen.settings.film(). parameters: such as
        xresolution.
        """
    def sampler(self, kind: str | Settings, /, **parameters: Any) -> None:
        """Sets the sampler.

        kind: its type, such as "zsobol", or alhazen.settings.sampler.zsobol() and the like.
        parameters: such as pixelsamples.
        """
    def filter(self, kind: str | Settings, /, **parameters: Any) -> None:
        """Sets the pixel filter.

        kind: its type, such as "gaussian", or alhazen.settings.filter.gaussian() and the like.
        parameters: such as xradius.
        """
    def integrator(self, kind: str | Settings, /, **parameters: Any) -> None:
        """Sets the algorithm.

        kind: its name, such as "path", or alhazen.settings.integrator.path() and the like.
        parameters: such as maxdepth.
        """
    def options(self, **options: Any) -> None:
        """Sets options of the whole scene.

        options: by name, such as seed.
        """
    def camera(
        self,
        kind: str | Settings | None = None,
        /,
        *,
        transform: ArrayLike | None = None,
        medium: Reference | None = None,
        **parameters: Any,
    ) -> None:
        """Sets the camera.

        kind: its type, by default "perspective", or alhazen.settings.camera(). parameters: such as
        fov. transform: its place, as look_at() gives it: it looks along +z of its own system, with
        y up. One of Blender, glTF or OpenGL looks along -z: matrix @ alhazen.rotate(180, (0, 1,
        0)). medium: the one around it.
        """
    def texture(
        self, values: str, kind: str, /, *, transform: ArrayLike | None = None, **parameters: Any
    ) -> Reference:
        """Adds a texture.

        values: "float" or "spectrum". kind: its type, such as "imagemap". parameters: such as
        filename. transform: the place of a texture of space.
        """
    def material(self, kind: str, /, **parameters: Any) -> Reference:
        """Adds a material.

        kind: its type, such as "diffuse". parameters: such as reflectance, whose colours are from 0
        to 1.
        """
    def medium(
        self, kind: str, /, *, transform: ArrayLike | None = None, **parameters: Any
    ) -> Reference:
        """Adds a participating medium.

        kind: its type, such as "homogeneous". parameters: such as sigma_s. transform: its place.
        """
    def light(
        self,
        kind: str,
        /,
        *,
        transform: ArrayLike | None = None,
        medium: Reference | None = None,
        **parameters: Any,
    ) -> None:
        """Adds a light.

        kind: its type, such as "point". parameters: such as I. transform: its place. The image of
        the light "infinite" has +z up and -x in its middle; "projection" looks along +z, as cameras
        do. medium: the one that it is in.
        """
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
    ) -> None:
        """Adds a shape.

        kind: its type, such as "sphere" or "trianglemesh". parameters: such as P and indices.
        transform: its place. material: its material, by default a grey one. emission: the
        parameters of an area light, as a dict such as {"L": 5.0}, or only its L. inside, outside:
        the media on its two sides. object: the object that it belongs to, instead of the world.
        reverse_orientation: turns its surface inside out.
        """
    def object(self) -> Reference:
        """Adds an object, to which shapes and instances can be added. It is drawn where it has
        instances.
        """
    def instance(
        self,
        object: Reference,
        /,
        *,
        transform: ArrayLike | None = None,
        into: Reference | None = None,
    ) -> None:
        """Adds an instance of an object.

        object: what object() gave. transform: its place. into: the object that it becomes part of,
        instead of the world.
        """
    def build(self) -> Scene:
        """The scene of all calls so far. Files that it names are relative to the current folder.

        Raises SceneError, whose text lists every error with the call that has caused it and its
        place in the program.
        """

def rgb(red: float, green: float, blue: float) -> Typed:
    """A colour.

    red, green, blue: linear light, from 0 to 1 for reflectances.
    """
def spectrum(values: Any) -> Typed:
    """A spectrum.

    values: the name of a measured one, such as "metal-Au-eta", or of a file; or an array of
    wavelengths in nanometres and values in turn.
    """
def blackbody(kelvin: float) -> Typed:
    """The spectrum of a black body.

    kelvin: its temperature.
    """

@final
class Job:
    """A scene compiled for rendering with certain settings. What is rendered several times, whole or
    in shards, is compiled once.
    """
    @property
    def path(self) -> Path:
        """The scene file."""
    @property
    def warnings(self) -> list[str]:
        """Differences between the picture and its description."""
    @property
    def passes(self) -> int:
        """The number of passes that are planned, each of one sample per pixel."""
    def render(
        self,
        *,
        time: float | None = None,
        noise: float | None = None,
        threads: int | None = None,
        progress: Callable[[Progress], object] | bool | None = None,
        preview: Callable[[Image], object] | None = None,
    ) -> Image:
        """Renders a picture.

        time: seconds after which no pass is begun. noise: the relative error at which it ends. With
        one of these and no spp of compile(), the number of passes has no limit. threads: their
        number, by default one for each core. progress: True for a line with the time left on
        standard error, or a function that is called with a Progress after passes. preview: called
        with an Image now and then, at last with the result.

        Ctrl-C ends it with KeyboardInterrupt; an exception of a callback ends it, too.
        """
    def render_shard(
        self,
        index: int,
        count: int,
        *,
        alternate: bool = False,
        limited: bool = False,
        threads: int | None = None,
        progress: Callable[[Progress], object] | bool | None = None,
        preview: Callable[[Image], object] | None = None,
    ) -> Film:
        """Renders one of several parts of the passes, counted from 1. The films of all parts merge to
        one whose picture has the same bits as that of render().

        index: which one. count: their number. alternate: whether its passes alternate between two
        films, from which the noise of the picture is estimated. limited: whether time or noise ends
        the render of all parts, so that without spp of compile() the number of passes has no limit.
        threads, progress, preview: as those of render().
        """
    def blank_film(self, *, alternate: bool = False, limited: bool = False) -> Film:
        """A film of this job without any pass. Only films of the same job merge with it.

        alternate, limited: as those of render_shard().
        """

@final
class Film:
    """The film of a render or of some of its shards, with exact sums: merged in any order, shards give
    the bits of the whole. It is what the command line writes with --checkpoint.
    """
    @staticmethod
    def open(path: str | PathLike[str]) -> Film:
        """Reads a film file.

        path: the file.
        """
    @staticmethod
    def from_bytes(data: bytes) -> Film:
        """A film of the bytes of a film file.

        data: the bytes.
        """
    @property
    def passes(self) -> int:
        """The number of passes that it has."""
    @property
    def planned(self) -> int | None:
        """The number of passes of the whole render; None where only time or noise ends it."""
    @property
    def shards(self) -> list[tuple[int, int]]:
        """The shards that it has, as (index, count)."""
    @property
    def missing(self) -> list[str]:
        """The shards and passes that it lacks, by name; it is whole if there are none."""
    @property
    def noise(self) -> float | None:
        """The estimated relative standard error of its picture; None if its passes do not alternate
        between two films, or are too few.
        """
    def merge(self, other: Film | bytes) -> None:
        """Adds another film of the same render. Raises ValueError, and leaves this one as it was, if
        it is of another render or has passes that this one has.

        other: a Film, or the bytes of a film file.
        """
    def image(self) -> Image:
        """The picture of its passes."""
    def write(self, path: str | PathLike[str]) -> None:
        """Writes its film file.

        path: the file. One that is there is replaced only when the new one is whole.
        """
    def __bytes__(self) -> bytes: ...

def load(source: str | PathLike[str] | bytes) -> Scene:
    """Loads a scene.

    source: a pbrt-v4 file, a glTF file (.gltf, .glb), a USD file, a mesh (.ply, .obj, .stl) in a
    neutral studio, or an archive (.zip) of a scene with its files, which may be given as bytes.

    Raises SceneError, whose text lists every error of the scene with its file, line and column, and
    FileNotFoundError and the like where there is no such file.
    """
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
) -> Job:
    """Compiles a scene, or the scene of a file.

    scene: a Scene, or what load() takes. spp: samples per pixel. resolution: (width, height) of the
    whole picture. integrator: the name of an algorithm, see integrators(), or
    alhazen.settings.integrator.path(maxdepth=8) and the like. seed: of all random numbers. crop:
    the part to render, as fractions (x0, x1, y0, y1) from 0 to 1 with y down. layers: names of
    layers beside the colours, such as "depth". settings: values by name, as in
    {"integrator.maxdepth": 8}, or settings of alhazen.settings, one or several.
    """
def integrators() -> list[str]:
    """The names of all integrators."""
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
) -> Image:
    """Renders a scene, or the scene of a file, to a picture: compile() and Job.render() in one call.

    scene: a Scene, or what load() takes. spp: samples per pixel. resolution: (width, height) of the
    whole picture. integrator: the name of an algorithm, see integrators(), or
    alhazen.settings.integrator.path(maxdepth=8) and the like. seed: of all random numbers. crop:
    the part to render, as fractions (x0, x1, y0, y1) from 0 to 1 with y down. layers: names of
    layers beside the colours, such as "depth". settings: values by name, as in
    {"integrator.maxdepth": 8}, or settings of alhazen.settings, one or several.

    time: seconds after which no pass is begun. noise: the relative error at which it ends.
    threads: their number, by default one for each core. progress: True for a line with the time
    left on standard error, or a function that is called with a Progress after passes. preview:
    called with an Image now and then, at last with the result.

    Ctrl-C ends it with KeyboardInterrupt; an exception of a callback ends it, too.
    """
def compare(reference: Image, image: Image) -> Difference:
    """Compares two pictures of the same size.

    reference: what is right. image: what is compared with it.
    """
