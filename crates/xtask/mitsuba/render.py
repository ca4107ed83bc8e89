"""Renders the same scenes with alhazen and Mitsuba 3 in turn, and prints tables of CPU time and error.

`cargo xtask bench render` runs this in an environment that has Mitsuba. Times are user CPU seconds of
rendering alone: the difference of two sample counts, so that loading, compilation and output cancel.
relMSE is that of `alhazen image diff`, against a longer render by the same program with another seed;
the means of these long renders show whether both render the same scene.
"""

import argparse
import os
import platform
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from scene import comparable, parse, read_pfm, to_mitsuba, to_pbrt

BITTERLI = ["coffee", "staircase2", "veach-ajar", "material-testball"]
PIXELS = 256 * 256
PASS = 64  # Mitsuba holds all samples of a pass in memory


def user_seconds():
    return resource.getrusage(resource.RUSAGE_SELF).ru_utime


class Alhazen:
    """The program, with a sampler."""

    def __init__(self, program, sampler, scene, size, threads):
        self.name = f"alhazen, {sampler}"
        self.jit, self.threads = None, threads
        self.command = [program, "render", scene, "--resolution", f"{size[0]}x{size[1]}", "--quiet",
                        "--set", "filter=box", "--set", f"sampler={sampler}"]

    def reference(self, spp):
        return self.render(spp, 999, os.cpu_count())[0]

    def render(self, spp, seed, threads=None):
        """The picture, and user CPU seconds."""
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "out.pfm")
            own = ["--spp", str(spp), "--seed", str(seed), "--threads", str(threads or self.threads), "-o", file]
            child = subprocess.Popen(self.command + own)
            _, status, usage = os.wait4(child.pid, 0)
            if status:
                sys.exit(f"error: alhazen failed: {child.args}")
            return read_pfm(file), usage.ru_utime


