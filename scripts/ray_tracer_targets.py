"""Rays a second of the reference beside Embree's path tracer tutorial and POV-Ray, on scene A (docs/performance.md, section Reference).

No target is set for them, as their pictures are others: the tutorial counts the sky twice on matte surfaces and clips its picture, POV-Ray's
matte surfaces take the sky's light unshadowed. All rays are counted, shadow rays included. Seconds are slopes between two numbers of samples, so
that start-up, reading and building drop out.
"""
import pathlib
import re
import shutil
import statistics
import subprocess
import tempfile

from measure import Skip, Used, run_benchmarks
from peer_scenes import PeerScene

WIDTH, HEIGHT = 640, 360
PIXELS = WIDTH * HEIGHT
ROUNDS = 3


def slope(cpu_s, few, many):
    """Processor seconds of one sample of each pixel."""
    return (cpu_s(many) - cpu_s(few)) / (many - few)


class Embree:
    name, few, many = "Embree's path tracer", 4, 20

    def __init__(self, scene, folder):
        if not shutil.which("pathtracer"):
            raise Skip("Embree's tutorials are not installed (Debian: apt-get install embree-tools)")
        scene.write_embree(folder / "scene.xml")
        self.command = ["pathtracer", "-i", folder / "scene.xml", "--size", WIDTH, HEIGHT, "--vp", *scene.eye, "--vi", *scene.target,
                        "--vu", 0, 1, 0, "--fov", scene.fov, "--max-path-length", 9]
        self.picture = folder / "embree.ppm"

    def command_of(self, *more):
        return [str(word) for word in (*self.command, *more)]

    def cpu_s(self, spp):
        return Used(self.command_of("--spp", spp, "-o", self.picture)).cpu_s

    def rays_a_sample(self):
        """Of a benchmark's rays and frames a second, on whatever load."""
        output = subprocess.run(self.command_of("--spp", 4, "--benchmark", 1, 3), check=True, capture_output=True, text=True).stdout
        mrays, frames = (float(re.search(rf"{name}\s+([\d.]+)", output)[1]) for name in ("MRAYPS_AVG", "RENDER_AVG"))
        return 1e6 * mrays / frames / (4 * PIXELS)


class PovRay:
    name, few, many = "POV-Ray", 1, 16

    def __init__(self, scene, folder):
        if not shutil.which("povray"):
            raise Skip("POV-Ray is not installed (Debian: apt-get install povray)")
        scene.write_povray(folder / "scene.pov", WIDTH, HEIGHT)
        self.folder = folder

    def command(self, spp):
        """Samples are pixels of a larger picture: POV-Ray's own skips some."""
        scale = round(spp ** 0.5)
        return ["povray", f"+I{self.folder}/scene.pov", f"+O{self.folder}/povray.ppm", f"+W{scale * WIDTH}", f"+H{scale * HEIGHT}",
                "+FP16", "File_Gamma=1.0", "-D", "-A", "-V"]

    def cpu_s(self, spp):
        return Used(self.command(spp)).cpu_s

    def rays_a_sample(self):
        return rays_of_povray(subprocess.run(self.command(1), check=True, capture_output=True, text=True).stderr) / PIXELS


def rays_of_povray(statistics_text):
    """Rays and shadow rays that a picture took."""
    counts = (re.search(rf"{name}:?\s+(\d+)", statistics_text) for name in ("Rays", "Shadow Ray Tests"))
    return sum(int(count[1]) for count in counts if count)


def check(targets, folder):
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        command = [folder / "probebench", "scenes", "export", "builtin:mirrors-ring", "-o", scratch / "A.glb"]
        subprocess.run(command, check=True, capture_output=True)
        scene = PeerScene(scratch / "A.glb")
        (own,) = run_benchmarks(folder / "probebench_bench", "^intersect/S:4/spp:4/").values()
        targets.tell("A, the reference, Mrays a CPU second", own["Mrays_per_s"])
        for kind in (Embree, PovRay):
            try:
                peer = kind(scene, scratch)
            except Skip as reason:
                print(f"A, {kind.name}: skipped, {reason}")
                continue
            seconds = statistics.median(slope(peer.cpu_s, kind.few, kind.many) for _ in range(ROUNDS))
            targets.tell(f"A, {kind.name}, Mrays a CPU second", 1e-6 * PIXELS * peer.rays_a_sample() / seconds)
