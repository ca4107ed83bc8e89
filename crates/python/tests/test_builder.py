"""Tests of scenes built from arrays."""

import alhazen
import numpy
import pytest

QUAD = numpy.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], numpy.float32)
TRIANGLES = numpy.array([[0, 1, 2], [0, 2, 3]])


def looking(builder, resolution=(16, 16)):
    builder.film(xresolution=resolution[0], yresolution=resolution[1])
    builder.sampler("independent", pixelsamples=4)
    builder.camera(fov=60, transform=alhazen.look_at((0, 0, 4), (0, 0, 0)))


# The format's world is left-handed; a mirrored camera makes it right-handed.
@pytest.mark.parametrize(("handedness", "mirror"), [("left", ""), ("right", "Scale -1 1 1")])
def test_a_built_scene_has_the_bits_of_its_text(handedness, mirror, tmp_path):
    builder = alhazen.SceneBuilder(handedness=handedness)
    looking(builder)
    builder.integrator(alhazen.settings.integrator.path(maxdepth=3))
    checks = builder.texture("spectrum", "checkerboard", tex1=(0.1, 0.2, 0.3), tex2=alhazen.rgb(1, 1, 1))
    floor = builder.material("diffuse", reflectance=checks)
    glass = builder.material("dielectric", eta=alhazen.spectrum("glass-BK7"))
    fog = builder.medium("homogeneous", sigma_a=0.1, sigma_s=(0.2, 0.1, 0.1))
    builder.shape("trianglemesh", P=QUAD, indices=TRIANGLES, material=floor)
    builder.shape(
        "sphere",
        radius=0.5,
        material=glass,
        inside=fog,
        transform=alhazen.translate(0, 0, 1) @ alhazen.scale(1, 2, 1),
    )
    ball = builder.object()
    builder.shape("sphere", radius=0.2, object=ball, emission={"L": alhazen.blackbody(3000), "scale": 2.0})
    for x in (-1, 1):
        builder.instance(ball, transform=alhazen.translate(x, 1, 0.5))
    builder.light("infinite", L=0.5)
    scene = builder.build()
    built = alhazen.render(scene)
    assert (alhazen.render(scene.pack()).pixels == built.pixels).all()

    text = """
        Film "rgb" "integer xresolution" 16 "integer yresolution" 16
        Sampler "independent" "integer pixelsamples" 4
        Integrator "path" "integer maxdepth" 3
        MIRROR
        LookAt 0 0 4  0 0 0  0 1 0
        Camera "perspective" "float fov" 60
        WorldBegin
        Texture "checks" "spectrum" "checkerboard" "rgb tex1" [0.1 0.2 0.3] "rgb tex2" [1 1 1]
        MakeNamedMaterial "floor" "string type" "diffuse" "texture reflectance" "checks"
        MakeNamedMaterial "glass" "string type" "dielectric" "spectrum eta" "glass-BK7"
        MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0.1 0.1 0.1]
            "rgb sigma_s" [0.2 0.1 0.1]
        NamedMaterial "floor"
        Shape "trianglemesh" "point3 P" [-1 -1 0  1 -1 0  1 1 0  -1 1 0] "integer indices" [0 1 2 0 2 3]
        AttributeBegin
            NamedMaterial "glass"
            MediumInterface "fog" ""
            Translate 0 0 1 Scale 1 2 1
            Shape "sphere" "float radius" 0.5
        AttributeEnd
        ObjectBegin "ball"
            Material "diffuse"
            AreaLightSource "diffuse" "blackbody L" 3000 "float scale" 2
            Shape "sphere" "float radius" 0.2
        ObjectEnd
        AttributeBegin Translate -1 1 0.5 ObjectInstance "ball" AttributeEnd
        AttributeBegin Translate 1 1 0.5 ObjectInstance "ball" AttributeEnd
        LightSource "infinite" "rgb L" [0.5 0.5 0.5]
    """
    path = tmp_path / "scene.pbrt"
    path.write_text(text.replace("MIRROR", mirror))
    assert numpy.allclose(built.pixels, alhazen.render(path).pixels, rtol=1e-5, atol=1e-6)
    assert built.pixels.max() > 1


def test_arrays_of_every_type_are_taken():
    pictures = []
    for points in (QUAD, QUAD.astype(float), QUAD.tolist(), numpy.asfortranarray(QUAD), QUAD.reshape(-1)):
        for triangles in (TRIANGLES, TRIANGLES.astype(numpy.uint8), TRIANGLES.tolist()):
            builder = alhazen.SceneBuilder()
            looking(builder)
            builder.shape("trianglemesh", P=points, indices=triangles, emission=2.0)
            pictures.append(alhazen.render(builder.build()).pixels)
    assert all((picture == pictures[0]).all() for picture in pictures)
    assert pictures[0][6:10, 6:10].mean() == pytest.approx(2.0, rel=0.1)


