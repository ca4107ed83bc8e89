"""Tests of the package: arrays, errors, interruption, threads."""

import _thread
import pickle
import signal
import threading
import time
import warnings

import alhazen
import numpy
import pytest

SCENE = """
Film "rgb" "integer xresolution" 24 "integer yresolution" 16
Sampler "independent" "integer pixelsamples" 4
Camera "perspective" "float fov" 40
WorldBegin
LightSource "infinite" "rgb L" [1 0.5 0.25]
Translate 0 0 5
Material "diffuse"
Shape "sphere"
"""


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "ball.pbrt"
    path.write_text(SCENE)
    return alhazen.load(path)


def test_a_render_is_an_array(scene):
    image = alhazen.render(scene, resolution=(30, 20), spp=64)
    array = numpy.asarray(image)
    assert array.shape == (20, 30, 3) and array.dtype == numpy.float32
    # The sky behind the ball.
    assert numpy.allclose(array[:4, :4].mean((0, 1)), [1, 0.5, 0.25], rtol=0.05)
    assert (image.width, image.height) == (30, 20)
    assert image.metadata["samplesPerPixel"] == 64


def test_arrays_share_the_memory_of_the_picture(scene):
    image = alhazen.render(scene)
    array = numpy.asarray(image)
    assert numpy.shares_memory(array, image.pixels)
    assert numpy.shares_memory(image["R"], array)
    kept = array.copy()
    del image
    assert (array == kept).all()
    assert numpy.array(array, copy=True).base is None


def test_threads_and_paths_do_not_change_a_bit(scene):
    one = numpy.asarray(alhazen.render(scene, threads=1))
    two = numpy.asarray(alhazen.render(scene.path, threads=2))
    assert (one == two).all()
    assert (one != numpy.asarray(alhazen.render(scene, seed=1))).any()


def test_layers(scene):
    image = alhazen.render(scene, layers=["depth", "normal"])
    assert image.layers == ["RGB", "Z", "N"]
    assert image["Z"].shape == (16, 24) and image["N"].shape == (16, 24, 3)
    # The ball is nearest in the middle.
    assert image["Z"].min() == pytest.approx(4, abs=0.1)
    with pytest.raises(KeyError, match="there is no layer"):
        image["albedo"]


def test_settings(scene):
    image = alhazen.render(scene, integrator="ambient-occlusion", settings={"iso": 200, "cossample": False})
    assert image.metadata["integrator"] == "ambient-occlusion"
    with pytest.raises(ValueError, match="maxdept"):
        alhazen.render(scene, settings={"integrator.maxdept": 3})
    with pytest.raises(ValueError, match="no-such"):
        alhazen.render(scene, integrator="no-such")
    with pytest.raises(ValueError):
        alhazen.render(scene, time=-1.0)


def test_every_integrator_renders(scene):
    names = alhazen.integrators()
    assert "path" in names and "bdpt" in names
    for name in ["path", "bdpt", "light-tracing"]:
        mean = numpy.asarray(alhazen.render(scene, integrator=name, spp=16)).mean()
        assert mean > 0


def test_errors_have_places(tmp_path):
    path = tmp_path / "wrong.pbrt"
    path.write_text('WorldBegin\nShape "sphere" "float radios" 1\nShape "no-such"\n')
    with pytest.raises(alhazen.SceneError, match=r"wrong\.pbrt:3:\d+: error\["):
        alhazen.load(path)
    path.write_text('WorldBegin\nInclude "missing.pbrt"\n')
    with pytest.raises(alhazen.SceneError, match=r"wrong\.pbrt:2:.*missing\.pbrt"):
        alhazen.render(path)


def test_warnings(tmp_path):
    path = tmp_path / "odd.pbrt"
    path.write_text('WorldBegin\nShape "sphere" "float radios" 1\n')
    try:
        found = alhazen.load(path).warnings
    except alhazen.SceneError as error:
        found = str(error).splitlines()
    assert any("radios" in warning for warning in found)


