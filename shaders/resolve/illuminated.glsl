// Illuminated streamlines: a line is lit as the thin cylinder that it is, which has a normal towards every light.
//
// Zöckler, Stalling, Hege 1996, in the form of Mallo, Peikert, Sigg, Sadlo 2005, section 2 (maximum principle): of all
// normals of the line that one counts which reflects most. With unit vectors T along the line, L to the light, V to the
// viewer:
//
//   diffuse    L.N = sqrt(1 - (L.T)^2)
//   specular   R.V = sqrt(1 - (L.T)^2) sqrt(1 - (V.T)^2) - (L.T)(V.T)
//
// The one normal of normal.glsl, nearest to the viewer, gives the same for a headlight and less for all other lights.
//
// VTK's own loop over the lights stays, with all their kinds, cones and attenuations. Only its two products with the
// normal are exchanged, in the text that VTK has written. The vector that stands for R is that one of the cone of
// reflections that comes nearest to V: it keeps the part of -L along T, and N turns the rest towards the viewer. The last
// sections but one are for a single headlight: VTK then writes L = (0, 0, 1) out and takes N.L in the place of R.V.
//
// Lights from behind count as much as any, so several soon add up to more than white, and then no shape would be left. All
// are therefore dimmed alike until together they are no brighter than one: `fibletLightSum` is their sum.

//@ fragment after //VTK::CustomUniforms::Dec
uniform float fibletLightSum;      // at least 1
vec3 fibletLineTangent;            // T, in view coordinates
vec3 fibletLineNormal;             // N nearest to V

float fibletSine(vec3 d)
{
  float along = dot(fibletLineTangent, d);
  return sqrt(max(0.0, 1.0 - along * along));
}

// The normal that VTK hands over is not asked for.
vec3 fibletReflect(vec3 incoming, vec3 normal)
{
  return dot(fibletLineTangent, incoming) * fibletLineTangent + fibletSine(incoming) * fibletLineNormal;
}

//@ fragment after //VTK::Normal::Impl
  fibletLineTangent = fibletTangentVC;
  vec3 fibletSight = normalize(-vertexVC.xyz);   // VTK's V, in parallel views too
  fibletLineNormal = fibletSight - fibletTangentVC * dot(fibletTangentVC, fibletSight);
  fibletLineNormal = length(fibletLineNormal) > 1e-3 ? normalize(fibletLineNormal) : normalVCVSOutput;

//@ fragment replace dot(normalVCVSOutput, -
fibletSine(-
//@ fragment replace reflect(
fibletReflect(
//@ fragment replace max(0.000001, normalVCVSOutput.z)
fibletSine(vec3(0.0, 0.0, 1.0))
//@ fragment replace pow(df, specularPower)
pow(max(1e-5, dot(fibletReflect(vec3(0.0, 0.0, -1.0), fibletLineNormal), fibletSight)), specularPower)
//@ fragment replace diffuse = diffuse * diffuseColor;
diffuse = diffuse * diffuseColor;
  diffuse /= fibletLightSum;
