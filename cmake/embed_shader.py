"""Expands the #include lines of a shader (each file once) and writes the text, a C++ header that holds it, and a depfile.

usage: embed_shader.py ROOT SHADER EXPANDED HEADER    (SHADER and includes relative to ROOT)
"""
import pathlib
import re
import sys


def expand(root, path, seen):
    seen.append(path)
    lines = []
    for line in (root / path).read_text().splitlines():
        include = re.match(r'\s*#include "(.+)"', line)
        if not include:
            lines.append(line)
        elif include[1] not in seen:
            lines += expand(root, include[1], seen)
    return lines


def main():
    root, shader, expanded, header = sys.argv[1:]
    seen = []
    text = "\n".join(expand(pathlib.Path(root), shader, seen)) + "\n"
    pathlib.Path(expanded).parent.mkdir(parents=True, exist_ok=True)
    pathlib.Path(expanded).write_text(text)
    stem, stage = pathlib.Path(shader).name.rsplit(".", 1)
    name = "k" + "".join(part.capitalize() for part in (stem + "_" + stage).split("_"))
    # String literals are limited to 64 KiB by the standard; adjacent raw literals are joined by the compiler.
    chunks = "\n".join(f'R"glsl({text[i:i + 16000]})glsl"' for i in range(0, len(text), 16000))
    pathlib.Path(header).write_text(
        f"#pragma once\nnamespace pb::shaders {{\ninline constexpr char {name}[] =\n{chunks};\n}}  // namespace pb::shaders\n")
    dependencies = " ".join(str(pathlib.Path(root) / path) for path in seen)
    pathlib.Path(header + ".d").write_text(f"{header}: {dependencies}\n")


main()
