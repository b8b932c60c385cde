// Calls of the shading model for the agreement test: compiled as GLSL in shading_agreement.comp and as C++ in shading_agreement_test.cpp.
// Inputs a and b are four numbers each in [0,1); `image` is a mipmapped 8 x 8 texture and `faces` an 8 x 8 cube in six layers. Each
// case has a row with its tolerance in the table of shading_agreement_test.cpp.

PB_FUNC vec3 unitVector(vec4 v) { return safeNormalize(2.0f * vec3(v) - vec3(1.0f)); }

// Away from the ties of cube faces, where either neighbour is right and the two languages may choose differently.
PB_FUNC vec3 offTies(vec3 d) {
  vec3 a = abs(d);
  float margin = min(abs(a.x - a.y), min(abs(a.y - a.z), abs(a.z - a.x)));
  return margin < 1e-3f ? vec3(0.1f, 0.2f, 0.9f) : d;
}

PB_FUNC Light makeLight(float kind, vec4 a, vec4 b) {
  Light light;
  light.positionKind = vec4(4.0f * vec3(a), kind);
  light.directionRange = vec4(unitVector(b), b.w < 0.5f ? 0.0f : 6.0f);
  light.intensity = vec4(3.0f * vec3(b), 0.0f);
  light.cone = vec4(2.0f, 0.2f, 0.0f, 0.0f);
  return light;
}

PB_FUNC Sky makeSky(vec4 a, float clampTo) {
  Sky sky;
  sky.horizon = vec4(0.7f, 0.8f, 0.9f, clampTo);
  sky.zenith = vec4(0.1f, 0.3f, 0.7f, 0.0f);
  sky.below = vec4(0.3f, 0.2f, 0.1f, 0.0f);
  sky.glow = vec4(0.8f, 0.7f, 0.5f, 1.0f + 64.0f * a.w);
  sky.toGlow = vec4(0.48f, 0.6f, 0.64f, 0.0f);
  return sky;
}

PB_FUNC Ambient makeAmbient(vec4 a, vec4 b) {
  Ambient ambient;
  ambient.constant = 2.0f * a;
  ambient.y = b;
  ambient.z = a - b;
  ambient.x = 0.5f * b;
  ambient.xy = b - a;
  ambient.yz = 0.3f * a;
  ambient.zz = 0.2f * b;
  ambient.xz = 0.1f * a;
  ambient.xxyy = 0.4f * b;
  return ambient;
}

PB_FUNC Surface makeTestSurface(float kind, vec4 a, vec4 b) {
  Surface s;
  s.position = vec3(a);
  s.normal = unitVector(b);
  s.baseColor = vec3(b);
  s.opacity = 1.0f;
  s.emission = 0.1f * vec3(a);
  s.metallic = a.w;
  s.roughness = 0.1f + 0.9f * a.x;
  s.alpha = ggxAlpha(s.roughness);
  s.occlusion = b.w;
  s.transmission = a.w;
  s.ior = 1.0f + b.w;
  s.thickness = b.z;
  s.dispersion = 0.0f;
  s.specularColor = vec3(a);
  s.specularFactor = a.y;
  s.absorption = vec3(b);
  s.conductorEta = vec4(vec3(a) + vec3(0.1f), b.x < 0.5f ? 1.0f : 0.0f);
  s.conductorK = 3.0f * vec3(b);
  s.kind = kind;
  return s;
}

PB_FUNC MaterialConstants makeMaterial(vec4 a) {
  MaterialConstants m;
  m.baseColor = vec4(a.w, a.x, a.y, 1.0f);
  m.emission = vec4(2.0f * vec3(a), 1.0f);
  m.factors = vec4(a.z, 0.5f, a.x, a.y);
  m.kind = vec4(kSurfaceMirror, 1.5f, 0.0f, 0.0f);
  m.specular = vec4(1.0f);
  m.absorption = vec4(0.0f);
  m.conductorEta = vec4(0.0f);
  m.conductorK = vec4(0.0f);
  m.alpha = vec4(0.0f);
  return m;
}

