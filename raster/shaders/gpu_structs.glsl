// What the shaders and the C++ side agree on, compiled as both (raster/gpu_structs.h): contents of buffers, made of vec4
// and mat4 only so that std140, std430 and C++ lay them out alike, and numbers of binding points.

struct PassConstants {
  View view;
  vec4 image;   // x width and y height in samples, z largest radiance that the colour format holds
  vec4 lights;  // x number of area lights
  vec4 clip;    // of mirrored views and captures with a far plane: only points with dot(xyz, p) + w >= 0 are drawn; else 0
};

struct SceneConstants {
  Sky sky;
  Ambient ambient;
};

struct InstanceConstants {
  mat4 worldFromObject;
  mat4 normalMatrix;  // the upper 3x3
  vec4 values;        // x multiplies the mesh's UV per metre, z id (exact up to 2^24), w -1 if the
                      // transform mirrors, else 1
  vec4 volume;        // x metres in a unit of object space (mean of the directions)
};

// What a probe shows, for lookups that know where it is.
struct ProbeConstants {
  vec4 position;  // w near plane of its faces, metres
  vec4 boxLower;  // the box that stands for the surroundings; w radius of the sphere that does
  vec4 boxUpper;
  vec4 right;  // xyz, of its single view
};

// One face of a shadow map.
struct ShadowFace {
  View view;    // forward.w is not used
  vec4 values;  // x 1 if the projection is parallel: then right and down are half of the face's width and height, and y is
                // the range of depths in metres
};

// A part of a captured face in which texels of one group of lookups are looked for (collect_lookups.comp).
struct LookupScan {
  ivec4 area;      // x y first texel, z w number of columns and rows
  ivec4 lookedFor;  // x face, y alpha of the texels, z their list, w its first entry
  ivec4 work;      // x number of work groups of the scans before it
};

// Uniform blocks.
const int kPassBlock = 0;
const int kSceneBlock = 1;
const int kInstanceBlock = 2;
const int kMaterialBlock = 3;
const int kLobeBlock = 4;
const int kShadowPassBlock = 5;
const int kProbeBlock = 6;
const int kSecondProbeBlock = 7;
const int kLightBlock = 8;
// Shader storage blocks.
const int kManyLightsBlock = 0;
const int kSmoothingGroupBlock = 1;
const int kAreaLightBlock = 2;
const int kLayerBlock = 3;
const int kShadowBlock = 4;
const int kLookupListBlock = 5;
const int kLookupEntryBlock = 6;
const int kLookupScanBlock = 7;
// Image units.
const int kLayerHeadImage = 0;
const int kFilterTargetImage = 1;
const int kLookupTargetImage = 2;
const int kLookupRecordImage = 3;
// Texture units. Those of a material follow kMaterialUnit in the order of the slots in MaterialConstants.
const int kProbeUnit = 0;
const int kEnvironmentUnit = 1;
const int kEnvironmentCubeUnit = 2;
const int kDfgUnit = 3;
const int kBackFaceUnit = 4;
const int kEnvironmentLevelsUnit = 5;
const int kMaterialUnit = 6;
const int kShadowUnit = 11;
const int kProbeDepthUnit = 12;
const int kSecondProbeUnit = 13;
const int kSecondProbeDepthUnit = 14;
const int kPlanarUnit = kSecondProbeUnit;  // owners of a probe don't blend two
const int kTextureUnits = 15;
const int kFilterSourceUnit = kMaterialUnit;  // of the filters of cube maps; draws bind their materials anew
const int kLookupCaptureUnit = kMaterialUnit;  // the same of what makes lists of lookups
const int kLookupTargetUnit = kMaterialUnit + 1;  // and the ones that follow
