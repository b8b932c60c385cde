"""Writes an exported scene of mirrors and matte surfaces under a constant sky as other ray tracers read it: Embree's tutorials, POV-Ray.

Wants a .glb of `probebench scenes export` whose nodes stand where they were made (no transforms), as those of mirrors-ring do.
"""
import json
import math
import struct

COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
FORMATS = {5123: "H", 5125: "I", 5126: "f"}
# Embree's path tracer clips its pictures at 1: all light is halved for it.
EMBREE_LIGHT = 0.5


class PeerScene:
    def __init__(self, path):
        data = path.read_bytes()
        (size,) = struct.unpack_from("<I", data, 12)
        self.document = json.loads(data[20:20 + size])
        self.buffer = data[28 + size:]
        scene = self.document["scenes"][0]
        self.sky = scene["extras"]["probebench"]["environment"]["sky"]["horizon"]
        (camera,) = [n for n in self.document["nodes"] if "camera" in n]
        self.fov = math.degrees(self.document["cameras"][0]["perspective"]["yfov"])
        self.eye = camera["matrix"][12:15]
        self.target = [e - z for e, z in zip(self.eye, camera["matrix"][8:11])]

    def accessor(self, index):
        """Rows of numbers."""
        accessor = self.document["accessors"][index]
        view = self.document["bufferViews"][accessor["bufferView"]]
        width = COMPONENTS[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        row = struct.Struct(f"<{width}{FORMATS[accessor['componentType']]}")
        return [row.unpack_from(self.buffer, start + i * row.size) for i in range(accessor["count"])]

    def meshes(self):
        """(positions, normals, triangles, colour, whether it is a mirror) of each."""
        for mesh in self.document["meshes"]:
            (primitive,) = mesh["primitives"]
            material = self.document["materials"][primitive["material"]]["pbrMetallicRoughness"]
            indices = [i for (i,) in self.accessor(primitive["indices"])]
            triangles = list(zip(indices[0::3], indices[1::3], indices[2::3]))
            yield (self.accessor(primitive["attributes"]["POSITION"]), self.accessor(primitive["attributes"]["NORMAL"]),
                   triangles, material["baseColorFactor"][:3], material["metallicFactor"] == 1)

    def write_embree(self, path):
        def rows(values):
            return " ".join(f"{x:.7g}" for row in values for x in row)

        with path.open("w") as file:
            sky = rows([[EMBREE_LIGHT * x for x in self.sky]])
            file.write(f'<?xml version="1.0"?>\n<scene><Group>\n<AmbientLight><L>{sky}</L></AmbientLight>\n')
            for i, (positions, normals, triangles, color, is_mirror) in enumerate(self.meshes()):
                kind = "Mirror" if is_mirror else "Matte"
                file.write(f"<TriangleMesh><positions>{rows(positions)}</positions>\n<normals>{rows(normals)}</normals>\n"
                           f"<triangles>{rows(triangles)}</triangles>\n<material id=\"{i}\"><code>\"{kind}\"</code><parameters>"
                           f"<float3 name=\"reflectance\">{rows([color])}</float3></parameters></material></TriangleMesh>\n")
            file.write("</Group></scene>\n")

    def write_povray(self, path, width, height):
        """Matte surfaces get the sky's light unshadowed: what POV-Ray does without radiosity."""
        def vector(values):
            return "<" + ",".join(f"{x:.7g}" for x in values) + ">"

        def rows(values):
            return f"{len(values)}," + ",".join(vector(row) for row in values)

        # POV-Ray's axes are left-handed, its angle is the horizontal one.
        angle = 2 * math.degrees(math.atan(math.tan(math.radians(self.fov) / 2) * width / height))
        with path.open("w") as file:
            file.write("#version 3.7;\nglobal_settings { assumed_gamma 1.0 max_trace_level 9 }\n"
                       f"background {{ color rgb {vector(self.sky)} }}\n"
                       f"camera {{ perspective location {vector(self.eye)} right <{-width / height:.7g},0,0> up <0,1,0> "
                       f"angle {angle:.7g} look_at {vector(self.target)} }}\n")
            for positions, normals, triangles, color, is_mirror in self.meshes():
                matte = f"pigment {{ rgb {vector(color)} }} finish {{ ambient rgb {vector(self.sky)} diffuse 1 }}"
                mirror = f"pigment {{ rgb 0 }} finish {{ ambient 0 diffuse 0 reflection {{ rgb {vector(color)} }} }}"
                file.write(f"mesh2 {{ vertex_vectors {{ {rows(positions)} }}\nnormal_vectors {{ {rows(normals)} }}\n"
                           f"face_indices {{ {rows(triangles)} }}\ntexture {{ {mirror if is_mirror else matte} }} }}\n")
