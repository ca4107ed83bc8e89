"""Tests of what shows a render: its progress, its picture, its layers by name."""

import io
import sys

import alhazen
import alhazen.bar
import alhazen.notebook
import numpy
import pytest


@pytest.fixture
def scene():
    builder = alhazen.SceneBuilder()
    builder.film(xresolution=12, yresolution=8)
    builder.camera(fov=40, transform=alhazen.look_at((0, 0, 5), (0, 0, 0)))
    builder.sampler("independent", pixelsamples=8)
    builder.light("infinite", L=(1.0, 0.5, 0.2))
    builder.shape("sphere", material=builder.material("diffuse", reflectance=(0.5, 0.2, 0.1)))
    return builder.build()


def test_layers_have_the_names_with_which_they_are_rendered(scene):
    names = {"depth": "Z", "normal": "N", "albedo": "albedo", "position": "P", "samples": "samples"}
    image = alhazen.render(scene, layers=[*names, "uv", "object-id"])
    for name, in_file in names.items():
        assert (image[name] == image[in_file]).all(), name
    assert image["depth"].shape == (8, 12) and image["normal"].shape == (8, 12, 3)
    assert image["object-id"].shape[:2] == (8, 12) and numpy.shares_memory(image["object-id"], image.pixels)
    with pytest.raises(KeyError, match="there is no layer \"motion\""):
        image["motion"]


def test_layers_of_a_geometry_buffer_are_those_of_its_names(scene):
    builder = alhazen.SceneBuilder()
    builder.film("gbuffer", xresolution=8, yresolution=8)
    builder.light("infinite")
    image = alhazen.render(builder.build(), spp=1)
    assert (image["albedo"] == image["Albedo"]).all() and image["uv"].shape == (8, 8, 2)
    # Its P are in the space of the camera.
    with pytest.raises(KeyError):
        image["position"]


def test_a_picture_has_a_shape_and_is_saved(scene, tmp_path):
    image = alhazen.render(scene, layers=["depth"])
    assert image.shape == (8, 12, 3) == numpy.asarray(image).shape
    image.save(tmp_path / "a.exr")
    assert alhazen.Image.open(tmp_path / "a.exr").layers == image.layers


def test_arrays_of_real_numbers_are_pictures():
    for kind in (numpy.float16, numpy.float32, numpy.float64):
        array = numpy.full((2, 3, 3), 0.25, kind)
        assert (alhazen.Image.from_array(array).pixels == 0.25).all()
        assert alhazen.Image.from_array(array[::-1, ::2]).shape == (2, 2, 3)


def test_a_picture_is_shown_by_the_viewer_of_the_system(scene, monkeypatch, tmp_path):
    shown = []
    monkeypatch.delitem(sys.modules, "ipykernel", raising=False)
    monkeypatch.setattr(alhazen.notebook.sys, "platform", "linux")
    monkeypatch.setattr(alhazen.notebook.tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(alhazen.notebook.shutil, "which", lambda name: name)
    monkeypatch.setattr(alhazen.notebook.subprocess, "Popen", lambda command, **_: shown.append(command))
    alhazen.render(scene, spp=1).show(view="agx")
    (viewer, path), = shown
    assert viewer == "xdg-open" and open(path, "rb").read(4) == b"\x89PNG"
    monkeypatch.setattr(alhazen.notebook.shutil, "which", lambda name: None)
    with pytest.raises(RuntimeError, match="xdg-open"):
        alhazen.render(scene, spp=1).show()


def test_progress_is_a_line_with_the_time_left(scene, capfd):
    alhazen.render(scene, spp=20, progress=True)
    lines = capfd.readouterr().err.splitlines()
    assert lines[-1].startswith("[########################] 20/20 passes, ") and lines[-1].endswith(", 0.0 s left")
    # A line for each tenth at most, and the last.
    assert len(lines) <= 12
    alhazen.render(scene, spp=20, progress=False)
    assert capfd.readouterr().err == ""


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_progress_rewrites_its_line_in_a_terminal(monkeypatch):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setattr(alhazen.bar, "INTERVAL", 0)

    class Progress:
        passes, total, seconds, noise = 5, 20, 10.0, None

    bar = alhazen.bar.Bar()
    bar(Progress)
    Progress.passes, Progress.seconds = 20, 40.0
    bar(Progress)
    bar.close()
    first, second, last = terminal.getvalue().split("\r")[1:]
    assert first.startswith("[######------------------] 5/20 passes, 10 s, 30 s left")
    assert second.strip() == last.strip() and last.endswith("\n")


def test_time_left_is_that_of_the_first_limit():
    class Progress:
        passes, total, seconds, noise = 100, None, 60.0, 0.04

    for limits, left in (((None, 0.02), "3 min 0 s left"), ((90.0, 0.02), "30 s left"), ((None, None), "1 min 0 s")):
        assert alhazen.bar.Bar(*limits)._describe(Progress)[1].endswith(left), limits


def test_a_failing_render_ends_the_line(scene, monkeypatch):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)

    def fail(_):
        raise InterruptedError

    with pytest.raises(InterruptedError):
        alhazen.render(scene, spp=1 << 20, progress=True, preview=fail)
    assert terminal.getvalue().endswith("\n")
