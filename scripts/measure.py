"""What the parts of scripts/perf share: targets, programs that are measured, averages."""
import json
import math
import os
import pathlib
import statistics
import subprocess
import time

SCRIPTS = pathlib.Path(__file__).parent


class Skip(Exception):
    """Something that a part needs is not installed: its text says what, in one line."""


class Targets:
    """Prints each target with its figure and whether it is met."""

    def __init__(self):
        self.missed = 0

    def show(self, what, figure, limit, unit="", at_most=True):
        met = figure <= limit if at_most else figure >= limit
        self.missed += not met
        sign = "<=" if at_most else ">="
        print(f"{what:<66} {figure:8.3f} {sign} {limit:g}{unit}  {'met' if met else 'MISSED'}", flush=True)

    def tell(self, what, figure):
        """A figure that no target is set for."""
        print(f"{what:<66} {figure:8.3f}", flush=True)


def run_benchmarks(program, pattern):
    """Benchmarks by name, each with its counters."""
    command = [program, f"--benchmark_filter={pattern}", "--benchmark_format=json"]
    output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return {b["name"].split("/iterations")[0]: b for b in json.loads(output)["benchmarks"]}


class Used:
    """Wall and processor seconds and MiB that a command took, with what it started."""

    def __init__(self, command):
        start = time.perf_counter()
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        self.wall_s = time.perf_counter() - start
        self.cpu_s = usage.ru_utime + usage.ru_stime
        self.peak_mib = usage.ru_maxrss / 1024
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            raise subprocess.CalledProcessError(process.returncode, command)


def ratio_of_rounds(theirs, ours):
    """Median of the rounds' own ratios, so that what disturbs a round disturbs both of its sides."""
    return statistics.median(a / b for a, b in zip(theirs, ours, strict=True))


def geometric_mean(values):
    return math.exp(statistics.fmean(map(math.log, values)))
