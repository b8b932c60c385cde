// Radiance of the environment, specialised: ENVIRONMENT_FACES if it is a cube map instead of the gradient,
// ENVIRONMENT_HARDWARE to filter that by the driver's seamless sampler. SKY is a gradient that the compiler knows.

#if defined(ENVIRONMENT_HARDWARE)
layout(binding = kEnvironmentCubeUnit) uniform samplerCube environmentCube;
vec3 environmentAlong(vec3 d) { return vec3(textureLod(environmentCube, d, 0.0f)); }
#elif defined(ENVIRONMENT_FACES)
layout(binding = kEnvironmentUnit) uniform sampler2DArray environmentFaces;
vec3 environmentAlong(vec3 d) { return vec3(sampleCube(environmentFaces, d)); }
#else
#ifndef SKY
#define SKY scene.sky
#endif
vec3 environmentAlong(vec3 d) { return gradientSky(SKY, d); }
#endif
