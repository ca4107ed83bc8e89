"""Tests of renders on a cluster: one of several nodes on this machine, some of whose workers die.

They need Ray, and are skipped without it.
"""

import os
import random
import signal
import subprocess
import sys
import threading
import time
import warnings
from pathlib import Path

import alhazen
import numpy
import pytest

os.environ["RAY_USAGE_STATS_ENABLED"] = "0"
# Nodes of the test have no token; a driver with one that was left in the home folder would not
# answer them.
os.environ["RAY_AUTH_MODE"] = "disabled"
ray = pytest.importorskip("ray", reason="the tests of clusters need `pip install ray`")

import alhazen.cluster  # noqa: E402
from ray.cluster_utils import Cluster  # noqa: E402

SCENE = """
Film "rgb" "integer xresolution" 48 "integer yresolution" 32
Sampler "independent" "integer pixelsamples" 64
Camera "perspective" "float fov" 40
WorldBegin
LightSource "infinite" "rgb L" [1 0.5 0.25]
Include "ball.pbrt"
"""
BALL = """
Translate 0 0 5
Material "coateddiffuse"
Shape "sphere"
"""


@pytest.fixture(scope="module")
def cluster():
    nodes = Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False})
    nodes.add_node(num_cpus=2)
    nodes.add_node(num_cpus=2)
    ray.init(address=nodes.address, log_to_driver=False)
    yield nodes
    ray.shutdown()
    nodes.shutdown()


@pytest.fixture
def scene(tmp_path):
    (tmp_path / "ball.pbrt").write_text(BALL)
    path = tmp_path / "scene.pbrt"
    path.write_text(SCENE)
    return path


def workers() -> list[int]:
    """The processes that run tasks."""
    found = []
    for entry in Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and b"_render_shard" in (entry / "cmdline").read_bytes():
                found.append(int(entry.name))
        except OSError:
            pass
    return found


def test_shards_have_the_bits_of_the_whole(cluster, scene):
    told = []
    image = alhazen.cluster.render(scene, shards=7, progress=told.append, layers=["depth"])
    whole = alhazen.render(scene, layers=["depth"])
    assert (image.pixels == whole.pixels).all()
    assert [each.shards for each in told] == list(range(1, 8)) and told[-1].passes == 64


@pytest.mark.skipif(not Path("/proc").exists(), reason="finds workers in /proc")
def test_workers_that_are_killed_are_replaced(cluster, scene):
    whole = numpy.asarray(alhazen.render(scene, spp=512))
    done, killed = threading.Event(), []

    def kill():
        chance = random.Random(1)
        while not done.is_set() and len(killed) < 4:
            time.sleep(0.2)
            if running := workers():
                killed.append(chance.choice(running))
                os.kill(killed[-1], signal.SIGKILL)

    killer = threading.Thread(target=kill)
    killer.start()
    try:
        image = alhazen.cluster.render(scene, spp=512)
    finally:
        done.set()
        killer.join()
    assert killed
    assert (numpy.asarray(image) == whole).all()


def test_a_render_is_continued_from_its_checkpoint(cluster, scene, tmp_path):
    path = tmp_path / "a.film"

    def stop(progress):
        if progress.shards == 3:
            raise InterruptedError

    with pytest.raises(InterruptedError):
        alhazen.cluster.render(scene, shards=16, checkpoint=path, progress=stop)
    film = alhazen.Film.open(path)
    assert 0 < film.passes < 64 and len(film.missing) == 13
    told = []
    image = alhazen.cluster.render(scene, checkpoint=path, progress=told.append, shards=5)
    assert [each.shards for each in told] == list(range(4, 17))
    assert (image.pixels == alhazen.render(scene).pixels).all()
    # Now there is nothing left to do.
    assert (alhazen.cluster.render(scene, checkpoint=path).pixels == image.pixels).all()
    with pytest.raises(ValueError):
        alhazen.cluster.render(scene, checkpoint=path, spp=65)


def test_errors_are_those_of_one_machine(cluster, scene):
    with pytest.raises(ValueError, match="foo"):
        alhazen.cluster.render(scene, integrator="foo")
    scene.write_text("WorldBegin Shape \"spere\"")
    with pytest.raises(alhazen.SceneError, match="scene.pbrt:1"):
        alhazen.cluster.render(scene)