PB_FUNC View makeView(vec4 a) {
  View view;
  view.origin = vec4(a.x, a.y, a.z, 0.1f);
  view.forward = vec4(0.0f, 0.6f, -0.8f, 0.01f);
  view.right = vec4(0.5f, 0.0f, 0.0f, 0.0f);
  view.down = vec4(0.0f, -0.32f, -0.24f, 0.0f);
  return view;
}

PB_FUNC vec4 clampRepeatSettings(vec4 a, float magnification, float minification) {
  return vec4(floor(3.0f * a.z), floor(3.0f * a.w), magnification, minification);
}

PB_FUNC vec4 packTaps(CubeTaps t) {
  return vec4(float(t.p00.x + 16 * t.p00.y + 256 * t.p00.z), float(t.p10.x + 16 * t.p10.y + 256 * t.p10.z),
              float(t.p01.x + 16 * t.p01.y + 256 * t.p01.z), float(t.p11.x + 16 * t.p11.y + 256 * t.p11.z));
}

PB_FUNC vec3 upperVector(vec4 v) {
  vec3 d = unitVector(v);
  return vec3(d.x, d.y, max(abs(d.z), 0.05f));
}

PB_FUNC AreaLight makeAreaLight(vec4 a, vec4 b) {
  AreaLight light;
  light.a = vec4(4.0f * vec3(a) - vec3(2.0f), b.w < 0.5f ? 1.0f : 0.0f);
  light.b = vec4(4.0f * vec3(b) - vec3(2.0f), 0.0f);
  light.c = vec4(2.0f, -1.5f, 1.0f, 0.0f);
  light.radiance = vec4(1.0f + a.w, 2.0f, 3.0f, 0.0f);
  return light;
}

const vec4 kExactLaw = vec4(kFresnelExact, 0.0f, 0.0f, 0.0f);
const vec4 kSchlickLaw = vec4(kFresnelSchlick, 0.0f, 0.0f, 0.0f);
const vec4 kRatioLaw = vec4(kFresnelRatio, 0.1f, 0.8f, 3.0f);

