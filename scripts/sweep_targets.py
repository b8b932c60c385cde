"""What runs of suites may take (docs/performance.md, section Sweeps)."""
import pathlib
import subprocess
import tempfile

from measure import SCRIPTS, Used

# Exponent that a cost may have over what it grows with, by the beginning of its row in scripts/growth's table: linear, but for what is by
# its nature more: each mirror sees all others, texels grow with the square of a map's edge, and hierarchies are sorted (n log n is 1.08 from
# 10 thousand to 10 million). A twentieth, or as much again for what was seen to differ from run to run, is left for noise.
LARGEST_EXPONENTS = {
    "frame over mirrors": 2.05, "frame over iterations": 1.05, "frame over texels": 2.05, "plain frame over triangles": 1.05,
    "Embree's hierarchy": 1.18, "reference over triangles": 1.05, "reference over samples": 1.05, "reference over depth": 1.05,
}


def check_resume(targets, program):
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "run", "quick", "--no-cost", "--out", f"{folder}/run", "--store", f"{folder}/store"]
        targets.tell("`run quick --no-cost` with an empty store, CPU s", Used(command).cpu_s)
        targets.show("`run quick --resume` of the finished run, s", Used([*command, "--resume"]).wall_s, 2)


def check_survey(targets, program):
    with tempfile.TemporaryDirectory() as folder:
        used = Used([program, "run", "survey", "--no-cost", "--out", folder + "/run", "--store", folder + "/store"])
        targets.show("`run survey --no-cost`, most memory, GiB", used.peak_mib / 1024, 2)


def exponents(table):
    """Title, exponent and that of the last step, where constant parts count least, of each row of scripts/growth's table."""
    rows = [[field.strip() for field in line.split("|")[1:-1]] for line in table.splitlines() if line.startswith("|")]
    return [(row[0], float(row[3]), float(row[4])) for row in rows[2:]]


def check_growth(targets, folder):
    with tempfile.TemporaryDirectory() as plots:
        command = [SCRIPTS / "growth", "--program", folder, "--plot", pathlib.Path(plots) / "growth.svg"]
        table = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    for title, exponent, last in exponents(table):
        (limit,) = [l for beginning, l in LARGEST_EXPONENTS.items() if title.startswith(beginning)]
        targets.show(f"{title}, exponent", exponent, limit)
        targets.show("  of the last step", last, limit)
