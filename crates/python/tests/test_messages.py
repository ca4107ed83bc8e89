"""Tests that errors say which argument is wrong, what was got and what is wanted."""

import os
import sys
import warnings

import alhazen
import numpy
import pytest

SCENE = """
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
Camera "perspective" "float fov" 40
WorldBegin
LightSource "infinite"
Translate 0 0 5 Shape "sphere"
"""


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "ball.pbrt"
    path.write_text(SCENE)
    return alhazen.load(path)


@pytest.mark.parametrize(
    ("arguments", "error", "text"),
    [
        ({"crop": (0, 32, 0, 32)}, ValueError, r"`crop` is four fractions .*pixels are divided.*not \(0, 32, 0, 32\)"),
        ({"crop": (0.5, 2.0, -1.0, 0.5)}, ValueError, "`crop` is four fractions"),
        ({"crop": (0.0, 0.5, float("nan"), 1.0)}, ValueError, "`crop` is four fractions"),
        ({"crop": (0.5, 0.2, 0, 1)}, ValueError, "x0 < x1"),
        ({"crop": (0, 1, 0.5, 0.5)}, ValueError, "y0 < y1"),
        ({"crop": (0, 1)}, TypeError, r"`crop` is four fractions .*, not \(0, 1\)"),
        ({"layers": "depth"}, TypeError, r"`layers` is a list of names such as \[\"depth\"\], not 'depth'"),
        ({"layers": [1]}, TypeError, r"`layers` is a list of names .*, not \[1\]"),
        ({"layers": ["dept"]}, ValueError, "no layer is called `dept`; did you mean `depth`"),
        ({"spp": -1}, ValueError, "`spp` is a whole number from 1 to 2147483647, not -1"),
        ({"spp": 2.5}, TypeError, "`spp` is a whole number from 1 to 2147483647, not 2.5"),
        ({"spp": 1 << 70}, ValueError, "`spp` is a whole number"),
        ({"seed": 1 << 40}, ValueError, "`seed` is a whole number"),
        ({"threads": -1}, ValueError, "`threads` is a whole number from 1"),
        ({"threads": "2"}, TypeError, "`threads` is a whole number from 1 to .*, not '2'"),
        ({"resolution": 640}, TypeError, r"`resolution` is width and height .*, not 640"),
        ({"resolution": (640, -1)}, ValueError, r"`resolution` is width and height .*, not \(640, -1\)"),
        ({"resolution": (640.5, 1)}, TypeError, "`resolution` is width and height"),
        ({"time": -1.0}, ValueError, "`time` is seconds, a number of 0 or more, not -1.0"),
        ({"time": "1"}, TypeError, "`time` is seconds"),
        ({"noise": 0}, ValueError, "`noise` is a relative error"),
        ({"integrator": 3}, TypeError, "`integrator` is the name of an algorithm, .*, not 3"),
        ({"settings": 3}, TypeError, "`settings` is a dict .*, not 3"),
        ({"settings": {3: 4}}, TypeError, "`settings` is a dict from names to values"),
        ({"settings": alhazen.settings.film(cropwindow=(0, 32, 0, 32))}, ValueError, "`cropwindow` is four fractions"),
        ({"progress": "x"}, TypeError, "`progress` is True, or a function .*, not 'x'"),
        ({"settings": {"camera.fov": 400}}, ValueError, "cannot set camera.fov to `400`"),
        ({"settings": alhazen.settings.camera(lensradius=-1)}, ValueError, "cannot set camera.lensradius"),
        ({"settings": alhazen.settings.camera(screenwindow=(1, 1, 0, 1))}, ValueError, "camera.screenwindow"),
        ({"settings": alhazen.settings.camera(shutteropen=2.0, shutterclose=1.0)}, ValueError, "camera.shutter"),
        ({"settings": alhazen.settings.camera(shutteropen=1.0)}, ValueError, "camera.shutteropen"),
        ({"settings": alhazen.settings.film(cropwindow=(0.5, 0.2, 0, 1))}, ValueError, "`cropwindow` is four"),
        ({"settings": alhazen.settings.film(pixelbounds=(5, 2, 0, 1))}, ValueError, "film.pixelbounds"),
    ],
    ids=str,
)
def test_wrong_arguments_are_named(scene, arguments, error, text):
    with pytest.raises(error, match=text) as raised:
        alhazen.render(scene, **{"spp": 1} | arguments)
    assert "ball.pbrt" not in str(raised.value)


