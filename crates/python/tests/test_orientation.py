"""Tests that pictures are not mirrored: a letter F and the axes of the world, for all ways in."""

import base64
import json

import alhazen
import numpy
import pytest

# Boxes x0, y0, x1, y1 of the letter, whose upright is at the left.
BOXES = [(0, 0, 0.25, 1.5), (0.25, 1.25, 0.9, 1.5), (0.25, 0.65, 0.7, 0.9)]
POINTS = numpy.array(
    [p for x0, y0, x1, y1 in BOXES for p in ((x0, y0, 0), (x1, y0, 0), (x1, y1, 0), (x0, y1, 0))],
    numpy.float32,
) - numpy.array([0.45, 0.75, 0], numpy.float32)
TRIANGLES = numpy.array([[4 * k + i for i in t] for k in range(3) for t in ((0, 1, 2), (0, 2, 3))], numpy.int32)
# The ends of the axes: x red, y green, z blue.
AXES = numpy.eye(3)
SIZE = {"xresolution": 48, "yresolution": 48}
SAMPLES = {"spp": 16, "resolution": (48, 48)}


def builder(handedness="right", eye=(0, 0, 4), at=(0, 0, 0), up=(0, 1, 0), fov=45):
    made = alhazen.SceneBuilder(handedness=handedness)
    made.film(**SIZE)
    made.camera(fov=fov, transform=alhazen.look_at(eye, at, up))
    return made


def is_mirrored(image):
    """Whether the upright of the letter, its longest column, is at the right."""
    columns = (image["depth"] < 1e6).sum(0)
    seen = numpy.nonzero(columns)[0]
    return numpy.nonzero(columns > 0.8 * columns.max())[0].mean() > (seen.min() + seen.max()) / 2


def find(image, channel):
    """The place of what is red, green or blue, from 0 to 1 to the right and down."""
    array = numpy.asarray(image)
    others = numpy.delete(array, channel, axis=2).max(2)
    rows, columns = numpy.nonzero((array[..., channel] > 0.05) & (array[..., channel] > 2 * others))
    assert len(rows), f"there is no colour {channel}"
    return (columns.mean() + 0.5) / array.shape[1], (rows.mean() + 0.5) / array.shape[0]


def gltf(meshes, camera):
    """A scene of meshes, each of points, triangles and a material."""
    data, views, accessors = b"", [], []
    for points, triangles, _ in meshes:
        arrays = (points.astype("f4"), "VEC3", 5126), (triangles.astype("u4").reshape(-1), "SCALAR", 5125)
        for array, kind, component in arrays:
            view = {"buffer": 0, "byteOffset": len(data), "byteLength": array.nbytes}
            accessor = {"bufferView": len(views), "componentType": component, "count": len(array), "type": kind}
            if kind == "VEC3":
                accessor |= {"min": array.min(0).tolist(), "max": array.max(0).tolist()}
            views.append(view)
            accessors.append(accessor)
            data += array.tobytes()
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    primitive = lambda i: {"attributes": {"POSITION": 2 * i}, "indices": 2 * i + 1, "material": i}  # noqa: E731
    return json.dumps({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(meshes) + 1))}],
        "nodes": [*({"mesh": i} for i in range(len(meshes))), {"camera": 0, "matrix": camera}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1, "aspectRatio": 1}}],
        "materials": [material for *_, material in meshes],
        "meshes": [{"primitives": [primitive(i)]} for i in range(len(meshes))],
        "buffers": [{"byteLength": len(data), "uri": uri}],
        "bufferViews": views,
        "accessors": accessors,
    })


def ball(center):
    """An octahedron."""
    points = 0.3 * numpy.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]) + center
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    return points, numpy.array(faces)


def obj(meshes):
    text, first = "mtllib a.mtl\n", 1
    for points, triangles, material in meshes:
        text += f"usemtl {material}\n" + "".join("v {} {} {}\n".format(*point) for point in points)
        text += "".join("f {} {} {}\n".format(*triangle) for triangle in triangles + first)
        first += len(points)
    return text


def text_of(meshes, camera):
    """A pbrt scene of meshes, each of points, triangles and a colour."""
    text = f'{camera} Camera "perspective" "float fov" 45 WorldBegin LightSource "infinite" "rgb L" [1 1 1]\n'
    for points, triangles, color in meshes:
        values = [" ".join(map(str, array.reshape(-1))) for array in (color, points, triangles)]
        text += 'Material "diffuse" "rgb reflectance" [{}]\n'.format(values[0])
        text += 'Shape "trianglemesh" "point3 P" [{}] "integer indices" [{}]\n'.format(*values[1:])
    return text


LETTER = (POINTS, TRIANGLES, numpy.array([0.5, 0.5, 0.5]))
TIPS = [(*ball(AXES[i]), 0.7 * AXES[i]) for i in range(3)]


