"""Renders on many machines, as tasks of Ray (https://www.ray.io; `pip install alhazen-renderer[cluster]`).

    import alhazen.cluster
    image = alhazen.cluster.render("scene.pbrt", spp=1024, address="auto")

The passes of a render are split into shards. Each is a task of Ray, and its result a film, whose
sums are exact: the picture has the same bits as that of one machine, whatever the number of shards,
their order, and the workers that were lost meanwhile. The scene travels as one archive, once to
each machine; a worker compiles it once and keeps it for further shards.

From a shell: `python -m alhazen.cluster scene.pbrt -o picture.exr`.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import sys
import time as clock
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

from . import Film, Image, Job, RenderWarning, Scene, SceneError, SceneWarning, compile, load
from .bar import Bar

try:
    import ray
    import ray.exceptions
except ImportError as error:
    raise ImportError("alhazen.cluster needs Ray: pip install alhazen-renderer[cluster]") from error

__all__ = ["Progress", "render"]

#: How often a task is run again whose worker or machine was lost.
RETRIES = 32

#: Seconds in which a worker starts.
STARTING = 5.0

#: The number of passes of a render that only time or noise ends.
ENDLESS = 2**32 - 1

#: Seconds between two saves of the film, and between two previews at most.
INTERVAL = 60.0


@dataclass(frozen=True)
class Progress:
    """How far a render is."""

    #: Shards done, and all of them; None where only time or noise ends the render.
    shards: int
    total: int | None
    #: Passes in the picture, each of one sample per pixel.
    passes: int
    #: Seconds since the start.
    seconds: float


def render(
    scene: Scene | str | os.PathLike[str] | bytes,
    *,
    address: str | None = None,
    shards: int | None = None,
    threads: int | None = None,
    time: float | None = None,
    noise: float | None = None,
    checkpoint: str | os.PathLike[str] | None = None,
    progress: Callable[[Progress], object] | bool | None = None,
    preview: Callable[[Image], object] | None = None,
    **arguments: Any,
) -> Image:
    """Renders a scene on the machines of a Ray cluster.

    scene: a scene, the name of its file, or the bytes of an archive. address: of the cluster, such
    as "auto" or "ray://host:10001"; where Ray is initialised already, that cluster is used; by
    default the one that runs on this machine, or else a new one. shards: the number of parts that the passes are split
    into, by default 16, or 4 for each worker if that is more. threads: of each worker, by default
    the cores of the smallest machine. time: seconds after which no more shards are waited for, if
    there is one; TimeoutError is raised if all cores of the cluster are in use until then.
    noise: the relative error at which the render ends; its shards are then merged in their order, so
    that it ends after the same one on any cluster. With time or noise and no spp, the number of
    passes has no limit, and shards are as large as those of the passes that the scene plans.
    checkpoint: a film file from which the render is continued if it exists, and that is saved every
    minute. progress: True for a line with the time left on standard error, or a function that is
    called with a Progress after shards. preview: called with an Image now and
    then. All other arguments are those of alhazen.compile().

    Ctrl-C ends it with KeyboardInterrupt, after the film was saved; so does an exception of a
    callback.
    """
    for name, value in (("threads", threads), ("shards", shards)):
        if value is not None and value < 1:
            raise ValueError(f"{name} is 1 or more, not {value}")
    archive = scene if isinstance(scene, bytes) else _load(scene).pack()
    saved = None if checkpoint is None or not Path(checkpoint).exists() else Film.open(checkpoint)
    is_limited = time is not None or noise is not None
    if saved is not None:
        if saved.planned is None and not is_limited:
            raise ValueError("the checkpoint is of a render that time or noise ends: give one of them")
        is_limited = saved.planned is None
    if not ray.is_initialized():
        os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
        ray.init(address=address, log_to_driver=False, include_dashboard=False if address is None else None)
    cores = [int(node["Resources"].get("CPU", 0)) for node in ray.nodes() if node["Alive"]]
    threads = threads or min((count for count in cores if count), default=1)
    workers = sum(count // threads for count in cores)
    if any(cores) and not workers:
        raise ValueError(f"threads={threads}, but the largest machine of the cluster has {max(cores)} cores")

    key = hashlib.sha256(archive).hexdigest() + repr(sorted(arguments.items()))
    task = _Task(ray.put(archive), key, arguments, threads, noise is not None, is_limited)
    passes, blank, of_scene, of_job = _planned(task, time)
    # Of a scene that was loaded here, Python has warned already.
    for message in (of_scene if isinstance(scene, bytes) else []) + of_job:
        warnings.warn(message, SceneWarning, stacklevel=2)
    blank = Film.from_bytes(blank)
    is_endless = blank.planned is None
    if saved is not None:
        # It is refused if it is of another render.
        blank.merge(saved)
        count, done = _shards(saved)
    else:
        # The passes of a shard alternate between two films, from which noise is estimated.
        least = 1 if noise is None else 2
        usual = shards or max(16, 4 * workers)
        count, done = min(max(1, passes // least), usual), set()
        if is_endless:
            count = ENDLESS // max(least, -(-passes // count))

    begin = clock.monotonic()
    bar = Bar(time, noise) if progress is True else None
    progress = bar or progress or None
    total = None if is_endless else count
    run = _Run(saved, checkpoint, total, len(done), begin, noise, progress, preview)
    to_start, to_merge = ((index for index in range(1, count + 1) if index not in done) for _ in range(2))
    most = max(16, 4 * workers) if is_endless else count
    indices, waiting, turn = {}, {}, next(to_merge, None)
    try:
        while not run.ended:
            for index in islice(to_start, most - len(indices) - len(waiting)):
                indices[task.start(_render_shard, index, count)] = index
            left = None if time is None else time - (clock.monotonic() - begin)
            if not indices or (left is not None and left <= 0 and run.done):
                break
            wait = 0.2 if left is None else min(0.2, max(left, 0.0))
            ready, _ = ray.wait(list(indices), num_returns=1, timeout=wait)
            for each in ready:
                waiting[indices.pop(each)] = _result(each)
            while waiting and not run.ended and (noise is None or turn in waiting):
                index = next(iter(waiting)) if noise is None else turn
                turn = next(to_merge, None)
                run.add(waiting.pop(index))
    finally:
        for each in indices:
            ray.cancel(each, force=True)
        if bar is not None:
            bar.close()
        run.save()
    if noise is not None and not run.ended:
        end = "when the time was up" if indices else "after all passes"
        found = "unknown" if run.film.noise is None else f"{run.film.noise:.4f}"
        message = f"the noise is {found} {end}, above the limit of {noise}"
        warnings.warn(message, RenderWarning, stacklevel=2)
    return run.film.image()


def _load(scene: Scene | str | os.PathLike[str]) -> Scene:
    return scene if isinstance(scene, Scene) else load(scene)


@dataclass(frozen=True)
class _Task:
    """What all tasks of a render have in common."""

    archive: ray.ObjectRef
    key: str
    arguments: dict[str, Any]
    threads: int
    alternates: bool
    is_limited: bool

    def start(self, function: Any, *arguments: int) -> ray.ObjectRef:
        options = {"num_cpus": self.threads, "max_retries": RETRIES}
        return function.options(**options).remote(
            self.archive, self.key, self.arguments, self.threads, self.alternates, self.is_limited, *arguments
        )


class _Run:
    """The film of a render, and what is told of it."""

    def __init__(self, film, checkpoint, total, done, begin, noise, progress, preview) -> None:
        self.film, self.checkpoint, self.total, self.done = film, checkpoint, total, done
        self.begin, self.progress, self.preview = begin, progress, preview
        self.saved_at, self.is_saved = begin, True
        self.noise = noise
        self.ended = self.is_quiet()
        self.next_preview = 0.5

    def add(self, shard: bytes) -> None:
        if self.film is None:
            self.film = Film.from_bytes(shard)
        else:
            self.film.merge(shard)
        self.done += 1
        self.is_saved = False
        self.ended = self.is_quiet()
        now = clock.monotonic()
        if now - self.saved_at >= INTERVAL:
            self.save()
        seconds = now - self.begin
        if self.progress is not None:
            self.progress(Progress(self.done, self.total, self.film.passes, seconds))
        if self.preview is not None and (seconds >= self.next_preview or self.done == self.total):
            self.preview(self.film.image())
            self.next_preview = seconds + min(seconds, INTERVAL)

    def is_quiet(self) -> bool:
        """Whether the noise of the film is low enough."""
        if self.noise is None or self.film is None:
            return False
        estimate = self.film.noise
        return estimate is not None and estimate <= self.noise

    def save(self) -> None:
        if self.checkpoint is not None and not self.is_saved:
            self.film.write(self.checkpoint)
            self.saved_at, self.is_saved = clock.monotonic(), True


def _shards(saved: Film) -> tuple[int, set[int]]:
    """The number of shards, and the indices of those that a saved film has."""
    all, count = saved.planned or ENDLESS, saved.shards[0][1]
    done = {index for index, _ in saved.shards}
    size = sum(all * index // count - all * (index - 1) // count for index in done)
    if size != saved.passes or any(other != count for _, other in saved.shards):
        raise ValueError("the checkpoint has shards that are not complete; `alhazen resume` completes them")
    return count, done


def _planned(task: _Task, time: float | None) -> tuple[int, bytes, list[str], list[str]]:
    """The result of `_plan`, unless all cores are in use for longer than the render may take."""
    is_free = ray.available_resources().get("CPU", 0) >= task.threads
    reference, begin = task.start(_plan), clock.monotonic()
    try:
        while not ray.wait([reference], timeout=0.2)[0]:
            if not is_free and time is not None and clock.monotonic() - begin > max(time, STARTING):
                raise TimeoutError(f"no machine had {task.threads} cores free in {time} seconds")
    except BaseException:
        ray.cancel(reference, force=True)
        raise
    return _result(reference)


def _result(reference: ray.ObjectRef) -> Any:
    """The result of a task; its exception as the task raised it."""
    try:
        return ray.get(reference)
    except ray.exceptions.RayTaskError as error:
        raise (error.cause if isinstance(error.cause, Exception) else error) from None


#: The compiled scene that a worker keeps, by its key, and the warnings of the scene.
_compiled: dict[str, tuple[Job, list[str]]] = {}


def _job(archive: bytes, key: str, arguments: dict[str, Any]) -> tuple[Job, list[str]]:
    if key not in _compiled:
        _compiled.clear()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            scene = load(archive)
            _compiled[key] = compile(scene, **arguments), scene.warnings
    return _compiled[key]


@ray.remote
def _plan(
    archive: bytes, key: str, arguments: dict[str, Any], threads: int, alternates: bool, is_limited: bool
) -> tuple[int, bytes, list[str], list[str]]:
    job, of_scene = _job(archive, key, arguments)
    blank = job.blank_film(alternate=alternates, limited=is_limited)
    return job.passes, bytes(blank), of_scene, job.warnings


@ray.remote
def _render_shard(
    archive: bytes,
    key: str,
    arguments: dict[str, Any],
    threads: int,
    alternates: bool,
    is_limited: bool,
    index: int,
    count: int,
) -> bytes:
    job, _ = _job(archive, key, arguments)
    shard = job.render_shard(index, count, alternate=alternates, limited=is_limited, threads=threads)
    return bytes(shard)


def _resolution(text: str) -> tuple[int, int]:
    width, _, height = text.partition("x")
    return int(width), int(height)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m alhazen.cluster", description="Render a scene on the machines of a Ray cluster."
    )
    parser.add_argument("scene", help="the scene file, or an archive of a scene")
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="the picture: .exr, .png, …")
    parser.add_argument("--address", help='the cluster, such as "auto" or "ray://host:10001"')
    parser.add_argument("--shards", type=int, metavar="N", help="parts that the passes are split into")
    parser.add_argument("--threads", type=int, metavar="N", help="threads of each worker")
    parser.add_argument("--time", type=float, metavar="SECONDS", help="end after this time")
    parser.add_argument("--noise", type=float, metavar="ERROR", help="end at this relative error")
    parser.add_argument("--checkpoint", metavar="FILE.film", help="save the film here, and continue from it")
    parser.add_argument("--spp", type=int, metavar="N", help="samples per pixel")
    parser.add_argument("--resolution", type=_resolution, metavar="WxH", help="size of the picture")
    parser.add_argument("--integrator", metavar="NAME", help="the algorithm")
    parser.add_argument("--seed", type=int, metavar="N", help="seed of all random numbers")
    parser.add_argument("--aov", metavar="LAYER,LAYER,…", help="layers beside the colours")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="another setting")
    parser.add_argument("--view", default="standard", help="how pictures for displays show the light")
    return parser.parse_args()


def _main() -> int:
    options = _arguments()
    arguments = {
        name: getattr(options, name)
        for name in ("spp", "resolution", "integrator", "seed")
        if getattr(options, name) is not None
    }
    if options.aov:
        arguments["layers"] = options.aov.split(",")
    if options.set:
        arguments["settings"] = dict(each.split("=", 1) for each in options.set)

    def show(progress: Progress) -> None:
        shards = f"{progress.shards}" if progress.total is None else f"{progress.shards}/{progress.total}"
        print(f"{shards} shards, {progress.passes} passes, {progress.seconds:.1f} s")

    def write(image: Image) -> None:
        image.write(options.output, view=options.view)

    def format(message: Warning | str, category: type[Warning], *_: Any, **__: Any) -> str:
        return f"{message}\n" if category is SceneWarning else f"warning: {message}\n"

    warnings.formatwarning = format
    try:
        image = render(
            options.scene,
            address=options.address,
            shards=options.shards,
            threads=options.threads,
            time=options.time,
            noise=options.noise,
            checkpoint=options.checkpoint,
            progress=show,
            preview=write,
            **arguments,
        )
        write(image)
    except (SceneError, ValueError, OSError, ConnectionError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    # Tasks of an imported module keep compiled scenes; those of `__main__` would not.
    from alhazen.cluster import _main as main

    sys.exit(main())