def test_time_ends_a_render(cluster, scene):
    image = alhazen.cluster.render(scene, spp=1 << 20, shards=1 << 14, time=0.5)
    assert 0 < image.metadata["samplesPerPixel"] < 1 << 20


def test_time_and_noise_go_on_beyond_the_planned_passes(cluster, scene, tmp_path):
    told = []
    image = alhazen.cluster.render(scene, time=4.0, progress=told.append, shards=4)
    assert image.metadata["samplesPerPixel"] > 64 and told[-1].total is None
    assert image.metadata["samplesPerPixel"] == told[-1].passes == 16 * told[-1].shards
    path = tmp_path / "a.film"
    image = alhazen.cluster.render(scene, noise=0.03, shards=4, checkpoint=path)
    samples = image.metadata["samplesPerPixel"]
    assert samples > 64 and samples % 16 == 0
    # The first passes are those of one machine.
    assert (image.pixels == alhazen.render(scene, spp=samples).pixels).all()
    again = alhazen.cluster.render(scene, noise=0.025, checkpoint=path)
    assert again.metadata["samplesPerPixel"] > samples
    with pytest.raises(ValueError, match="time or noise"):
        alhazen.cluster.render(scene, checkpoint=path)
    with pytest.warns(alhazen.RenderWarning, match="after all passes, above the limit of 0.0001") as found:
        alhazen.cluster.render(scene, spp=64, noise=0.0001)
    assert found[0].filename == __file__


def test_cores_that_the_cluster_lacks_are_an_error(cluster, scene):
    with pytest.raises(ValueError, match="threads=3, but the largest machine of the cluster has 2 cores"):
        alhazen.cluster.render(scene, threads=3, time=3.0)
    for name in ("threads", "shards"):
        with pytest.raises(ValueError, match=f"{name} is 1 or more, not -1"):
            alhazen.cluster.render(scene, **{name: -1})


def test_time_is_heeded_while_all_cores_are_in_use(cluster, scene):
    @ray.remote(num_cpus=1)
    class Busy:
        def begin(self):
            return True

    busy = [Busy.remote() for _ in range(5)]
    ray.get([each.begin.remote() for each in busy])
    begin = time.monotonic()
    try:
        with pytest.raises(TimeoutError, match="no machine had 1 cores free"):
            alhazen.cluster.render(scene, threads=1, time=0.5)
    finally:
        for each in busy:
            ray.kill(each)
    assert time.monotonic() - begin < 30


def test_warnings_are_told_once(cluster, tmp_path):
    path = tmp_path / "dark.pbrt"
    path.write_text('WorldBegin\nTransformBegin\nTranslate 0 0 5\nShape "sphere"\nTransformEnd\n')
    for source in (path, alhazen.load(path), alhazen.load(path).pack()):
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            alhazen.cluster.render(source, spp=2, resolution=(8, 8), shards=2)
        assert {each.category for each in told} == {alhazen.SceneWarning}
        assert {each.filename for each in told} == {__file__}
        texts = [str(each.message) for each in told]
        assert len(set(texts)) == len(texts), texts
        assert sum("light" in text for text in texts) == 1
        assert sum("TransformBegin" in text for text in texts) == (0 if isinstance(source, alhazen.Scene) else 1)


def test_noise_ends_a_render_after_the_same_shard(cluster, scene, tmp_path):
    path = tmp_path / "a.film"
    arguments = {"spp": 1024, "shards": 128, "noise": 0.03}
    images = [alhazen.cluster.render(scene, checkpoint=path, **arguments)]
    film = alhazen.Film.open(path)
    assert 8 <= film.passes < 1024 and film.passes % 8 == 0 and film.noise <= 0.03
    images.append(alhazen.cluster.render(scene, **arguments))
    assert (images[0].pixels == images[1].pixels).all()
    # The checkpoint is good enough already.
    assert (alhazen.cluster.render(scene, checkpoint=path, **arguments).pixels == images[0].pixels).all()


def test_the_command_line(scene, tmp_path):
    output = tmp_path / "a.exr"
    command = [sys.executable, "-m", "alhazen.cluster", scene, "-o", output, "--threads", "1", "--spp", "4"]
    result = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    assert "4/4 shards, 4 passes" in result.stdout
    assert (alhazen.Image.open(output).pixels == alhazen.render(scene, spp=4).pixels).all()
    command[3] = tmp_path / "none.pbrt"
    result = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    assert result.returncode == 1 and "none.pbrt" in result.stderr
