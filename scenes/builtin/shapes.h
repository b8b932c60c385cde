// Meshes made by code, and short cuts to put them into a Scene. Metres, object space.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace pb {

// Latitude-longitude sphere of `segments` x `rings` quads with exact normals and texture coordinates (u along the
// equator from -X over +Z, v up): the tessellation of three.js' SphereGeometry, one triangle a quad at the poles.
Mesh makeSphereMesh(float radius, int segments, int rings);

// Axis-aligned box around the origin; 24 vertices, each face with texture coordinates over [0,1]^2.
Mesh makeBoxMesh(glm::vec3 edges);

// Quad p, p+u, p+u+v, p+v, counter-clockwise seen from the side to which cross(u, v) points; texture coordinates follow
// u and v.
Mesh makeQuadMesh(glm::vec3 p, glm::vec3 u, glm::vec3 v);

// Torus around +Y.
Mesh makeTorusMesh(float majorRadius, float minorRadius, int segments, int sides);

// A bicubic Bezier patch: control points in four rows of four, tessellated into segments x segments quads.
using BezierPatch = std::array<glm::vec3, 16>;
void appendPatch(Mesh& mesh, const BezierPatch& patch, int segments);

// Adds a node with one instance and returns the node's index.
int addInstance(Scene& scene, std::string name, std::shared_ptr<const Mesh> mesh, int material, Node node = {});

int addMaterial(Scene& scene, Material material);
int addTexture(Scene& scene, Texture texture);

// Diffuse, its base colour that of a texture of the scene, `repeats` times along u and v, times `albedo`.
Material makeTexturedMaterial(std::string name, int texture, glm::vec2 repeats, glm::vec3 albedo = glm::vec3(1.0f));

// The nearest colour (and alpha) of 8 bits, sRGB-encoded: what an exported file holds without loss.
glm::vec4 roundedToBytes(const glm::vec4& color);

// A camera at `eye` that looks at `target`, +Y up.
void addCamera(Scene& scene, std::string name, glm::vec3 eye, glm::vec3 target, float verticalFovRadians, float zNear);

// Shines from far away; `toLight` need not be normalised. Irradiance in W/m^2.
void addDirectionalLight(Scene& scene, std::string name, glm::vec3 toLight, glm::vec3 irradiance);

}  // namespace pb
