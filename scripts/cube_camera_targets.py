"""Frames of mirrors that see each other, beside a browser's cube cameras (docs/performance.md, section Frames).

three.js in headless Chromium on llvmpipe (bench/external/three-cubecamera) draws the same scene of N mirrors in B iterations with cube maps of
R texels to the same 1280x720 pixels. Cell by cell both programs are run in turn.
"""
import contextlib
import json
import pathlib
import statistics
import subprocess
import tempfile

from measure import SCRIPTS, Skip, geometric_mean, ratio_of_rounds, run_benchmarks

GRID = [f"{n}:{b}:{r}" for n in (1, 3, 5, 8) for b in (1, 2, 3) for r in (64, 128, 256, 512)]
FASTER_EACH, FASTER_IN_THE_MEAN = 2, 4
SKIPPED = 77  # exit code
FRAMES, MS = 3, 600  # of a cell in a round, at least


class Peer:
    """The browser, which stays open."""

    def __init__(self, program, folder):
        self.program, self.folder = program, pathlib.Path(folder)
        command = [SCRIPTS.parent / "bench/external/three-cubecamera/frames", str(FRAMES), str(MS)]
        self.complaints = (self.folder / "complaints.txt").open("w+")  # a pipe would fill up
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=self.complaints, text=True)

    def scene(self, mirrors):
        file = self.folder / f"mirrors{mirrors}.glb"
        if not file.exists():
            command = [self.program, "scenes", "export", f"builtin:mirrors?count={mirrors}", "-o", file]
            subprocess.run(command, check=True, capture_output=True)
        return file

    def frame_ms(self, cell):
        """Wall and processor time of a frame."""
        n, b, r = cell.split(":")
        scene = self.scene(n)
        try:
            self.process.stdin.write(f"{scene} {b} {r}\n")
            self.process.stdin.flush()
            answer = self.process.stdout.readline()
        except BrokenPipeError:
            answer = ""
        if not answer:
            exit_code = self.process.wait()
            self.complaints.seek(0)
            reason = self.complaints.read().strip().splitlines() or ["it ended without a word"]
            if exit_code == SKIPPED:
                raise Skip(reason[-1])
            raise RuntimeError(f"three.js: {reason[-1]}")
        result = json.loads(answer)
        return result["ms"], result["cpu_ms"]

    def close(self):
        with contextlib.suppress(BrokenPipeError):
            self.process.stdin.close()
        self.process.wait()
        self.complaints.close()


def our_frame_ms(folder, cell):
    n, b, r = cell.split(":")
    (result,) = run_benchmarks(folder / "probebench_bench", f"^frame/N:{n}/B:{b}/R:{r}/").values()
    return result["ms"], result["cpu_ms"]


def show(targets, rounds):
    """rounds: by cell, of pairs ((wall, CPU) of the peer, the same of ours)."""
    for side, kind in enumerate(("wall", "CPU")):
        ratios = []
        for cell, pairs in rounds.items():
            theirs, ours = [p[0][side] for p in pairs], [p[1][side] for p in pairs]
            ratios.append(ratio_of_rounds(theirs, ours))
            times = f"{statistics.median(theirs):.0f} / {statistics.median(ours):.0f} ms"
            what = f"frame N:B:R {cell}, {kind} {times}, times faster"
            targets.show(what, ratios[-1], FASTER_EACH, at_most=False)
        what = f"frames, {kind}, {len(rounds)} cells, {len(pairs)} rounds, times faster, geometric mean"
        targets.show(what, geometric_mean(ratios), FASTER_IN_THE_MEAN, at_most=False)


def check(targets, folder, cells, rounds):
    measured = {cell: [] for cell in cells}
    with tempfile.TemporaryDirectory() as scenes:
        peer = Peer(folder / "probebench", scenes)
        try:
            for _ in range(rounds):
                for cell in cells:
                    measured[cell].append((peer.frame_ms(cell), our_frame_ms(folder, cell)))
        finally:
            peer.close()
    show(targets, measured)