def letter_of(way, folder):
    if way.startswith("python"):
        made = builder(way.split()[1])
        made.light("infinite", L=1.0)
        made.shape("trianglemesh", P=POINTS, indices=TRIANGLES)
        return made.build()
    path = folder / f"a.{way}"
    back = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 4, 1]
    path.write_text({
        "pbrt": lambda: text_of([LETTER], "LookAt 0 0 4 0 0 0 0 1 0"),
        "gltf": lambda: gltf([(POINTS, TRIANGLES, {})], back),
        "obj": lambda: obj([(POINTS, TRIANGLES, "none")]),
    }[way]())
    return path


WAYS = [("python right", False), ("gltf", False), ("obj", False), ("python left", True), ("pbrt", True)]


@pytest.mark.parametrize(("way", "mirrored"), WAYS, ids=[way for way, _ in WAYS])
def test_a_letter_is_mirrored_in_left_handed_worlds_only(way, mirrored, tmp_path):
    image = alhazen.render(letter_of(way, tmp_path), layers=["depth"], **SAMPLES)
    if way == "obj":
        # Of the studio only the letter.
        image = alhazen.render(letter_of(way, tmp_path), layers=["depth", "albedo"], **SAMPLES)
        albedo = image["albedo"].mean(2)
        columns = (albedo > 0.5 * (0.36 + 0.65)).sum(0)
        seen = numpy.nonzero(columns)[0]
        assert numpy.nonzero(columns > 0.8 * columns.max())[0].mean() < (seen.min() + seen.max()) / 2
    else:
        assert is_mirrored(image) == mirrored


@pytest.mark.parametrize(("way", "mirrored"), WAYS, ids=[way for way, _ in WAYS])
def test_axes_are_where_they_are_in_the_world(way, mirrored, tmp_path):
    # From the front, the right and above.
    eye = numpy.array([2.0, 2.0, 4.0])
    if way.startswith("python"):
        made = builder(way.split()[1], eye)
        made.light("infinite", L=1.0)
        for points, triangles, color in TIPS:
            paint = made.material("diffuse", reflectance=color)
            made.shape("trianglemesh", P=points, indices=triangles, material=paint)
        scene = made.build()
    else:
        scene = tmp_path / f"a.{way}"
        matrix = alhazen.look_at(eye, (0, 0, 0)) @ alhazen.rotate(180, (0, 1, 0))
        names = [f"color{i}" for i in range(3)]
        painted = [
            {"pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": 0}} for *_, color in TIPS
        ]
        scene.write_text({
            "pbrt": lambda: text_of(TIPS, "LookAt 2 2 4 0 0 0 0 1 0"),
            "gltf": lambda: gltf([(*tip[:2], paint) for tip, paint in zip(TIPS, painted)], matrix.T.reshape(-1).tolist()),
            "obj": lambda: obj([(*tip[:2], name) for tip, name in zip(TIPS, names)]),
        }[way]())
        (tmp_path / "a.mtl").write_text(
            "".join("newmtl {}\nKd {} {} {}\n".format(name, *color) for name, (*_, color) in zip(names, TIPS))
        )
    image = alhazen.render(scene, layers=["albedo"], **SAMPLES)
    seen = alhazen.Image.from_array(image["albedo"])
    red, green, blue = (find(seen, channel) for channel in range(3))
    assert (red[0] < blue[0]) == mirrored
    assert green[1] < red[1] and green[1] < blue[1]


def test_rotations_are_counterclockwise_in_a_right_handed_world():
    made = builder()
    red = {"L": (1.0, 0.0, 0.0)}
    made.shape("sphere", radius=0.2, emission=red, transform=alhazen.rotate(45, (0, 0, 1)) @ alhazen.translate(1, 0, 0))
    x, y = find(alhazen.render(made.build(), **SAMPLES), 0)
    assert x > 0.6 and y < 0.4


