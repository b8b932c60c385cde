#!/usr/bin/env python3
"""An external technique that knows its pictures already: copies them to where the job wants them.

Settings: pictures (a pattern with {frame}); mode, how it misbehaves; log (a file that gets a line a job).
"""
import json
import os
import shutil
import subprocess
import sys
import time

job = json.load(open(sys.argv[1], encoding="utf-8"))
settings = job["technique"]["settings"]
mode = settings.get("mode", "work")

if "log" in settings:
    with open(settings["log"], "a", encoding="utf-8") as log:
        print(json.dumps({"job": job, "folder": os.getcwd()}), file=log)
if mode == "skip":
    sys.exit(print("a part of the engine is not installed", file=sys.stderr) or 77)
if mode == "fail":
    for i in range(10000):
        print(f"line {i} of a very long complaint", file=sys.stderr)
    sys.exit(print("the engine has no cube maps", file=sys.stderr) or 5)
if mode == "hang":
    child = subprocess.Popen(["sleep", "600"])  # has to go as well
    with open(settings["pids"], "w", encoding="utf-8") as pids:
        print(os.getpid(), child.pid, file=pids)
    os.rename(settings["pids"], settings["pids"] + ".done")
    time.sleep(600)

for frame in job["frames"]:
    picture = settings["pictures"].replace("{frame}", str(frame["frame"]))
    if frame["image"] and mode != "forget" and os.path.exists(picture):
        shutil.copy(picture, frame["image"])
if job["timing"]:
    timing = {"timing_version": 1, "program": "engine 1.0", "frame_ms": [3.0, 1.0, 2.0], "plain_ms": [0.5]}
    if mode == "bad-timing":
        timing["frame_ms"] = ["fast"]
    json.dump(timing, open(job["timing"]["file"], "w", encoding="utf-8"))