def test_whole_numbers_of_numpy_are_whole_numbers(scene):
    image = alhazen.render(scene, spp=numpy.int64(1), resolution=numpy.array([6, 4]), seed=numpy.uint8(3))
    assert image.shape == (4, 6, 3)
    assert alhazen.render(scene, spp=1, crop=numpy.array([0, 0.5, 0, 1])).shape == (8, 4, 3)


def test_wrong_parts_are_named(scene):
    job = alhazen.compile(scene, spp=2)
    with pytest.raises(ValueError, match="`index` is a whole number from 1"):
        job.render_shard(-1, 2)
    with pytest.raises(TypeError, match="`count` is a whole number from 1 .*, not 2.5"):
        job.render_shard(1, 2.5)


def openers(path):
    yield "scene", lambda: alhazen.load(path)
    yield "render", lambda: alhazen.render(path)
    yield "image", lambda: alhazen.Image.open(path)
    yield "film", lambda: alhazen.Film.open(path)


def test_files_that_cannot_be_opened_raise_the_exceptions_of_the_system(tmp_path):
    missing, secret = tmp_path / "missing.pbrt", tmp_path / "secret.pbrt"
    secret.write_text(SCENE)
    secret.chmod(0)
    cases = [(missing, FileNotFoundError), (tmp_path, IsADirectoryError)]
    if not os.access(secret, os.R_OK):
        cases.append((secret, PermissionError))
    for path, error in cases:
        for name, opening in openers(path):
            with pytest.raises(error) as raised:
                opening()
            assert raised.value.filename == str(path) and raised.value.errno, name
            assert str(path) in str(raised.value)


def test_files_that_cannot_be_written_raise_the_exceptions_of_the_system(scene, tmp_path):
    film, image = alhazen.compile(scene, spp=1).blank_film(), alhazen.render(scene, spp=1)
    for path, error in ((tmp_path / "missing" / "a", FileNotFoundError), (tmp_path / "folder", IsADirectoryError)):
        for suffix, write in ((".exr", image.write), (".png", image.save), (".film", film.write)):
            file = path.with_suffix(suffix)
            if error is IsADirectoryError:
                file.mkdir()
            with pytest.raises(error) as raised:
                write(file)
            assert raised.value.filename == str(file)


def test_a_scene_is_no_text(tmp_path):
    for text in (SCENE, 'WorldBegin Shape "sphere" ' * 400):
        with pytest.raises(ValueError, match="`source` is the name of a file, not the text of a scene"):
            alhazen.load(text)
    with pytest.raises(TypeError, match="`source` is the name of a scene file or the bytes of an archive, not 3"):
        alhazen.load(3)
    with pytest.raises(alhazen.SceneError, match="no archive of a scene .*WorldBegin"):
        alhazen.load(b"WorldBegin")
    with pytest.raises(alhazen.SceneError, match="is no ZIP archive, or is not whole"):
        alhazen.load(b"PK\x03\x04")


def line():
    """The line of the caller."""
    return sys._getframe(1).f_lineno


def test_errors_of_builders_name_the_line_of_the_program():
    builder = alhazen.SceneBuilder()
    builder.film(xresolution=8, yresolution=8)
    places = []
    places.append((line() + 1, 'material("diffuse")'))
    builder.material("diffuse", reflectence=0.5)
    places.append((line() + 1, 'shape("spere")'))
    builder.shape("spere")
    places.append((line() + 1, "shape(…, emission=…)"))
    builder.shape("sphere", emission={"M": 1.0})
    places.append((line() + 1, 'light("point")'))
    builder.light("point", I=(0.5, 0.5))
    places.append((line() + 1, 'camera("perspective")'))
    builder.camera(fov=400)
    with pytest.raises(alhazen.SceneError) as error:
        builder.build()
    lines = str(error.value).splitlines()
    for number, call in places:
        assert any(text.startswith(f"{__file__}:{number}: in {call}: error[") for text in lines), (call, lines)
    assert "`I` has 2 numbers; a colour has three" in str(error.value)


