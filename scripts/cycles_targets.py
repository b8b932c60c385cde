"""Processor time to a given error: the reference beside Blender's Cycles (docs/performance.md, section Reference).

Both render the same files, global illumination and diffuse depth 0, at a few numbers of samples; start-up is measured
and left out. The truth is the reference's own picture of twice the size and other random numbers, averaged: two of them,
so that their noise drops out of the error, mean((x - a) (x - b) / (m^2 + 0.01)) for truths a and b with mean m. Cycles, whose
pictures converge to something else by 1e-4, is measured by its noise alone: half the squared difference of two pictures with
other random numbers, over the same. The time to an error is interpolated, or extrapolated from the last two points, along
straight lines in log-log.
"""
import math
import pathlib
import shutil
import struct
import subprocess
import tempfile
import zlib

from measure import SCRIPTS, Skip, Used

SCENES = {"A": "builtin:mirrors-ring", "B": "builtin:glass"}
WIDTH, HEIGHT = 640, 360
CYCLES_SPP = (16, 64, 256)
REFERENCE_SAMPLES = ((16, 2), (16, 4), (64, 2), (64, 4), (64, 8))  # primary points and samples of each
ERRORS = (1e-3, 1e-4)


def read_exr(path):
    """Red, green, blue of a scanline OpenEXR file without compression or with zip: rows x columns x 3."""
    import numpy

    data = path.read_bytes()
    at, header = 8, {}
    while data[at]:
        name, kind, rest = data[at:].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        (size,) = struct.unpack_from("<I", data, at)
        header[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    channels, rest = [], header[b"channels"]
    while rest[0]:
        name, rest = rest.split(b"\0", 1)
        channels.append((name.decode(), "<f2" if struct.unpack_from("<I", rest)[0] == 1 else "<f4"))
        rest = rest[16:]
    x0, y0, x1, y1 = struct.unpack("<4i", header[b"dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    lines = {0: 1, 2: 1, 3: 16}[header[b"compression"][0]]
    planes = {name: numpy.zeros((height, width)) for name, _ in channels}
    for offset in struct.unpack_from(f"<{-(-height // lines)}Q", data, at + 1):
        y, size = struct.unpack_from("<iI", data, offset)
        block = data[offset + 8:offset + 8 + size]
        rows = min(lines, y1 + 1 - y)
        if size < rows * width * sum(numpy.dtype(kind).itemsize for _, kind in channels):
            steps = numpy.frombuffer(zlib.decompress(block), numpy.uint8).astype(numpy.int64)
            steps[1:] -= 128
            halves = (numpy.cumsum(steps) & 255).astype(numpy.uint8)
            mixed = numpy.empty_like(halves)
            mixed[0::2], mixed[1::2] = numpy.split(halves, [(len(halves) + 1) // 2])
            block = mixed.tobytes()
        place = 0
        for row in range(y - y0, y - y0 + rows):
            for name, kind in channels:
                planes[name][row] = numpy.frombuffer(block, kind, width, place)
                place += width * numpy.dtype(kind).itemsize
    return numpy.stack([planes[c] for c in "RGB"], 2)


def error(picture, truths):
    a, b = truths
    mean = (a + b) / 2
    return float(((picture - a) * (picture - b) / (mean * mean + 0.01)).mean())


def noise(picture, other, truths):
    """The error of either picture against what both converge to."""
    mean = (truths[0] + truths[1]) / 2
    return float(((picture - other) ** 2 / (2 * (mean * mean + 0.01))).mean())


def seconds_to(target, points):
    """points: (error, seconds) with falling errors."""
    points = sorted(points, reverse=True)
    pairs = list(zip(points, points[1:]))
    (e0, t0), (e1, t1) = next((p for p in pairs if p[1][0] <= target), pairs[-1])
    return t0 * (t1 / t0) ** (math.log(target / e0) / math.log(e1 / e0))


class Race:
    """One scene with one limit on diffuse bounces."""

    def __init__(self, program, scene, diffuse_depth, folder):
        self.program, self.scene, self.depth, self.folder = program, scene, str(diffuse_depth), folder

    def reference(self, samples, spp, seed=1, scale=1, name="reference.exr", size=None):
        size = size or f"{scale * WIDTH}x{scale * HEIGHT}"
        return Used([self.program, "render", self.scene, "--with", "reference", "--diffuse", "traced", "--depth", "8",
                     "--diffuse-depth", self.depth, "--size", size, "--samples", str(samples), "--spp", str(spp),
                     "--seed", str(seed), "-o", self.folder / name]).cpu_s

    def cycles(self, spp, seed=1, size=None):
        size = size or f"{WIDTH}x{HEIGHT}"
        return Used(["blender", "-b", "--factory-startup", "--python-exit-code", "3", "--python", SCRIPTS / "cycles.py",
                     "--", self.scene, "-o", self.folder / "cycles.exr", "--size", size, "--spp", str(spp), "--seed", str(seed),
                     "--bounces", "8", "--diffuse-depth", self.depth]).cpu_s

    def truth(self, seed):
        self.reference(64, 2, seed, scale=2)
        return read_exr(self.folder / "reference.exr").reshape(HEIGHT, 2, WIDTH, 2, 3).mean((1, 3))

    def noise_of_cycles(self, spp, truths):
        """With the seconds of a picture."""
        pictures, seconds = [], 0
        for seed in (1, 2):
            seconds += self.cycles(spp, seed) / 2
            pictures.append(read_exr(self.folder / "cycles.exr"))
        return noise(*pictures, truths), seconds

    def run(self):
        """(error, seconds) of Cycles and of the reference, rendered in turn."""
        truths = self.truth(7777), self.truth(7778)
        start = self.cycles(1, size="16x16"), self.reference(1, 2, size="16x16")
        points = [], []
        for i in range(max(len(CYCLES_SPP), len(REFERENCE_SAMPLES))):
            if i < len(CYCLES_SPP):
                cycles_noise, seconds = self.noise_of_cycles(CYCLES_SPP[i], truths)
                points[0].append((cycles_noise, seconds - start[0]))
            if i < len(REFERENCE_SAMPLES):
                seconds = self.reference(*REFERENCE_SAMPLES[i]) - start[1]
                points[1].append((error(read_exr(self.folder / "reference.exr"), truths), seconds))
        return points


def require_peer():
    if not shutil.which("blender"):
        raise Skip("Blender is not installed (Debian: apt-get install --no-install-recommends blender python3-numpy)")
    try:
        import numpy  # noqa: F401
    except ImportError:
        raise Skip("numpy is not installed (Debian: apt-get install python3-numpy)") from None


def check(targets, program):
    """Prints how many times less processor time than Cycles the reference needs, at least 3 being the target."""
    require_peer()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name, builtin in SCENES.items():
            scene = folder / f"{name}.glb"
            subprocess.run([program, "scenes", "export", builtin, "-o", scene], check=True, capture_output=True)
            for light, depth in (("global illumination", 8), ("diffuse depth 0", 0)):
                points = Race(program, scene, depth, folder).run()
                for target in ERRORS:
                    theirs, ours = (seconds_to(target, p) for p in points)
                    what = f"{name}, {light}, to relMSE {target:.0e}, CPU {theirs:.1f} / {ours:.1f} s, times less"
                    targets.show(what, theirs / ours, 3, at_most=False)