def test_a_moving_shape_is_blurred():
    builder = alhazen.SceneBuilder()
    looking(builder, (64, 16))
    builder.sampler("independent", pixelsamples=64)
    motion = [alhazen.translate(-2, 0, 0), alhazen.translate(2, 0, 0)]
    builder.shape("sphere", radius=0.3, emission=1.0, transform=motion)
    row = numpy.asarray(alhazen.render(builder.build()))[8, :, 1]
    assert 0 < row[28] < 0.9 and 0 < row[36] < 0.9 and row[20] == 0


def test_errors_name_the_call():
    builder = alhazen.SceneBuilder()
    red = builder.material("diffuse", reflectence=(1, 0, 0))
    builder.shape("spere", material=red)
    with pytest.raises(alhazen.SceneError) as error:
        builder.build()
    assert 'in material("diffuse"): error[' in str(error.value) and "`reflectance`" in str(error.value)
    assert f'{__file__}:' in str(error.value) and 'in shape("spere"): error[' in str(error.value)
    assert "`sphere`" in str(error.value)


def test_arrays_with_wrong_rows_are_refused():
    # Numbers that fit by their count, though not by their shape: a transposed array among them.
    for wrong in (
        {"P": QUAD.T},
        {"uv": numpy.zeros((2, 4))},
        {"N": numpy.zeros((6, 2))},
        {"indices": TRIANGLES.reshape(3, 2)},
    ):
        builder = alhazen.SceneBuilder()
        builder.shape("trianglemesh", **{"P": QUAD, "indices": TRIANGLES} | wrong)
        with pytest.raises(alhazen.SceneError, match="an array with rows of"):
            builder.build()
    builder = alhazen.SceneBuilder()
    builder.shape("bilinearmesh", P=QUAD.reshape(2, 2, 3), indices=[[0, 1, 3, 2]])
    builder.build()


def test_wrong_values_are_refused():
    builder = alhazen.SceneBuilder()
    with pytest.raises(TypeError, match="`P`"):
        builder.shape("trianglemesh", P=object())
    with pytest.raises(TypeError, match="`radius`"):
        builder.shape("sphere", radius={"a": 1})
    with pytest.raises(ValueError, match="32 bits"):
        builder.shape("trianglemesh", P=QUAD, indices=numpy.array([0, 1, 1 << 40]))
    with pytest.raises(ValueError, match="4 × 4"):
        builder.shape("sphere", transform=numpy.eye(3))
    with pytest.raises(TypeError, match="material"):
        builder.shape("sphere", material="red")
    with pytest.raises(TypeError, match="not a object|not a medium"):
        builder.shape("sphere", material=builder.object())
    with pytest.raises(TypeError, match="not of the film"):
        builder.integrator(alhazen.settings.film(iso=100))
    with pytest.raises(ValueError, match="option"):
        builder.options(sead=1)
    with pytest.raises(ValueError, match="spectrum"):
        builder.texture("color", "constant")
    with pytest.raises(ValueError):
        alhazen.look_at((0, 0, 0), (0, 0, 0))


def test_things_of_other_builders_are_refused():
    other = alhazen.SceneBuilder()
    material = other.material("diffuse")
    texture, ball = other.texture("float", "constant", value=1.0), other.object()
    builder = alhazen.SceneBuilder()
    builder.material("conductor")
    for call in (
        lambda: builder.shape("sphere", material=material),
        lambda: builder.shape("sphere", object=ball),
        lambda: builder.material("diffuse", reflectance=texture),
        lambda: builder.material("mix", materials=[material, material]),
        lambda: builder.instance(ball),
    ):
        with pytest.raises(ValueError, match="another SceneBuilder"):
            call()


def test_settings_are_those_of_the_schema():
    builder = alhazen.SceneBuilder()
    looking(builder)
    builder.shape("trianglemesh", P=QUAD, indices=TRIANGLES)
    builder.light("infinite", L=1.0)
    scene = builder.build()
    path = alhazen.settings.integrator.path
    one = alhazen.render(scene, integrator=path(maxdepth=0)).pixels
    none = alhazen.render(scene, integrator="path", settings={"integrator.maxdepth": 0}).pixels
    assert (one == none).all()
    film, sampler = alhazen.settings.film(iso=200), alhazen.settings.sampler.stratified(xsamples=2, ysamples=2)
    both = alhazen.compile(scene, settings=[film, sampler, alhazen.settings.filter.box(xradius=0.5)])
    assert both.passes == 4
    with pytest.raises(ValueError, match="maxdepth"):
        alhazen.render(scene, integrator=path(maxdepth=-1))


def test_builders_can_be_continued():
    builder = alhazen.SceneBuilder()
    looking(builder)
    builder.light("infinite", L=1.0)
    empty = builder.build()
    builder.shape("sphere", material=builder.material("diffuse", reflectance=0.0))
    assert alhazen.render(empty).pixels.mean() > alhazen.render(builder.build()).pixels.mean()