def test_warnings_are_told_at_the_line_of_the_program(tmp_path):
    path = tmp_path / "odd.pbrt"
    path.write_text('WorldBegin\nTransformBegin\nTransformEnd\nLightSource "infinite"\n')
    with pytest.warns(alhazen.SceneWarning, match=r"odd\.pbrt:2:\d+: warning\[deprecated") as told:
        scene = alhazen.load(path)
    assert [str(each.message) for each in told] == scene.warnings
    assert {each.filename for each in told} == {__file__}
    # A scene that is not loaded anew is not warned of anew.
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        alhazen.compile(scene, spp=1, resolution=(8, 8))

    def dark():
        builder = alhazen.SceneBuilder()
        builder.film(xresolution=8, yresolution=8)
        builder.camera(transform=alhazen.look_at((0, 0, 5), (0, 0, 0)))
        builder.shape("sphere")
        return builder.build()

    scene = dark()
    for do in (alhazen.compile, alhazen.render):
        with pytest.warns(alhazen.SceneWarning, match="light") as told:
            do(scene, spp=1)
        assert len(told) == 1 and told[0].filename == __file__
    # A warning that a line repeats is shown once.
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("default")
        for _ in range(3):
            alhazen.render(dark(), spp=1)
    assert len(told) == 1
    with warnings.catch_warnings(), pytest.raises(alhazen.SceneWarning):
        warnings.simplefilter("error")
        alhazen.render(scene, spp=1)


def test_time_and_noise_go_on_beyond_the_planned_passes(scene):
    planned = alhazen.compile(scene).passes
    image = alhazen.render(scene, time=0.5)
    assert image.metadata["samplesPerPixel"] > planned
    told = []
    image = alhazen.render(scene, noise=0.05, progress=told.append)
    assert image.metadata["samplesPerPixel"] > planned
    for arguments in ({"time": 60.0}, {"noise": 0.5}):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", alhazen.RenderWarning)
            assert alhazen.render(scene, spp=4, **arguments).metadata["samplesPerPixel"] == 4


def test_noise_that_is_not_reached_is_a_warning(scene):
    for arguments, end in (({"spp": 16}, "after all passes"), ({"time": 0.3}, "when the time was up")):
        with pytest.warns(alhazen.RenderWarning, match=f"noise is .* {end}, above the limit of 0.00001") as told:
            alhazen.render(scene, noise=1e-5, **arguments)
        assert told[0].filename == __file__
    with pytest.warns(alhazen.RenderWarning, match="2 are too few"):
        alhazen.render(scene, noise=0.1, spp=2)


def test_samples_are_as_many_as_asked_for(scene):
    for sampler in ("independent", "stratified", "halton", "paddedsobol", "sobol", "zsobol", "pmj02bn"):
        job = alhazen.compile(scene, spp=5, settings={"sampler": sampler})
        assert job.passes == 5 and job.render().metadata["samplesPerPixel"] == 5, sampler


def test_an_interrupt_ends_a_render(scene):
    # A shell starts background jobs with interrupts ignored.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    threading.Timer(0.3, _thread.interrupt_main).start()
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        alhazen.render(scene, spp=10_000_000)
    assert time.monotonic() - begin < 20


def test_callbacks(scene):
    told = []
    alhazen.render(scene, spp=8, progress=told.append)
    assert told[-1].passes == told[-1].total == 8

    def fail(progress):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        alhazen.render(scene, spp=10_000_000, progress=fail)


def test_previews(scene):
    shown = []
    alhazen.render(scene, spp=10_000_000, time=1.5, preview=shown.append)
    assert len(shown) > 1 and numpy.asarray(shown[0]).shape == (16, 24, 3)
    image = alhazen.render(scene, spp=1, preview=shown.append)
    assert shown[-1] is image


def test_wrong_limits_and_callbacks_are_refused(scene):
    for threads in (0, 1_000_000):
        with pytest.raises(ValueError, match="`threads` is a whole number from 1"):
            alhazen.render(scene, threads=threads)
    for noise in (0, -1, float("nan")):
        with pytest.raises(ValueError, match="noise"):
            alhazen.render(scene, noise=noise)
    for name in ("progress", "preview"):
        with pytest.raises(TypeError, match=name):
            alhazen.render(scene, **{name: "x"})
    with pytest.raises(TypeError, match="not of the film"):
        alhazen.render(scene, integrator=alhazen.settings.film(iso=100))


