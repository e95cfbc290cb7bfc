// Clipping planes of the mapper, for an engine that does not cut the lines itself. Planes are in view
// coordinates; a fragment on the negative side of any of them is not drawn.

//@ fragment after //VTK::CustomUniforms::Dec
uniform int fibletPlaneCount;
uniform vec4 fibletPlanes[6];

//@ fragment after //VTK::Clip::Impl
  for (int plane = 0; plane < fibletPlaneCount; ++plane)
  {
    if (dot(fibletPlanes[plane], vertexVC) < 0.0)
    {
      discard;
    }
  }