def two_halves(path, width=32):
    """A picture that is red at the left and green at the right."""
    array = numpy.zeros((width // 2, width, 3), numpy.float32)
    array[:, : width // 2, 0] = array[:, width // 2 :, 1] = 1
    alhazen.Image.from_array(array).write(path)
    return path


@pytest.mark.parametrize("handedness", ["right", "left"])
def test_an_environment_is_seen_as_its_image_is(handedness, tmp_path):
    made = builder(handedness, (0, 0, 0), (-1, 0, 0), (0, 0, 1), fov=60)
    made.light("infinite", filename=two_halves(tmp_path / "sky.exr"))
    image = alhazen.render(made.build(), **SAMPLES)
    assert find(image, 0)[0] < 0.4 and find(image, 1)[0] > 0.6


@pytest.mark.parametrize("handedness", ["right", "left"])
def test_a_projector_shows_its_image_on_a_wall(handedness, tmp_path):
    made = builder(handedness, (0, 0, 0), (-1, 0, 0), (0, 0, 1), fov=60)
    wall = [[-3, -9, -9], [-3, 9, -9], [-3, 9, 9], [-3, -9, 9]]
    made.shape("trianglemesh", P=wall, indices=[0, 1, 2, 0, 2, 3])
    place = alhazen.look_at((0, 0, 0), (-1, 0, 0), (0, 0, 1))
    made.light("projection", filename=two_halves(tmp_path / "slide.exr"), transform=place, scale=20.0)
    image = alhazen.render(made.build(), **SAMPLES)
    assert find(image, 0)[0] < 0.45 and find(image, 1)[0] > 0.55


def wall(z):
    return {"P": [[-9, -9, z], [9, -9, z], [9, 9, z], [-9, 9, z]], "indices": [0, 1, 2, 0, 2, 3]}


@pytest.mark.parametrize("handedness", ["right", "left"])
def test_a_light_shines_as_a_spherical_camera_sees(handedness, tmp_path):
    made = alhazen.SceneBuilder(handedness=handedness)
    made.film(xresolution=64, yresolution=64)
    made.camera("spherical", mapping="equalarea")
    made.shape("sphere", radius=0.4, emission=5.0, transform=alhazen.translate(1, 0, 2))
    alhazen.render(made.build(), spp=4).write(tmp_path / "sphere.exr")
    made = builder(handedness, (0, 0, 0), (0, 0, 1), fov=80)
    made.shape("trianglemesh", **wall(3))
    made.light("goniometric", filename=tmp_path / "sphere.exr", scale=100.0)
    columns = numpy.asarray(alhazen.render(made.build(), **SAMPLES)).sum((0, 2))
    is_left = columns[:24].sum() > 10 * columns[24:].sum()
    assert is_left == (handedness == "right")


@pytest.mark.parametrize(("handedness", "z"), [("right", -3), ("left", 3)])
def test_a_measured_luminaire_is_counterclockwise_in_a_right_handed_world(handedness, z, tmp_path):
    # Light at 90 degrees of the horizontal angles from 0 to 360, from x around y.
    rows = "\n".join(f"0 {100 if angle == 90 else 0} 0" for angle in range(0, 361, 90))
    (tmp_path / "a.ies").write_text(
        f"IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 5 1 2 0 0 0\n1 1 0\n0 90 180\n0 90 180 270 360\n{rows}\n"
    )

    def seen(z):
        made = builder(handedness, (0, 0, 0), (0, 0, z))
        made.light("goniometric", filename=tmp_path / "a.ies", scale=100.0)
        made.shape("trianglemesh", **wall(z))
        return alhazen.render(made.build(), **SAMPLES).pixels.mean()

    assert seen(z) > 10 * seen(-z)


def test_a_texture_is_seen_as_its_image_is(tmp_path):
    made = builder()
    paint = made.material(
        "diffuse", reflectance=made.texture("spectrum", "imagemap", filename=two_halves(tmp_path / "a.png"))
    )
    quad = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]
    uv = [[0, 0], [1, 0], [1, 1], [0, 1]]
    made.shape("trianglemesh", P=quad, indices=[0, 1, 2, 0, 2, 3], uv=uv, material=paint)
    made.light("infinite", L=1.0)
    image = alhazen.render(made.build(), **SAMPLES)
    assert find(image, 0)[0] < 0.5 < find(image, 1)[0]


def test_a_panorama_of_a_right_handed_world_is_not_mirrored():
    made = alhazen.SceneBuilder()
    made.film(xresolution=64, yresolution=32)
    made.camera("spherical", mapping="equirectangular")
    for x, color in ((1, (1.0, 0.0, 0.0)), (-1, (0.0, 1.0, 0.0))):
        # Ahead, and at the left of who looks along +z with y up, or at the right.
        made.shape("sphere", radius=0.4, emission=color, transform=alhazen.translate(x, 0, 2))
    image = alhazen.render(made.build(), spp=16)
    assert find(image, 0)[0] < find(image, 1)[0]


@pytest.mark.parametrize("handedness", ["right", "left"])
def test_faces_shine_to_the_side_of_their_normals(handedness):
    for corners, is_lit in (([0, 1, 2, 0, 2, 3], True), ([0, 2, 1, 0, 3, 2], False)):
        made = builder(handedness)
        quad = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]
        made.shape("trianglemesh", P=quad, indices=corners, emission=1.0)
        assert (alhazen.render(made.build(), spp=1).pixels.max() > 0.5) == is_lit


def test_a_built_world_is_packed_as_it_is(tmp_path):
    scene = letter_of("python right", tmp_path)
    image = alhazen.render(scene, layers=["depth"], **SAMPLES)
    packed = alhazen.render(scene.pack(), layers=["depth"], **SAMPLES)
    assert (packed.pixels == image.pixels).all() and not is_mirrored(packed)


def test_a_world_has_one_of_two_handednesses():
    assert alhazen.SceneBuilder().handedness == "right"
    with pytest.raises(ValueError, match='"right" or "left", not "up"'):
        alhazen.SceneBuilder(handedness="up")
