// The default light of lines: illuminated lines with a floor, so that colours keep their hue.
//
// A line has a normal towards every light (Zöckler et al. 1996, see illuminated.glsl): its share of a light depends on the
// angle between both, wherever the viewer is. With unit vectors T along the line, L to a light:
//
//   share      s = 1 - (L.T)^4       of the light that falls on the line; sqrt(1 - (L.T)^2), the reflection itself, would take a
//                                    fifth of the light of most lines
//   light      m = FLOOR + (1 - FLOOR) s
//
// Lights give lines their shape, and nothing else: neither their strength nor their colours count, so that colours that mean
// something stay true in dim or coloured light. VTK's own lines, which have no normals, are the same in every light.
//
// Lights that move with the camera are there so that anything is seen. They count as one, which comes over the viewer's left
// shoulder, L = (-1, 1, 1) / sqrt(3): equally far from all axes of the picture, so that it takes the same from red, green and
// blue lines in a view along an axis, where a headlight would put one of them out. Where a light stands in the scene, all lights
// count from where they are, weighted by their brightness c, the sum of their channels: s = sum c (1 - (L.T)^4) / sum c.
//
// VTK's loop over the lights stays, as in illuminated.glsl, and so do highlights. The last sections are for a single headlight.

//@ fragment after //VTK::CustomUniforms::Dec
#include "frame/gentle_light.glsl"
uniform float fibletLights;        // sum c
uniform float fibletStanding;      // 1: a light stands in the scene
vec3 fibletLineTangent;            // T, in view coordinates
vec3 fibletLineNormal;             // nearest to the viewer

float fibletAcrossLine(vec3 d) { return across_line(fibletLineTangent, d); }

// As in illuminated.glsl; the normal that VTK hands over is not asked for.
vec3 fibletReflect(vec3 incoming, vec3 normal)
{
  float along = dot(fibletLineTangent, incoming);
  return along * fibletLineTangent + sqrt(max(0.0, 1.0 - along * along)) * fibletLineNormal;
}

float fibletOnLine(vec3 diffuse)
{
  float share = min(dot(diffuse, vec3(1.0)) / max(fibletLights, 1e-6), 1.0);
  return gentle_light(fibletStanding > 0.0 ? share : fibletAcrossLine(SHOULDER));
}

//@ fragment after //VTK::Normal::Impl
  fibletLineTangent = fibletTangentVC;
  vec3 fibletSight = normalize(-vertexVC.xyz);   // VTK's V, in parallel views too
  fibletLineNormal = fibletSight - fibletTangentVC * dot(fibletTangentVC, fibletSight);
  fibletLineNormal = length(fibletLineNormal) > 1e-3 ? normalize(fibletLineNormal) : normalVCVSOutput;

//@ fragment replace dot(normalVCVSOutput, -
fibletAcrossLine(-
//@ fragment replace reflect(
fibletReflect(
//@ fragment replace diffuse = diffuse * diffuseColor;
diffuse = fibletOnLine(diffuse) * diffuseColor;
//@ fragment replace max(0.000001, normalVCVSOutput.z)
fibletAcrossLine(vec3(0.0, 0.0, 1.0))
//@ fragment replace pow(df, specularPower)
pow(max(1e-5, dot(fibletReflect(vec3(0.0, 0.0, -1.0), fibletLineNormal), fibletSight)), specularPower)
//@ fragment replace vec3 diffuse = df * diffuseColor * lightColor0;
vec3 diffuse = fibletOnLine(df * lightColor0) * diffuseColor;
