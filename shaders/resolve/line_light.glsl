// The light that lines have unless another is asked for: illuminated lines with a floor, so that colours stay what they are.
//
// A line has a normal towards every light (illuminated.glsl). What a light takes from it is told by the angle between both
// alone, wherever the viewer is. With unit vectors T along the line, L to a light of colour and intensity c:
//
//   share      s = sum c (1 - (L.T)^4) / sum c      of all lights, channel by channel: 1 where all fall across the line
//   light      m = min(max c', 1) w (1 - (1 - FLOOR) (1 - s)),  c' = sum c
//   tint       w = mix(1, c' / max c', 1 - min c' / max c'):  nearly white lights count as white, a red lamp stays red
//
// sqrt(1 - (L.T)^2), the reflection itself, would take a seventh of the light of lines in the mean; the fourth power leaves
// lines as they are but for those that point to a light, from which what little of shape there is in a line is read.
//
// VTK's loop over the lights stays, as in illuminated.glsl, and so do highlights. The last sections are for a single headlight.

//@ fragment after //VTK::CustomUniforms::Dec
uniform vec3 fibletLights;         // c'
const float fibletFloor = 0.6;
vec3 fibletLineTangent;            // T, in view coordinates
vec3 fibletLineNormal;             // nearest to the viewer

float fibletAcrossLine(vec3 d)
{
  float along = dot(fibletLineTangent, d);
  along *= along;
  return max(0.0, 1.0 - along * along);
}

// As in illuminated.glsl; the normal that VTK hands over is not asked for.
vec3 fibletReflect(vec3 incoming, vec3 normal)
{
  float along = dot(fibletLineTangent, incoming);
  return along * fibletLineTangent + sqrt(max(0.0, 1.0 - along * along)) * fibletLineNormal;
}

vec3 fibletOnLine(vec3 diffuse)
{
  float brightest = max(fibletLights.r, max(fibletLights.g, fibletLights.b));
  vec3 tint = fibletLights / max(brightest, 1e-6);
  tint = mix(vec3(1.0), tint, 1.0 - min(tint.r, min(tint.g, tint.b)));
  vec3 share = min(diffuse / max(fibletLights, vec3(1e-6)), vec3(1.0));
  return min(brightest, 1.0) * tint * mix(vec3(fibletFloor), vec3(1.0), share);
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
