"""Processes that are forked: multiprocessing's default on Linux up to Python 3.13.

Each case runs in a process of its own with a limit of time, as a fault would wait for ever.
"""

import os
import subprocess
import sys

import pytest

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="the system does not fork")

PREPARE = """
import multiprocessing, os, signal, sys, threading, time
import alhazen, numpy

# Buffered text would be written by the child, too.
sys.stdout.reconfigure(line_buffering=True)

def scene():
    builder = alhazen.SceneBuilder()
    builder.film(xresolution=16, yresolution=16)
    builder.camera(transform=alhazen.look_at((0, 0, 5), (0, 0, 0)))
    builder.light("infinite", L=1.0)
    builder.shape("sphere")
    return builder.build()

def work(seed):
    return float(alhazen.render(scene(), spp=1, seed=seed).pixels.mean())

def forked(do):
    # The result of a child: "done", an error, or "hangs".
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        signal.alarm(30)
        try:
            do()
            found = "done"
        except BaseException as error:
            found = f"{type(error).__name__}: {error}"
        os.write(writer, found.encode())
        os._exit(0)
    os.close(writer)
    found = os.read(reader, 4096).decode()
    os.waitpid(child, 0)
    return found or "hangs"

def threads():
    return len(os.listdir("/proc/self/task"))
"""


def run(code, seconds=120):
    result = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", PREPARE + code],
        capture_output=True,
        text=True,
        timeout=seconds,
    )
    assert result.returncode == 0, result.stderr
    return result.stdout.split("\n")[:-1]


BEFORE = {
    "nothing": "pass",
    "load": "alhazen.load(path)",
    "build": "scene()",
    "compile": "alhazen.compile(scene())",
    "render": "work(0)",
    "render on one thread": "alhazen.render(scene(), spp=1, threads=1)",
    "image": """
image = alhazen.render(scene(), spp=1)
image.write(path + ".exr"); alhazen.Image.open(path + ".exr"); image.png(); alhazen.compare(image, image)
""",
    "film": """
job = alhazen.compile(scene(), spp=4)
film = job.render_shard(1, 2); film.merge(job.render_shard(2, 2)); film.image(); film.write(path + ".film")
""",
}

AFTER = """
again = alhazen.compile(scene(), spp=2)
for name, do in {
    "load": lambda: alhazen.load(path),
    "build": scene,
    "compile": lambda: alhazen.compile(scene()),
    "render": lambda: work(1),
    "render on one thread": lambda: alhazen.render(scene(), spp=1, threads=1),
    "job of the parent": lambda: again.render(),
    "write": lambda: alhazen.Image.from_array(numpy.zeros((64, 64, 3), "f4")).write(path + ".2.exr"),
    "nested": lambda: print(forked(lambda: work(2)), file=sys.stderr),
    "from a child's child": lambda: work(3) and (forked(lambda: work(4)) == "done" or 1 / 0),
}.items():
    print(name, forked(do))
"""


@pytest.mark.parametrize("before", BEFORE)
def test_a_forked_process_does_everything(before, tmp_path):
    path = tmp_path / "scene.pbrt"
    path.write_text('Film "rgb" "integer xresolution" 8 "integer yresolution" 8\nWorldBegin\nLightSource "infinite"')
    lines = run(f"path = {str(path)!r}\n{BEFORE[before]}\n{AFTER}")
    assert len(lines) == 9 and all(line.endswith(" done") for line in lines), lines


def test_pools_of_forked_processes_render():
    code = """
first = work(0)
with multiprocessing.get_context("fork").Pool(2) as pool:
    values = pool.map_async(work, range(4)).get(timeout=60)
print(values == [work(seed) for seed in range(4)] and values[0] == first)
"""
    assert run(code) == ["True"]


@pytest.mark.skipif(not os.path.exists("/proc/self/task"), reason="counts threads in /proc")
def test_no_thread_outlives_its_call(tmp_path):
    code = f"path = {str(tmp_path / 'a.pbrt')!r}\n" + """
open(path, "w").write("WorldBegin")
before = threads()
scene(); alhazen.load(path); work(0)
"""
    after = """
end = time.monotonic() + 10
while threads() > before and time.monotonic() < end:
    time.sleep(0.01)
print(threads() - before)
"""
    assert run(code + BEFORE["image"] + BEFORE["film"] + after) == ["0"]


def test_a_process_forked_in_the_midst_of_a_render_says_so():
    code = """
job = alhazen.compile(scene(), spp=1 << 30)
begun, ended = threading.Event(), threading.Event()

def go_on(progress):
    begun.set()
    if ended.is_set():
        raise SystemExit

thread = threading.Thread(target=lambda: job.render(progress=go_on))
thread.start()
begun.wait()
for do in (lambda: job.render(), lambda: work(0), lambda: alhazen.load(b"PK"), scene):
    print(forked(do))
print(forked(lambda: print(forked(scene))))
ended.set()
thread.join()
print(forked(lambda: work(0)), work(0) > 0)
"""
    *errors, last = run(code)
    assert len(errors) == 6 and last == "done True"
    assert errors[5] == "done"
    for error in errors[:5]:
        assert error.startswith("RuntimeError") and '"spawn"' in error


def test_a_callback_may_fork():
    code = """
def fork(progress):
    if not children:
        children.append(os.fork())

children = []
try:
    passes = alhazen.render(scene(), spp=2000, progress=fork).metadata["samplesPerPixel"]
except RuntimeError as error:
    passes = str(error)
if children == [0]:
    os._exit(0 if "spawn" in passes else 1)
print(passes, os.waitstatus_to_exitcode(os.waitpid(children[0], 0)[1]))
"""
    assert run(code) == ["2000 0"]
