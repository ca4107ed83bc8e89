"""Settings of a scene, with their types and ranges: generated from the schema of settings.

    alhazen.render(scene, integrator=settings.integrator.path(maxdepth=8))
    alhazen.render(scene, settings=[settings.film(iso=200), settings.sampler.sobol()])
    builder.integrator(settings.integrator.bdpt())

A setting that is not given keeps the value of the scene, or its default.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal


@dataclass(frozen=True)
class Settings:
    """Some settings of a part of a scene."""

    #: The part, such as "integrator".
    part: str
    #: The chosen member of a set, such as "path"; None if there is no choice.
    name: str | None
    #: Values by name.
    values: dict[str, Any] = field(default_factory=dict)


def _given(part: str, name: str | None, values: dict[str, Any]) -> Settings:
    given = {key.replace("_", "-"): value for key, value in values.items() if value is not None}
    return Settings(part, name, given)


class integrator:
    """A choice of the integrator, with its settings."""

    @staticmethod
    def ray_casting() -> Settings:
        """Primary rays only; lights are added without shadows."""
        return _given("integrator", "ray-casting", dict(locals()))

    @staticmethod
    def whitted(
        *,
        maxdepth: int | None = None,
        ambient: bool | None = None,
        reflections: Literal["traced", "environment", "hybrid"] | None = None,
        reflectiondistance: float | None = None,
        reflectionresolution: int | None = None,
    ) -> Settings:
        """Primary and shadow rays, mirror reflection and refraction.

        maxdepth: a whole number of 0 or more, by default 5. Maximum number of scattering events of
        a path.

        ambient: true or false, by default false. Light of a sky of one colour reaches all surfaces,
        as if nothing were in between: no rays look for its shadows.

        reflections: one of traced, environment, hybrid, by default traced. Where the light of
        mirror reflections is from.

        reflectiondistance: a number above 0 scene units. With `hybrid`, the distance from which on
        the picture is used; from half of it on it is blended in. If absent, a quarter of the
        scene's radius.

        reflectionresolution: a whole number from 2 to 4096 pixels, by default 256. Resolution of
        the picture of an object's surroundings along an edge.
        """
        return _given("integrator", "whitted", dict(locals()))

    @staticmethod
    def ambient_occlusion(
        *,
        cossample: bool | None = None,
        maxdistance: float | None = None,
    ) -> Settings:
        """The unoccluded share of the hemisphere over each point.

        cossample: true or false, by default true. Sample directions by the cosine (less noise)
        instead of uniformly.

        maxdistance: a number above 0 scene units, by default inf. Surfaces farther away than this
        do not occlude.
        """
        return _given("integrator", "ambient-occlusion", dict(locals()))

    @staticmethod
    def random_walk(
        *,
        maxdepth: int | None = None,
    ) -> Settings:
        """Paths in uniform directions, without next-event estimation.

        maxdepth: a whole number of 0 or more, by default 5. Maximum number of scattering events of
        a path.
        """
        return _given("integrator", "random-walk", dict(locals()))

    @staticmethod
    def simple_path(
        *,
        maxdepth: int | None = None,
        samplelights: bool | None = None,
        samplebsdf: bool | None = None,
    ) -> Settings:
        """Paths that sample lights or the BSDF, without weighting one against the other.

        maxdepth: a whole number of 0 or more, by default 5. Maximum number of scattering events of
        a path.

        samplelights: true or false, by default true. Sample lights at each vertex.

        samplebsdf: true or false, by default true. Sample directions from the BSDF instead of
        uniformly.
        """
        return _given("integrator", "simple-path", dict(locals()))

    @staticmethod
    def path(
        *,
        maxdepth: int | None = None,
        regularize: bool | None = None,
        lightsampler: Literal["uniform", "power", "bvh", "exhaustive"] | None = None,
    ) -> Settings:
        """Path tracing with next-event estimation and multiple importance sampling.

        maxdepth: a whole number of 0 or more, by default 5. Maximum number of scattering events of
        a path.

        regularize: true or false, by default false. Roughen surfaces after the first bounce that is
        not specular.

        lightsampler: one of uniform, power, bvh, exhaustive, by default bvh. How a light is chosen
        for next-event estimation.
        """
        return _given("integrator", "path", dict(locals()))

    @staticmethod
    def vol_path(
        *,
        maxdepth: int | None = None,
        regularize: bool | None = None,
        lightsampler: Literal["uniform", "power", "bvh", "exhaustive"] | None = None,
    ) -> Settings:
        """Path tracing through participating media; without media, like `path`: the format's
        default.

        maxdepth: a whole number of 0 or more, by default 5. Maximum number of scattering events of
        a path.

        regularize: true or false, by default false. Roughen surfaces after the first bounce that is
        not specular.

        lightsampler: one of uniform, power, bvh, exhaustive, by default bvh. How a light is chosen
        for next-event estimation.
        """
        return _given("integrator", "vol-path", dict(locals()))

    @staticmethod
    def light_tracing(
        *,
        maxdepth: int | None = None,
    ) -> Settings:
        """Paths from lights, each vertex connected to the camera.

        maxdepth: a whole number of 0 or more, by default 5. Maximum number of scattering events of
        a path.
        """
        return _given("integrator", "light-tracing", dict(locals()))

    @staticmethod
    def bdpt(
        *,
        maxdepth: int | None = None,
        regularize: bool | None = None,
        visualizestrategies: bool | None = None,
        visualizeweights: bool | None = None,
    ) -> Settings:
        """Bidirectional path tracing.

        maxdepth: a whole number of 0 or more, by default 5. Maximum number of scattering events of
        a path.

        regularize: true or false, by default false. Roughen surfaces after the first bounce that is
        not specular.

        visualizestrategies: true or false, by default false. Write a picture of each strategy of up
        to 8 scattering events. All of them take 2.4 KiB per pixel at a depth of 5.

        visualizeweights: true or false, by default false. Write a weighted picture of each strategy
        of up to 8 scattering events.
        """
        return _given("integrator", "bdpt", dict(locals()))

    @staticmethod
    def mlt(
        *,
        technique: Literal["path", "bdpt"] | None = None,
        maxdepth: int | None = None,
        bootstrapsamples: int | None = None,
        chains: int | None = None,
        mutationsperpixel: int | None = None,
        largestepprobability: float | None = None,
        sigma: float | None = None,
        regularize: bool | None = None,
    ) -> Settings:
        """Metropolis light transport in primary sample space.

        technique: one of path, bdpt, by default bdpt. The sampling technique whose paths the chains
        mutate.

        maxdepth: a whole number of 0 or more, by default 5. Maximum number of scattering events of
        a path.

        bootstrapsamples: a whole number of 1 or more, by default 100000. Maximum number of
        candidate paths for the starts of the chains of a pass.

        chains: a whole number of 1 or more, by default 1000. Maximum number of Markov chains of a
        pass, which has as many mutations as there are pixels.

        mutationsperpixel: a whole number of 1 or more, by default 100. Mutations per pixel on
        average. `--spp` sets it, too.

        largestepprobability: a number from 0 to 1, by default 0.3. Probability of a large step: a
        mutation to an independent path.

        sigma: a number above 0, by default 0.01. Standard deviation of a small step in the unit
        cube of random numbers.

        regularize: true or false, by default false. Roughen surfaces after the first bounce that is
        not specular.
        """
        return _given("integrator", "mlt", dict(locals()))

    @staticmethod
    def photon_mapping(
        *,
        maxdepth: int | None = None,
        photons: int | None = None,
        causticphotons: int | None = None,
        nearest: int | None = None,
        radius: float | None = None,
        kernel: Literal["cone", "epanechnikov"] | None = None,
        gather: int | None = None,
        show: Literal["radiance", "photons"] | None = None,
    ) -> Settings:
        """Photon mapping with a caustic and a global map.

        maxdepth: a whole number of 0 or more, by default 5. Maximum number of scattering events of
        a path.

        photons: a whole number of 0 or more, by default 200000. Light paths for the global map in
        each pass.

        causticphotons: a whole number of 0 or more, by default 100000. Light paths for the caustic
        map in each pass.

        nearest: a whole number of 1 or more, by default 50. Maximum number of photons in an
        estimate, the nearest ones.

        radius: a number above 0 scene units. Maximum distance of photons in an estimate. If absent,
        a share of the scene's size.

        kernel: one of cone, epanechnikov, by default epanechnikov. How photons are weighted by
        their distance.

        gather: a whole number of 0 or more, by default 0. Rays of a final gather at the first
        diffuse surface. 0 is none.

        show: one of radiance, photons, by default radiance. What the picture shows.
        """
        return _given("integrator", "photon-mapping", dict(locals()))

    @staticmethod
    def sppm(
        *,
        maxdepth: int | None = None,
        photonsperiteration: int | None = None,
        radius: float | None = None,
        seed: int | None = None,
    ) -> Settings:
        """Stochastic progressive photon mapping.

        maxdepth: a whole number of 0 or more, by default 5. Maximum number of scattering events of
        a path.

        photonsperiteration: a whole number of 1 or more. Light paths in each pass. If absent, as
        many as pixels.

        radius: a number above 0 scene units. Maximum distance of photons in the first pass. If
        absent, 5/√n of the radius of a scene with n light paths, at most 0.05 of it (in pbrt-v4:
        1).

        seed: a whole number. Seed of the photons. If absent, that of the sampler.
        """
        return _given("integrator", "sppm", dict(locals()))

    @staticmethod
    def vcm(
        *,
        maxdepth: int | None = None,
        radius: float | None = None,
        alpha: float | None = None,
    ) -> Settings:
        """Vertex connection and merging.

        maxdepth: a whole number of 0 or more, by default 5. Maximum number of scattering events of
        a path.

        radius: a number above 0 scene units. The distance within which vertices are merged in the
        first pass. If absent, 0.003 of the scene's radius.

        alpha: a number above 0 and at most 1, by default 0.75. The α by which the radius shrinks:
        after i passes its square is about i^(α − 1) times the initial one.
        """
        return _given("integrator", "vcm", dict(locals()))

    @staticmethod
    def radiosity(
        *,
        maxdepth: int | None = None,
        formfactors: Literal["analytic", "hemicube"] | None = None,
        hemicuberesolution: int | None = None,
        patchsize: float | None = None,
        subdivision: int | None = None,
        gradient: float | None = None,
        maxpatches: int | None = None,
        tolerance: float | None = None,
        steps: int | None = None,
        gather: int | None = None,
        mesh_out: str | None = None,
    ) -> Settings:
        """Radiosity by progressive shooting.

        maxdepth: a whole number from 0 to 100, by default 5. Maximum number of scattering events of
        light.

        formfactors: one of analytic, hemicube, by default analytic. How form factors are computed.

        hemicuberesolution: a whole number from 2 to 1024 pixels, by default 128. Resolution of a
        hemicube along an edge.

        patchsize: a number above 0 scene units. Longest side of a patch. If absent, a tenth of the
        scene's radius.

        subdivision: a whole number from 0 to 10, by default 3. Maximum number of subdivisions of an
        element, into quarters.

        gradient: a number above 0, by default 0.1. The relative change of radiosity across an
        element above which it is subdivided.

        maxpatches: a whole number from 1 to 1000000, by default 50000. Maximum number of elements,
        which limits memory.

        tolerance: a number between 0 and 1, by default 0.002. Share of the light that may remain
        unshot.

        steps: a whole number of 1 or more, by default 8. Passes in which light is shot.

        gather: a whole number of 0 or more, by default 0. Rays of a final gather for each sample of
        a pixel. 0 interpolates the elements instead.

        mesh_out: a name that ends in .ply. A PLY file for the elements with their radiosity as
        vertex colours.
        """
        return _given("integrator", "radiosity", dict(locals()))

    @staticmethod
    def simple_vol_path(
        *,
        maxdepth: int | None = None,
    ) -> Settings:
        """Path tracing through participating media, without next-event estimation.

        maxdepth: a whole number of 0 or more, by default 5. Maximum number of scattering events of
        a path.
        """
        return _given("integrator", "simple-vol-path", dict(locals()))

    @staticmethod
    def function(
        *,
        function: Literal["step", "diagonal", "disk", "checkerboard", "rotatedcheckerboard", "gaussian"] | None = None,
        filename: str | None = None,
        skipbad: bool | None = None,
        imagefilename: str | None = None,
    ) -> Settings:
        """The integral of an analytic function over the unit square instead of a scene, for the
        study of samplers.

        function: one of step, diagonal, disk, checkerboard, rotatedcheckerboard, gaussian, by
        default step. The function.

        filename: a text. A text file for the mean square error of the pixels after each number of
        samples. If absent, the function's name with `-mse.txt`.

        skipbad: true or false, by default true. Leave out the error after numbers of samples that
        the sampler does not stratify.

        imagefilename: a text. A picture file for the function itself, at the film's resolution.
        """
        return _given("integrator", "function", dict(locals()))


class sampler:
    """A choice of the sampler, with its settings."""

    @staticmethod
    def independent(
        *,
        pixelsamples: int | None = None,
        seed: int | None = None,
    ) -> Settings:
        """Uniform random points.

        pixelsamples: a whole number of 1 or more, by default 4. Samples per pixel.

        seed: a whole number. Seed of the sampler. If absent, that of the options.
        """
        return _given("sampler", "independent", dict(locals()))

    @staticmethod
    def stratified(
        *,
        xsamples: int | None = None,
        ysamples: int | None = None,
        jitter: bool | None = None,
        seed: int | None = None,
    ) -> Settings:
        """One point in each cell of a grid.

        xsamples: a whole number from 1 to 30000, by default 4. Cells along an axis of the grid.
        Their product is the number of samples per pixel.

        ysamples: a whole number from 1 to 30000, by default 4. Cells along an axis of the grid.
        Their product is the number of samples per pixel.

        jitter: true or false, by default true. Random positions in the cells instead of their
        centres.

        seed: a whole number. Seed of the sampler. If absent, that of the options.
        """
        return _given("sampler", "stratified", dict(locals()))

    @staticmethod
    def halton(
        *,
        pixelsamples: int | None = None,
        randomization: Literal["none", "permutedigits", "owen"] | None = None,
        seed: int | None = None,
    ) -> Settings:
        """The Halton sequence.

        pixelsamples: a whole number of 1 or more, by default 16. Samples per pixel.

        randomization: one of none, permutedigits, owen, by default permutedigits. How the digits
        are randomised.

        seed: a whole number. Seed of the sampler. If absent, that of the options.
        """
        return _given("sampler", "halton", dict(locals()))

    @staticmethod
    def paddedsobol(
        *,
        pixelsamples: int | None = None,
        randomization: Literal["none", "permutedigits", "fastowen", "owen"] | None = None,
        seed: int | None = None,
    ) -> Settings:
        """Two-dimensional Sobol' points, padded.

        pixelsamples: a whole number of 1 or more, by default 16. Samples per pixel.

        randomization: one of none, permutedigits, fastowen, owen, by default fastowen. How the
        points are randomised.

        seed: a whole number. Seed of the sampler. If absent, that of the options.
        """
        return _given("sampler", "paddedsobol", dict(locals()))

    @staticmethod
    def sobol(
        *,
        pixelsamples: int | None = None,
        randomization: Literal["none", "permutedigits", "fastowen", "owen"] | None = None,
        seed: int | None = None,
    ) -> Settings:
        """One Sobol' sequence over the image.

        pixelsamples: a whole number of 1 or more, by default 16. Samples per pixel.

        randomization: one of none, permutedigits, fastowen, owen, by default fastowen. How the
        sequence is randomised.

        seed: a whole number. Seed of the sampler. If absent, that of the options.
        """
        return _given("sampler", "sobol", dict(locals()))

    @staticmethod
    def zsobol(
        *,
        pixelsamples: int | None = None,
        randomization: Literal["none", "permutedigits", "fastowen", "owen"] | None = None,
        seed: int | None = None,
    ) -> Settings:
        """Sobol' points in an order that leaves blue noise in the image.

        pixelsamples: a whole number of 1 or more, by default 16. Samples per pixel.

        randomization: one of none, permutedigits, fastowen, owen, by default fastowen. How the
        points are randomised.

        seed: a whole number. Seed of the sampler. If absent, that of the options.
        """
        return _given("sampler", "zsobol", dict(locals()))

    @staticmethod
    def pmj02bn(
        *,
        pixelsamples: int | None = None,
        seed: int | None = None,
    ) -> Settings:
        """Progressive multi-jittered points with blue noise.

        pixelsamples: a whole number of 1 or more, by default 16. Samples per pixel.

        seed: a whole number. Seed of the sampler. If absent, that of the options.
        """
        return _given("sampler", "pmj02bn", dict(locals()))


class filter:
    """A choice of the filter, with its settings."""

    @staticmethod
    def box(
        *,
        xradius: float | None = None,
        yradius: float | None = None,
    ) -> Settings:
        """Constant.

        xradius: a number above 0 pixels, by default 0.5. Half of the filter's width or height.

        yradius: a number above 0 pixels, by default 0.5. Half of the filter's width or height.
        """
        return _given("filter", "box", dict(locals()))

    @staticmethod
    def triangle(
        *,
        xradius: float | None = None,
        yradius: float | None = None,
    ) -> Settings:
        """Linear to zero at the edge.

        xradius: a number above 0 pixels, by default 2. Half of the filter's width or height.

        yradius: a number above 0 pixels, by default 2. Half of the filter's width or height.
        """
        return _given("filter", "triangle", dict(locals()))

    @staticmethod
    def gaussian(
        *,
        xradius: float | None = None,
        yradius: float | None = None,
        sigma: float | None = None,
    ) -> Settings:
        """A Gaussian, lowered to zero at the edge.

        xradius: a number above 0 pixels, by default 1.5. Half of the filter's width or height.

        yradius: a number above 0 pixels, by default 1.5. Half of the filter's width or height.

        sigma: a number above 0 pixels, by default 0.5. Standard deviation.
        """
        return _given("filter", "gaussian", dict(locals()))

    @staticmethod
    def mitchell(
        *,
        xradius: float | None = None,
        yradius: float | None = None,
        B: float | None = None,
        C: float | None = None,
    ) -> Settings:
        """The family of piecewise cubics of Mitchell and Netravali.

        xradius: a number above 0 pixels, by default 2. Half of the filter's width or height.

        yradius: a number above 0 pixels, by default 2. Half of the filter's width or height.

        B: a finite number, by default 0.33333334. Parameter B of the family.

        C: a finite number, by default 0.33333334. Parameter C of the family.
        """
        return _given("filter", "mitchell", dict(locals()))

    @staticmethod
    def sinc(
        *,
        xradius: float | None = None,
        yradius: float | None = None,
        tau: float | None = None,
    ) -> Settings:
        """A windowed sinc.

        xradius: a number above 0 pixels, by default 4. Half of the filter's width or height.

        yradius: a number above 0 pixels, by default 4. Half of the filter's width or height.

        tau: a number above 0, by default 3. Cycles of the sinc under the window.
        """
        return _given("filter", "sinc", dict(locals()))


def film(
    *,
    xresolution: int | None = None,
    yresolution: int | None = None,
    pixelbounds: Sequence[int] | None = None,
    cropwindow: Sequence[float] | None = None,
    diagonal: float | None = None,
    filename: str | None = None,
    savefp16: bool | None = None,
    maxcomponentvalue: float | None = None,
    sensor: Literal["cie1931", "canon_eos_100d", "canon_eos_1dx_mkii", "canon_eos_200d_mkii", "canon_eos_200d", "canon_eos_5d", "canon_eos_5d_mkii", "canon_eos_5d_mkiii", "canon_eos_5d_mkiv", "canon_eos_5ds", "canon_eos_m", "hasselblad_l1d_20c", "nikon_d810", "nikon_d850", "sony_ilce_6400", "sony_ilce_7m3", "sony_ilce_7rm3", "sony_ilce_9"] | None = None,
    iso: float | None = None,
    whitebalance: float | None = None,
    coordinatesystem: Literal["camera", "world"] | None = None,
    nbuckets: int | None = None,
    lambdamin: float | None = None,
    lambdamax: float | None = None,
) -> Settings:
    """Settings of the scene's film.

    xresolution: a whole number from 1 to 1000000 pixels, by default 1280. Width or height of the
    whole image.

    yresolution: a whole number from 1 to 1000000 pixels, by default 720. Width or height of the
    whole image.

    pixelbounds: 4 values separated by commas, each a whole number. The pixels to render, x0, x1,
    y0, y1 in pixels of the whole image, without x1 and y1. If absent, all.

    cropwindow: 4 values separated by commas, each a finite number. The part to render as fractions
    x0, x1, y0, y1 of the whole image, instead of `pixelbounds`.

    diagonal: a number above 0 mm, by default 35. Diagonal of the film, for physical cameras.

    filename: a text, by default pbrt.exr. The file to write.

    savefp16: true or false, by default true. Store half floats instead of single floats.

    maxcomponentvalue: a number above 0, by default inf. Samples are scaled down so that no sensor
    response exceeds this.

    sensor: one of cie1931, canon_eos_100d, canon_eos_1dx_mkii, canon_eos_200d_mkii, canon_eos_200d,
    canon_eos_5d, canon_eos_5d_mkii, canon_eos_5d_mkiii, canon_eos_5d_mkiv, canon_eos_5ds,
    canon_eos_m, hasselblad_l1d_20c, nikon_d810, nikon_d850, sony_ilce_6400, sony_ilce_7m3,
    sony_ilce_7rm3, sony_ilce_9, by default cie1931. The sensor: `cie1931`, an ideal one, or a
    measured camera.

    iso: a number above 0 ISO, by default 100. Sensitivity.

    whitebalance: a number from 0 to 100000 K, by default 0. Colour temperature of the light that
    becomes white. 0 does not change colours (`cie1931`) or means 6500 (measured cameras).

    coordinatesystem: one of camera, world, by default camera. The space of positions and normals.

    nbuckets: a whole number from 1 to 4096, by default 16. Number of buckets.

    lambdamin: a number from 360 to 830 nm, by default 360. Lower end of the first bucket.

    lambdamax: a number from 360 to 830 nm, by default 830. Upper end of the last bucket.
    """
    return _given("film", None, dict(locals()))


def camera(
    *,
    shutteropen: float | None = None,
    shutterclose: float | None = None,
    frameaspectratio: float | None = None,
    screenwindow: Sequence[float] | None = None,
    lensradius: float | None = None,
    focaldistance: float | None = None,
    fov: float | None = None,
    mapping: Literal["equalarea", "equirectangular"] | None = None,
    aperturediameter: float | None = None,
    focusdistance: float | None = None,
) -> Settings:
    """Settings of the scene's camera.

    shutteropen: a finite number, by default 0. Time at which the shutter opens.

    shutterclose: a finite number, by default 1. Time at which the shutter closes.

    frameaspectratio: a number above 0. Width of the image over its height. If absent, that of the
    film.

    screenwindow: 4 values separated by commas, each a finite number. The part of the screen, x0,
    x1, y0, y1. If absent, [−1, 1] over the shorter side and more over the other.

    lensradius: a number of 0 or more scene units, by default 0. Radius of the lens. 0 is a pinhole.

    focaldistance: a number above 0 scene units, by default 1000000. Distance to the plane of focus.

    fov: a number between 0 and 180 degrees, by default 90. Field of view over the shorter side of
    the image (over [−1, 1] of the screen).

    mapping: one of equalarea, equirectangular, by default equalarea. The mapping from the image to
    directions.

    aperturediameter: a number above 0 mm, by default 1. Diameter of the aperture stop.

    focusdistance: a number above 0 m, by default 10. Distance to the plane of focus.
    """
    return _given("camera", None, dict(locals()))


class accelerator:
    """A choice of the accelerator, with its settings."""

    @staticmethod
    def bvh(
        *,
        maxnodeprims: int | None = None,
        splitmethod: Literal["sah", "hlbvh", "middle", "equal"] | None = None,
        quality: Literal["fast", "balanced", "high"] | None = None,
    ) -> Settings:
        """A bounding volume hierarchy.

        maxnodeprims: a whole number from 1 to 255, by default 4. Maximum number of primitives in a
        leaf. Part of the format; has no effect.

        splitmethod: one of sah, hlbvh, middle, equal, by default sah. How nodes are split. `hlbvh`
        selects the quality `fast`, all others `balanced`.

        quality: one of fast, balanced, high. How much time the build may take. If absent,
        `splitmethod` selects it.
        """
        return _given("accelerator", "bvh", dict(locals()))

    @staticmethod
    def none() -> Settings:
        """No hierarchy: every ray is tested against every primitive, for comparison."""
        return _given("accelerator", "none", dict(locals()))


def options(
    *,
    adaptive: float | None = None,
    disablepixeljitter: bool | None = None,
    disabletexturefiltering: bool | None = None,
    disablewavelengthjitter: bool | None = None,
    displacementedgescale: float | None = None,
    engine: Literal["wavefront", "scalar"] | None = None,
    forcediffuse: bool | None = None,
    msereferenceimage: str | None = None,
    msereferenceout: str | None = None,
    pixelstats: bool | None = None,
    rendercoordsys: Literal["camera", "cameraworld", "world"] | None = None,
    schedule: Literal["megakernel", "wavefront"] | None = None,
    seed: int | None = None,
    wavefront: bool | None = None,
) -> Settings:
    """Settings of the scene's options.

    adaptive: a number above 0. Contrast of neighbouring pixels, a difference of sRGB codes, from
    which a pixel takes all of its samples, down to a sixteenth of them where there is none.
    Otherwise all pixels take as many.

    disablepixeljitter: true or false, by default false. Sample every pixel at its centre only.

    disabletexturefiltering: true or false, by default false. Evaluate textures at points, without
    filtering.

    disablewavelengthjitter: true or false, by default false. Use the same wavelengths for every
    sample, those of pbrt-v4: 545.9, 616.9, 830 and 479.2 nm, or of a spectral film 0.5, 0.75, 1 and
    0.25 of its range.

    displacementedgescale: a number above 0, by default 1. Factor on the edge length to which
    displaced surfaces are tessellated.

    engine: one of wavefront, scalar, by default wavefront. How `ray-casting`, `whitted`,
    `ambient-occlusion`, `path` and `vol-path` trace rays.

    forcediffuse: true or false, by default false. Replace every BSDF by a diffuse one of the same
    albedo.

    msereferenceimage: a text. Image to measure the error against after each pass.

    msereferenceout: a text. File that receives these errors.

    pixelstats: true or false, by default false. Write statistics per pixel.

    rendercoordsys: one of camera, cameraworld, world, by default cameraworld. The coordinate system
    in which rays are traced.

    schedule: one of megakernel, wavefront, by default megakernel. How a GPU, which `--device`
    chooses, follows the paths of `path` and `vol-path`.

    seed: a whole number, by default 0. Default seed of samplers.

    wavefront: true or false, by default false. Select the wavefront renderer.
    """
    return _given("options", None, dict(locals()))