class Mitsuba:
    """A variant, with the scene loaded and its kernels compiled."""

    def __init__(self, mi, variant, statements, size, counts, folder):
        self.mi, self.variant, self.name = mi, variant, f"Mitsuba, {variant}"
        mi.set_variant(variant)
        description = to_mitsuba(statements, mi, *size, PASS, folder)
        self.scene = mi.load_dict(description, parallel=False)
        cold = [self.render(spp, 1000)[1] for spp in counts]
        warm = [self.render(spp, 1001)[1] for spp in counts]
        self.jit = sum(cold) - sum(warm) if variant.startswith("llvm") else None

    def reference(self, spp):
        return self.render(spp, 999)[0]

    def render(self, spp, seed):
        """The picture, and user CPU seconds."""
        self.mi.set_variant(self.variant)
        start, total = user_seconds(), 0
        passes = -(-spp // PASS)
        for part in range(passes):
            count = min(PASS, spp)
            total = total + np.array(self.mi.render(self.scene, spp=count, seed=seed * 1000 + part), np.float64)
        return total / passes, user_seconds() - start


class Result:
    """What was measured of one contender in one scene."""

    def __init__(self, contender, reference, samples):
        self.contender, self.reference, self.samples = contender, reference, samples
        self.seconds, self.errors = [], []

    def add(self, counts, seed):
        low, high = (self.contender.render(spp, seed + spp) for spp in counts)
        self.seconds.append((high[1] - low[1]) * counts[1] / (counts[1] - counts[0]))
        square = (high[0] - self.reference) ** 2
        self.errors.append((square / (self.reference**2 + 0.01)).mean())

    def cpu(self):
        return statistics.median(self.seconds)

    def error(self):
        return statistics.median(self.errors)

    def cost(self):
        return self.cpu() * self.error()


def measure(mi, name, path, options, folder):
    """The results of all contenders in the scene at `path`."""
    statements = comparable(parse(path))
    for s in statements:  # Mitsuba's reader of EXR waits for ever where it has one thread
        if s.name == "LightSource":
            sky = os.path.join(folder, f"{name}.pfm")
            subprocess.run([options.alhazen, "image", "convert", s.get("filename"), sky], check=True)
            s.parameters["filename"] = ("string", [sky])
    film = next(s for s in statements if s.name == "Film")
    aspect = film.get("xresolution") / film.get("yresolution")
    size = round((PIXELS * aspect) ** 0.5), round((PIXELS / aspect) ** 0.5)
    scene = os.path.join(folder, f"{name}.pbrt")
    Path(scene).write_text(to_pbrt(statements))
    counts = [options.spp // 4, options.spp]
    contenders = [Alhazen(options.alhazen, s, scene, size, options.threads) for s in ("independent", "zsobol")]
    contenders += [Mitsuba(mi, v, statements, size, counts, folder) for v in options.variants]
    references = [c.reference(options.reference) for c in contenders[1:]]
    samples = size[0] * size[1] * options.spp
    results = [Result(c, r, samples) for c, r in zip(contenders, references[:1] + references)]
    for seed in range(options.repeats):
        for result in results:
            result.add(counts, 100 * seed)
    return results


def report(name, results):
    """The tables of a scene."""
    print(f"## {name}\n")
    print("| renderer | CPU s | M samples / CPU s | relMSE | relMSE · CPU s | JIT s | mean ÷ alhazen |")
    print("|---|---|---|---|---|---|---|")
    for r in results:
        jit = "" if r.contender.jit is None else f"{r.contender.jit:.2f}"
        mean = r.reference.mean() / results[0].reference.mean()
        values = f"{r.cpu():.2f} | {r.samples / r.cpu() / 1e6:.3f} | {r.error():.2e} | {r.cost():.2e}"
        print(f"| {r.contender.name} | {values} | {jit} | {mean:.3f} |")
    print("\n| alhazen ÷ Mitsuba | speed, independent | relMSE · CPU s | speed, zsobol | relMSE · CPU s |")
    print("|---|---|---|---|---|")
    for peer in results[2:]:
        ratios = [f"{peer.cpu() / ours.cpu():.2f} | {ours.cost() / peer.cost():.2f}" for ours in results[:2]]
        print(f"| {peer.contender.variant} | {' | '.join(ratios)} |")
    print(flush=True)


def processor():
    """The processor's name, and its widest vectors."""
    lines = Path("/proc/cpuinfo").read_text().splitlines() if os.path.exists("/proc/cpuinfo") else []
    fields = dict(line.split("\t", 1) for line in lines if "\t" in line)
    name = fields.get("model name", platform.processor()).lstrip("\t: ")
    flags = "".join(fields.get("flags", ""))
    return name + next((f" with {w}" for w in ("avx512_fp16", "avx512f", "avx2") if w in flags), "")


def main():
    parser = argparse.ArgumentParser(prog="cargo xtask bench render", description=__doc__)
    parser.add_argument("scenes", nargs="*", help=f"cornell-box {' '.join(BITTERLI)}; by default all there are")
    parser.add_argument("--spp", type=int, default=64, help="samples per pixel (64)")
    parser.add_argument("--reference", type=int, default=1024, help="samples per pixel of references (1024)")
    parser.add_argument("--repeats", type=int, default=3, help="rounds, whose median is reported (3)")
    parser.add_argument("--threads", type=int, default=1, help="threads of each renderer (1)")
    parser.add_argument("--alhazen", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--root", required=True, help=argparse.SUPPRESS)
    options = parser.parse_args()

    scenes = {"cornell-box": Path(options.root) / "scenes" / "cornell-box.pbrt"}
    data = os.environ.get("ALHAZEN_DATA")
    if data:
        scenes |= {name: Path(data) / "pbrt-bitterli" / name / "scene-v4.pbrt" for name in BITTERLI}
    else:
        print(f"ALHAZEN_DATA is not set: {', '.join(BITTERLI)} are left out", file=sys.stderr)
    unknown = [name for name in options.scenes if name not in scenes]
    if unknown:
        sys.exit(f"error: no scene {', '.join(unknown)}; there are {', '.join(scenes)}")

    with tempfile.TemporaryDirectory() as folder:
        os.environ["HOME"] = folder  # Dr.Jit keeps compiled kernels there: each run compiles its own
        import drjit
        import mitsuba as mi

        options.variants = ["llvm_ad_spectral", "llvm_ad_rgb"]
        try:
            mi.set_variant("llvm_ad_spectral")
        except ImportError as error:
            print(f"no LLVM library, so that Mitsuba's scalar variants are measured: {error}", file=sys.stderr)
            options.variants = ["scalar_spectral", "scalar_rgb"]
        drjit.set_thread_count(options.threads)
        print(f"Mitsuba {mi.__version__}, {processor()}, {options.threads} thread(s), {options.spp} spp\n")
        for name in options.scenes or scenes:
            report(name, measure(mi, name, scenes[name], options, folder))


main()