def test_errors_of_files_name_them(scene, tmp_path):
    missing = tmp_path / "missing" / "a.exr"
    with pytest.raises(FileNotFoundError, match="a.exr"):
        alhazen.Image.open(missing)
    with pytest.raises(FileNotFoundError, match="a.exr"):
        alhazen.render(scene, spp=1).write(missing)
    film = missing.with_suffix(".film")
    with pytest.raises(FileNotFoundError, match="a.film"):
        alhazen.Film.open(film)
    with pytest.raises(FileNotFoundError, match="a.film"):
        alhazen.compile(scene, spp=1).blank_film().write(film)


def test_the_lock_is_released(scene):
    count = 0
    done = threading.Event()

    def work():
        nonlocal count
        while not done.is_set():
            count += 1
            time.sleep(0.001)

    thread = threading.Thread(target=work)
    thread.start()
    alhazen.render(scene, spp=10_000_000, time=1.0)
    done.set()
    thread.join()
    assert count > 50


def test_renders_in_several_threads(scene):
    pictures = [None] * 4

    def work(i):
        pictures[i] = numpy.asarray(alhazen.render(scene, threads=1))

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all((picture == pictures[0]).all() for picture in pictures)


def test_files_and_comparison(scene, tmp_path):
    image = alhazen.render(scene)
    image.write(tmp_path / "ball.exr")
    image.write(tmp_path / "ball.png", view="agx", exposure=1.0, white_balance=5000)
    again = alhazen.Image.open(tmp_path / "ball.exr")
    assert alhazen.compare(image, again).mse < 1e-6
    brighter = alhazen.Image.from_array(numpy.asarray(image) * 1.5)
    difference = alhazen.compare(image, brighter)
    assert difference.mean[0] == pytest.approx(1.5 * difference.reference_mean[0])
    assert image.png()[:4] == b"\x89PNG" == image._repr_png_()[:4]
    with pytest.raises(OSError):
        image.write(tmp_path / "nowhere" / "ball.exr")
    with pytest.raises(ValueError, match="there is no view"):
        image.png(view="sepia")
    with pytest.raises(ValueError, match="three channels"):
        alhazen.Image.from_array(numpy.zeros((2, 2, 4), numpy.float32))


def test_pictures_are_pickled(scene):
    image = alhazen.render(scene, layers=["object-id", "normal", "depth"])
    again = pickle.loads(pickle.dumps(image))
    assert again.channels == image.channels and (again.pixels == image.pixels).all()
    assert again.metadata == image.metadata


def test_files_have_the_channels_of_a_layer_in_order(scene, tmp_path):
    image = alhazen.render(scene, layers=["object-id", "albedo"])
    image.write(tmp_path / "a.exr")
    read = alhazen.Image.open(tmp_path / "a.exr")
    assert numpy.allclose(read["albedo"], image["albedo"], rtol=1e-3)
    assert (read["CryptoObject00"] == image["CryptoObject00"]).all()


def test_films_merge_to_the_bits_of_the_whole(scene, tmp_path):
    job = alhazen.compile(scene, spp=8)
    assert job.passes == 8
    parts = [job.render_shard(index, 4) for index in (3, 1, 4)]
    film = pickle.loads(pickle.dumps(parts[0]))
    for part in parts[1:]:
        film.merge(part)
    assert film.passes == 6 and film.missing == ["shard 2/4 (passes 2-3)"]
    with pytest.raises(ValueError, match="passes"):
        film.merge(parts[1])
    with pytest.raises(ValueError):
        film.merge(alhazen.compile(scene, spp=8, seed=2).render_shard(2, 4))
    film.write(tmp_path / "a.film")
    film = alhazen.Film.open(tmp_path / "a.film")
    film.merge(bytes(job.render_shard(2, 4)))
    assert not film.missing
    assert (film.image().pixels == job.render().pixels).all()
    for index in (0, 5):
        with pytest.raises(ValueError):
            job.render_shard(index, 4)
    with pytest.raises(ValueError, match="empty"):
        job.render_shard(1, 9)


def test_a_job_renders_once_at_a_time(scene):
    job = alhazen.compile(scene, spp=1 << 20)
    with pytest.raises(RuntimeError, match="already"):
        job.render(progress=lambda _: job.render())


def test_archives_are_scenes(scene):
    archive = scene.pack()
    packed = alhazen.load(archive)
    assert packed.pack() == archive == scene.pack()
    assert (alhazen.render(archive).pixels == alhazen.render(scene).pixels).all()
    with pytest.raises(alhazen.SceneError, match="archive"):
        alhazen.load(b"PK")
