// Clipping planes of the mapper. One that cuts away what is in front is the near plane of the engine's
// view: its depth is turned back into that of VTK's view. By the others the resolve discards; they are in
// view coordinates, and a fragment on the negative side of any is not drawn.

//@ fragment after //VTK::CustomUniforms::Dec
uniform vec4 fibletObliqueDepth;  // factors of (x, y, 1 - engine's depth, 1)
uniform int fibletPlaneCount;
uniform vec4 fibletPlanes[6];

//@ fragment after //pvfiblets::Depth::Impl
  fibletFarness = dot(fibletObliqueDepth, vec4(fibletNDC, fibletFarness, 1.0));
  fibletDepth = 1.0 - fibletFarness;

//@ fragment after //VTK::Clip::Impl
  for (int plane = 0; plane < fibletPlaneCount; ++plane)
  {
    if (dot(fibletPlanes[plane], vertexVC) < 0.0)
    {
      discard;
    }
  }