def test_errors_and_warnings_of_compiling_name_the_line_of_the_program():
    builder = alhazen.SceneBuilder()
    builder.film(xresolution=8, yresolution=8)
    number = line() + 1
    builder.light("point", scale=0.0)
    builder.shape("sphere", transform=alhazen.translate(0, 0, 5))
    compiled = alhazen.compile(builder.build(), spp=1)
    assert any(text.startswith(f'{__file__}:{number}: in light("point"): warning[') for text in compiled.warnings)


def test_colours_that_cannot_be_meant_are_refused():
    builder = alhazen.SceneBuilder()
    for wrong in ((255, 0, 0), (255.0, 0.0, 0.0), (1.5, 0, 0), (-0.1, 0, 0), 2, numpy.array([0, 128, 0])):
        with pytest.raises(ValueError, match="`reflectance` is linear red, green and blue from 0 to 1, not "):
            builder.material("diffuse", reflectance=wrong)
    with pytest.raises(ValueError, match=r"not \(255, 0, 0\); a code from 0 to 255 of sRGB"):
        builder.material("diffuse", reflectance=alhazen.rgb(255, 0, 0))
    with pytest.raises(ValueError, match="`base_color` is linear"):
        builder.material("openpbr", base_color=(255, 255, 255))
    with pytest.raises(ValueError, match="`tex1` is linear"):
        builder.texture("spectrum", "checkerboard", tex1=(255, 0, 0), tex2=(0, 0, 0))
    # Light is as bright as it is, and refraction is no colour.
    builder.light("point", I=(255, 0, 0))
    builder.light("infinite", L=20)
    builder.material("dielectric", eta=1.5)
    builder.material("diffuse", reflectance=(1.0, 1, 0))
    builder.material("conductor", eta=(1.5, 2.0, 3.0), k=(3.0, 2.0, 1.0))
    builder.build()
    for wrong in ((0.5, 0.5), (0.1, 0.2, 0.3, 1.0)):
        builder = alhazen.SceneBuilder()
        builder.material("diffuse", reflectance=wrong)
        with pytest.raises(alhazen.SceneError, match="a colour has three: linear red, green and blue"):
            builder.build()


def test_wrong_values_of_builders_are_quoted():
    builder = alhazen.SceneBuilder()
    for call, error, text in (
        (lambda: builder.shape("sphere", radius=10**12), ValueError, "`radius`: expected a whole number of 32 bits"),
        (lambda: builder.shape("sphere", transform="up"), TypeError, "`transform` is a matrix .*, not 'up'"),
        (lambda: builder.shape("sphere", P=[[1, 2], [3]]), ValueError, "`P`: expected rows of numbers of one length"),
        (lambda: builder.shape(3), TypeError, "`kind` is the name of a type, a text such as \"sphere\", not 3"),
        (lambda: alhazen.look_at(3, (0, 0, 0)), ValueError, "`eye` is three numbers, not 3"),
        (lambda: alhazen.rotate((0, 0, 1), 90), ValueError, "`axis` is three numbers, not 90"),
        (lambda: builder.film(3), TypeError, "`film` is the name of a type, .*, not 3"),
        (lambda: alhazen.Image.from_array(numpy.zeros((2, 2, 3), numpy.uint8)), TypeError, "linear light, not of uint8"),
        (lambda: alhazen.Image.from_array("x"), ValueError, "height × width × 3 real numbers"),
    ):
        with pytest.raises(error, match=text):
            call()


def test_files_for_displays_warn_of_layers(scene, tmp_path):
    image = alhazen.render(scene, spp=1, layers=["depth", "normal"])
    with pytest.warns(UserWarning, match="a.png: the layers Z, N are left out; .exr files keep them"):
        image.write(tmp_path / "a.png")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        image.write(tmp_path / "a.exr")
        alhazen.render(scene, spp=1).write(tmp_path / "b.png")
        alhazen.render(scene, spp=1, layers=["alpha"]).write(tmp_path / "c.png")
