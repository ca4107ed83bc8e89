"""Tests of the command line in the package."""

import subprocess
import sys

import alhazen


def run(*arguments):
    command = [sys.executable, "-m", "alhazen", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True)


def test_the_module_is_the_command_line(tmp_path):
    version = run("--version")
    assert version.returncode == 0 and version.stdout.startswith(f"alhazen {alhazen.__version__}")
    scene, picture = tmp_path / "a.pbrt", tmp_path / "a.exr"
    scene.write_text(
        'Film "rgb" "integer xresolution" 8 "integer yresolution" 8\n'
        'WorldBegin LightSource "infinite" Translate 0 0 5 Shape "sphere"'
    )
    rendered = run("render", scene, "-o", picture, "--spp", "2", "--quiet")
    assert rendered.returncode == 0, rendered.stderr
    image = alhazen.Image.open(picture)
    assert image.shape == (8, 8, 3)
    image = alhazen.render(scene, spp=2)
    image.write(tmp_path / "b.exr")
    assert (alhazen.Image.open(tmp_path / "b.exr").pixels == alhazen.Image.open(picture).pixels).all()


def test_exit_codes_are_those_of_the_program(tmp_path):
    assert run("render", "--no-such").returncode == 2
    missing = run("render", tmp_path / "none.pbrt")
    assert missing.returncode == 1 and "none.pbrt" in missing.stderr
