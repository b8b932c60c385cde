"""Writes mikktspace.json: a mesh and its tangents as Blender computes them, by Mikkelsen's own code.

usage: blender -b --python make.py      (made with Blender 3.4.1)

A wavy grid of 72 triangles. By columns: mirrored texture coordinates, plain ones, a chart of its own, and a strip whose
texture coordinates span no area; the normals of the upper rows are unlike those of the lower ones, a hard edge.
Corners are [position, normal, uv, tangent]; the tangent is null where no triangle with area in texture space is near:
there any vector will do. v points up, as in Blender; glTF's is 1 - v.
"""
import json
import math
import pathlib

import bpy

SIZE = 6


def height(x, y):
    return 0.35 * math.sin(1.3 * x + 0.4) * math.cos(0.9 * y)


def position(x, y):
    return (round(x + 0.2 * math.sin(7 * x + 3 * y), 3), round(y + 0.15 * math.cos(5 * x - 2 * y), 3),
            round(height(x, y), 3))


def normal(x, y, hard):
    e = 1e-3
    slope_x = (height(x + e, y) - height(x - e, y)) / (2 * e)
    slope_y = (height(x, y + e) - height(x, y - e)) / (2 * e)
    n = (-slope_x, -slope_y + (0.5 if hard else 0), 1)
    length = math.sqrt(sum(c * c for c in n))
    return tuple(c / length for c in n)


def texture_coordinates(x, y, column):
    if column < 2:
        u, v = -0.2 * x, 0.2 * y
    elif column < 4:
        u, v = 0.2 * x + 0.03 * y * y, 0.2 * y
    else:
        u, v = 0.5 + 0.1 * y, 0.3 * min(x, 5)
    return round(u, 4), round(v, 4)


triangles = []
for row in range(SIZE):
    for column in range(SIZE):
        quad = [(position(x, y), normal(x, y, row >= 4), texture_coordinates(x, y, column), x == SIZE)
                for x, y in ((column, row), (column + 1, row), (column + 1, row + 1), (column, row + 1))]
        a, b, c, d = quad
        triangles += [(a, b, c), (a, c, d)] if (row + column) % 2 else [(a, b, d), (b, c, d)]

corners = [corner for triangle in triangles for corner in triangle]
vertices = list(dict.fromkeys(p for p, _, _, _ in corners))
mesh = bpy.data.meshes.new("grid")
mesh.from_pydata(vertices, [], [[vertices.index(c[0]) for c in t] for t in triangles])
uvs = mesh.uv_layers.new(name="uv")
for corner, target in zip(corners, uvs.data):
    target.uv = corner[2]
mesh.use_auto_smooth = True
for polygon in mesh.polygons:
    polygon.use_smooth = True
mesh.normals_split_custom_set([c[1] for c in corners])
mesh.calc_tangents(uvmap="uv")


def numbers(values):
    return [round(v, 7) for v in values]


rows = []
for (p, _, uv, free), loop in zip(corners, mesh.loops):
    tangent = None if free else numbers([*loop.tangent, loop.bitangent_sign])
    rows.append(json.dumps([p, numbers(loop.normal), uv, tangent]))
text = '{"corners": [\n' + ",\n".join(rows) + "\n]}\n"
(pathlib.Path(__file__).parent / "mikktspace.json").write_text(text)