AGREEMENT_CASES_BEGIN
AGREEMENT_CASE(0, vec4(safeNormalize(vec3(a)), pow5(a.w)))
AGREEMENT_CASE(1, vec4(srgbEncode(a.x), srgbEncode(0.01f * a.y), srgbDecode(a.z), srgbDecode(0.1f * a.w)))
AGREEMENT_CASE(2, vec4(cubeDirection(int(6.0f * a.z), 2.0f * vec2(a.x, a.y) - vec2(1.0f)), float(cubeFaceOf(offTies(unitVector(b))))))
AGREEMENT_CASE(3, vec4(cubeFaceCoordinates(cubeFaceOf(offTies(unitVector(b))), offTies(unitVector(b))), 0.0f, 0.0f))
AGREEMENT_CASE(4, vec4(64.0f * cubeTexelSolidAngle(ivec2(8.0f * vec2(a.x, a.y)), 8)))
AGREEMENT_CASE(5, vec4(vec3(cubeWrapTexel(ivec2(10.0f * vec2(a.x, a.y)) - ivec2(1), int(6.0f * a.z), 8)), 0.0f))
AGREEMENT_CASE(6, cubeBilinearTaps(offTies(unitVector(a)), 8).weights)
AGREEMENT_CASE(7, packTaps(cubeBilinearTaps(offTies(unitVector(a)), 8)))
AGREEMENT_CASE(8, sampleCube(faces, offTies(unitVector(a))))
AGREEMENT_CASE(9, vec4(gradientSky(makeSky(a, 0.0f), unitVector(b)), 0.0f))
AGREEMENT_CASE(10, vec4(gradientSky(makeSky(a, 1.0f), unitVector(b)), 0.0f))
AGREEMENT_CASE(11, vec4(ambientRadiance(makeAmbient(a, b), unitVector(vec4(b.w, a.w, b.x, 0.0f))), 0.0f))
AGREEMENT_CASE(12, vec4(F_Schlick(vec3(a), a.w), F_Dielectric(b.x, 1.1f + b.y)))
AGREEMENT_CASE(13, vec4(F_Dielectric(b.x, 0.5f + 0.4f * b.y), F_Dielectric(0.0f, 1.5f), F_Dielectric(1.0f, 1.5f), 0.0f))
AGREEMENT_CASE(14, vec4(refractedDirection(unitVector(a), -unitVector(a + 0.2f * b), 1.0f + b.w), 0.0f))
AGREEMENT_CASE(15, vec4(reflectedDirection(unitVector(a), unitVector(b)), 0.0f))
AGREEMENT_CASE(16, vec4(lightIrradianceOn(makeLight(kLightDirectional, a, b), vec3(b.w, a.w, 0.5f), unitVector(a)), 0.0f))
AGREEMENT_CASE(17, vec4(lightIrradianceOn(makeLight(kLightPoint, a, b), vec3(4.5f, 5.0f, 4.2f), unitVector(a)), 0.0f))
AGREEMENT_CASE(18, vec4(lightIrradianceOn(makeLight(kLightSpot, a, b), vec3(4.5f, 5.0f, 4.2f), unitVector(a)), 0.0f))
AGREEMENT_CASE(19, vec4(mappedNormal(unitVector(a), vec4(unitVector(b), b.w < 0.5f ? -1.0f : 1.0f), vec4(b.y, b.z, 0.9f, 0.0f), a.w), 0.0f))
AGREEMENT_CASE(20, vec4(localRadiance(makeTestSurface(kSurfaceDiffuse, a, b), vec3(a), vec3(b), 0.1f * vec3(a)), 0.0f))
AGREEMENT_CASE(21, vec4(localRadiance(makeTestSurface(kSurfaceMirror, a, b), vec3(a), vec3(b), 0.1f * vec3(a)), 0.0f))
AGREEMENT_CASE(22, vec4(localRadiance(makeTestSurface(kSurfaceGlass, a, b), vec3(a), vec3(b), 0.1f * vec3(a)), 0.0f))
AGREEMENT_CASE(23, vec4(localRadiance(makeTestSurface(kSurfaceUnlit, a, b), vec3(a), vec3(b), 0.1f * vec3(a)), 0.0f))
AGREEMENT_CASE(24, vec4(specularWeights(makeTestSurface(kSurfaceMirror, a, b), b.w, 1.5f, vec4(kFresnelExact, 0.0f, 0.0f, 0.0f)).reflection, 0.0f))
AGREEMENT_CASE(25, vec4(specularWeights(makeTestSurface(kSurfaceGlass, a, b), b.w, 1.5f, vec4(kFresnelExact, 0.0f, 0.0f, 0.0f)).refraction, specularWeights(makeTestSurface(kSurfaceGlass, a, b), b.w, 1.5f, vec4(kFresnelExact, 0.0f, 0.0f, 0.0f)).reflection.x))
AGREEMENT_CASE(26, vec4(viewDirection(makeView(a), 2.0f * vec2(b.x, b.y) - vec2(1.0f)), 0.0f))
AGREEMENT_CASE(27, clipFromWorldPosition(makeView(a), 5.0f * vec3(b)))
AGREEMENT_CASE(28, sampleTexture(image, 6.0f * vec2(b.x, b.y) - vec2(3.0f), -1.0f, clampRepeatSettings(a, kFilterLinear, kFilterLinear)))
AGREEMENT_CASE(29, sampleTexture(image, vec2(b.x, b.y), 4.0f * b.z, clampRepeatSettings(a, kFilterLinear, kFilterLinearMipLinear)))
AGREEMENT_CASE(30, sampleTexture(image, vec2(b.x, b.y), 4.0f * b.z, clampRepeatSettings(a, kFilterNearest, kFilterLinearMipNearest)))
AGREEMENT_CASE(31, vec4(float(nearestTexelId(image, 6.0f * vec2(b.x, b.y) - vec2(3.0f), -1.0f, clampRepeatSettings(a, kFilterNearest, kFilterLinear)))))
AGREEMENT_CASE(32, vec4(textureCoordinates(a, vec4(b.x, b.y, b.z, 1.0f), vec2(b.z, b.w), vec2(b.w, a.x)), 0.0f, 0.0f))
AGREEMENT_CASE(33, vec4(coneLod(0.01f + a.x, b.x - 0.5f, 1.0f + 10.0f * a.y, ivec2(64, 32), vec4(2.0f, 0.0f, 0.0f, 3.0f))))
AGREEMENT_CASE(34, vec4(vec3(makeSurface(makeMaterial(a), vec3(b), unitVector(b), a, b, a, b, a).baseColor), makeSurface(makeMaterial(a), vec3(b), unitVector(b), a, b, a, b, a).metallic))
AGREEMENT_CASE(35, vec4(makeSurface(makeMaterial(a), vec3(b), unitVector(b), a, b, a, b, a).emission, makeSurface(makeMaterial(a), vec3(b), unitVector(b), a, b, a, b, a).occlusion))
AGREEMENT_CASE(36, vec4(environmentRadiance(makeSky(a, 0.0f), faces, unitVector(b)), 0.0f))
AGREEMENT_CASE(37, vec4(F_Conductor(a.x, vec3(a) + vec3(0.1f), 4.0f * vec3(b)), F_Ratio(b.x, 0.2f * a.y, b.y, 1.0f + 5.0f * b.z)))
AGREEMENT_CASE(38, vec4(dielectricReflectance(kSchlickLaw, a.x, 1.1f + b.x), dielectricReflectance(kRatioLaw, a.y, 1.5f), dielectricReflectance(kExactLaw, a.z, 1.1f + b.z), dielectricF0(1.0f + b.w)))
AGREEMENT_CASE(39, vec4(dielectricReflectance(kSchlickLaw, a.x, 0.5f + 0.4f * b.x)))
AGREEMENT_CASE(40, vec4(toWorld(makeFrame(unitVector(a)), vec3(b)), toLocal(makeFrame(unitVector(b)), vec3(a)).x))
AGREEMENT_CASE(41, vec4(D_GGX(a.x, 1.0f - a.x * a.x, 0.05f + b.x), lambda_GGX(0.05f + a.y, 0.05f + b.y), G1_SmithGGX(0.05f + a.z, 0.05f + b.z), V_SmithGGXCorrelated(0.05f + a.x, 0.05f + a.y, 0.05f + b.w)))
AGREEMENT_CASE(42, vec4(geometryTerm(kGeometryOne, a.x, a.y, a.z, a.w, 0.1f + b.x), geometryTerm(kGeometrySmithK, a.x, a.y, a.z, a.w, 0.1f + b.x), geometryTerm(kGeometryCookTorrance, a.x, a.y, a.z, 0.1f + a.w, 0.1f + b.x), geometryTerm(kGeometrySmithCorrelated, a.x, a.y, a.z, a.w, 0.1f + b.x)))
AGREEMENT_CASE(43, vec4(sampleVisibleNormal(safeNormalize(upperVector(a)), 0.05f + 0.9f * a.w, vec2(b.x, b.y)), 0.0f))
AGREEMENT_CASE(44, vec4(pdfVisibleNormal(0.05f + 0.9f * a.x, 0.9f * a.y, 1.0f - 0.81f * a.y * a.y, a.z, 0.1f + b.x)))
AGREEMENT_CASE(45, vec4(sampleDfg(image, a.x, a.y), sampleDfg(image, 0.0f, b.x)))
AGREEMENT_CASE(46, vec4(areaLightIrradiance(makeAreaLight(a, b), vec3(0.1f, 0.2f, 0.3f), unitVector(vec4(b.w, a.w, b.x, 0.0f))), 0.0f))
AGREEMENT_CASE(47, vec4(transmittance(3.0f * vec3(a), b.x), channelIor(1.0f + b.y, b.z, int(3.0f * b.w))))
AGREEMENT_CASE(48, vec4(slabExitOffset(unitVector(a), -unitVector(a + 0.2f * b), 1.1f + b.w, a.w), 0.0f))
AGREEMENT_CASE(49, vec4(specularReflectance(makeTestSurface(kSurfaceGlossy, a, b), b.x, kExactLaw), specularReflectance(makeTestSurface(kSurfaceGlossy, a, b), b.x, kRatioLaw).x))
AGREEMENT_CASE(50, vec4(specularF0(makeTestSurface(kSurfaceGlossy, a, b)), specularF90(makeTestSurface(kSurfaceGlossy, a, b))))
AGREEMENT_CASE(51, vec4(coatAlbedo(makeTestSurface(kSurfaceGlossy, a, b), surfaceDfg(makeTestSurface(kSurfaceGlossy, a, b), image, a.z)), 0.0f))
AGREEMENT_CASE(52, vec4(specularBsdf(makeTestSurface(kSurfaceGlossy, a, vec4(0.5f, 0.5f, 1.0f, b.w)), safeNormalize(upperVector(a)), safeNormalize(upperVector(b)), 1.5f, kExactLaw, kGeometrySmithCorrelated), 0.0f))
AGREEMENT_CASE(53, vec4(specularWeights(makeTestSurface(kSurfaceGlossy, a, b), b.w, 1.5f, kSchlickLaw).reflection, float(isThinWalled(makeTestSurface(kSurfaceGlass, a, b)))))
AGREEMENT_CASE(54, vec4(makeSurface(makeMaterial(a), vec3(b), unitVector(b), a, b, a, b, a).alpha, makeSurface(makeMaterial(a), vec3(b), unitVector(b), a, b, a, b, a).opacity, ggxAlpha(0.04f * a.x), ggxAlpha(a.y)))
AGREEMENT_CASE(55, vec4(smoothUnion(a.x, a.y, 0.1f + a.z), subtraction(a.x, b.x), boxDistance(3.0f * vec3(a) - vec3(1.5f), vec3(b)), torusDistance(3.0f * vec3(a) - vec3(1.5f), b.x, b.y)))
AGREEMENT_CASE(56, vec4(twisted(3.0f * vec3(a) - vec3(1.5f), 2.0f * b.x), rippleHeight(3.0f * vec3(a) - vec3(1.5f), 6.28318531f * b.y)))
AGREEMENT_CASE(57, vec4(screenRadiance(kScreenMelt, vec2(a.x, a.y), 1.33333333f, 6.28318531f * b.x), 0.0f))
AGREEMENT_CASE(58, vec4(screenRadiance(kScreenTwist, vec2(a.x, a.y), 1.33333333f, 6.28318531f * b.x), 0.0f))
AGREEMENT_CASE(59, vec4(screenRadiance(kScreenRipples, vec2(a.x, a.y), 1.33333333f, 6.28318531f * b.x), 0.0f))
AGREEMENT_CASE(60, vec4(screenRadiance(kScreenRings, vec2(a.x, a.y), 1.33333333f, 6.28318531f * b.x), 0.0f))
AGREEMENT_CASE(61, vec4(sphereProxyDirection(2.0f * vec3(a), unitVector(b), 1.0f + a.w), 0.0f))
AGREEMENT_CASE(62, vec4(boxProxyDirection(vec3(a), unitVector(b), vec3(-0.5f), vec3(1.5f), vec3(b)), 0.0f))
AGREEMENT_CASE(63, vec4(impostorDirection(vec3(a), vec3(b), a.w), impostorExcess(vec3(b), a.w, b.w)))
AGREEMENT_CASE(64, vec4(impostorSecant(vec2(a.x, -0.1f - a.y), vec2(1.0f + b.x, b.y)), singleViewCoordinates(vec2(a.z, a.w), vec2(b.z, b.w)), 0.0f))
AGREEMENT_CASE(65, vec4(octahedralCoordinates(unitVector(a)), paraboloidCoordinates(unitVector(a))))
AGREEMENT_CASE(66, vec4(octahedralDirection(2.2f * vec2(a) - vec2(1.1f)), 0.0f))
AGREEMENT_CASE(67, vec4(paraboloidDirection(2.2f * vec2(a) - vec2(1.1f), a.z < 0.5f ? -1.0f : 1.0f), borderedTextureCoordinates(vec2(b), 34).x))
AGREEMENT_CASE(68, vec4(cubeSolidAngleDensity(2.0f * vec2(a) - vec2(1.0f))))
AGREEMENT_CASES_END
